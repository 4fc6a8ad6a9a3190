// Numbers: the headline, the table of all metrics beside those of a pinned design, the energy balance.
import type {Balance, Quantity, Report, Solved} from './core';
import {html} from './dom';
import {balanceRows} from './pictures/sankey';
import {digits, readable} from './quantities';

const headline: [string, string][] = [
  ['frequency_hz', 'flapping frequency'],
  ['lift_mean_n', 'mean lift'],
  ['lift_to_weight', 'lift / weight'],
  ['power_electrical_w', 'electrical power'],
  ['current_mean_a', 'mean current'],
  ['efficiency_system', 'system efficiency'],
];

/** The number under a key of a run's report; null where there is none. */
export const numberOf = (report: Report | null | undefined, key: string) => {
  const values: Record<string, unknown> | null | undefined = report;
  const value = values?.[key];
  return typeof value === 'number' ? value : null;
};

export function showHeadline(parent: HTMLElement, solved: Solved, metrics: Quantity[]) {
  const report = solved.report,
    unit = (key: string) => metrics.find((m) => m.key === key)?.unit ?? '';
  const status = report.status ?? 'undecided';
  const outside = typeof report.domain === 'string' && report.domain !== 'inside';
  const parts: Node[] = [
    html('p', {class: `status status-${status}`}, html('strong', {}, status), ` ${report.status_detail}`),
  ];
  if (outside)
    parts.push(
      html(
        'p',
        {class: 'status outside'},
        html('strong', {}, "outside the model's domain"),
        ` ${report.domain_detail}`,
      ),
    );
  for (const warning of report.warnings) parts.push(html('p', {class: 'status warning'}, warning));
  const list = html('dl', {});
  for (const [key, name] of headline) {
    const value = numberOf(report, key);
    const shown =
      key === 'efficiency_system' && value !== null ? `${digits(100 * value, 4)} %` : readable(value, unit(key));
    list.append(html('div', {}, html('dt', {}, name), html('dd', {id: `value-${key}`}, shown)));
  }
  parent.replaceChildren(...parts, list);
}

export function showBalance(table: HTMLTableElement, balance: Balance | null) {
  table.replaceChildren(html('caption', {}, 'energy balance, mean over a cycle'));
  for (const [name, value, share] of balance ? balanceRows(balance) : []) {
    table.append(
      html(
        'tr',
        {},
        html('th', {scope: 'row'}, name),
        html('td', {}, readable(value, 'W')),
        html('td', {}, Math.abs(share) < 1e-4 ? share.toExponential(0) : `${digits(100 * share, 4)} %`),
      ),
    );
  }
}

/** Every metric; beside the pinned design's where there is one. */
export function showMetrics(table: HTMLTableElement, metrics: Quantity[], report: Report, pinned: Report | null) {
  const head = ['metric', ...(pinned ? ['A', 'B', 'difference'] : ['value'])];
  const body = html('tbody', {});
  for (const metric of metrics) {
    const b = numberOf(report, metric.key),
      a = numberOf(pinned, metric.key);
    if (b === null && a === null) continue;
    const row = html('tr', {}, html('th', {scope: 'row', title: metric.key}, metric.meaning));
    if (pinned) row.append(html('td', {}, readable(a, metric.unit)));
    row.append(html('td', {}, readable(b, metric.unit)));
    if (pinned) {
      const change = a !== null && b !== null && a !== 0 ? 100 * (b / a - 1) : null;
      row.append(
        html(
          'td',
          {class: change === null ? '' : change > 0 ? 'more' : change < 0 ? 'less' : ''},
          change === null ? '–' : `${change >= 0 ? '+' : '−'}${digits(Math.abs(change), 3)} %`,
        ),
      );
    }
    body.append(row);
  }
  table.replaceChildren(
    html('thead', {}, html('tr', {}, ...head.map((text) => html('th', {scope: 'col'}, text)))),
    body,
  );
}

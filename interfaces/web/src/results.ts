// Numbers: the headline, the table of all metrics beside those of a pinned design, the energy balance.
import type {Balance, Quantity, Report, Solved} from './core';
import {html, update} from './dom';
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

/** Less than this share of the largest quantity of its kind is rounding: solutions are accurate to 1e-6. */
const rounding = 1e-9;
const kinds = [/^power_/, /^current_/, /^lift_(mean|peak)/];
/** The largest magnitude of each kind in a report. */
const largest = new WeakMap<Report, number[]>();

function largestOf(report: Report): number[] {
  const known = largest.get(report);
  if (known) return known;
  const keys = Object.keys(report);
  const found = kinds.map((kind) =>
    Math.max(0, ...keys.filter((key) => kind.test(key)).map((key) => Math.abs(numberOf(report, key) ?? 0))),
  );
  largest.set(report, found);
  return found;
}

/** numberOf() with 0 in place of what is left of a mean that vanishes, such as the current of a direct drive. */
export function significant(report: Report | null | undefined, key: string): number | null {
  const value = numberOf(report, key),
    kind = kinds.findIndex((k) => k.test(key));
  if (!report || value === null || kind < 0) return value;
  return Math.abs(value) < rounding * largestOf(report)[kind]! ? 0 : value;
}

export function showHeadline(parent: HTMLElement, solved: Solved, metrics: Quantity[]) {
  const report = solved.report,
    unit = (key: string) => metrics.find((m) => m.key === key)?.unit ?? '';
  const status = solved.reached ? (report.status ?? 'undecided') : 'out of reach';
  const outside = typeof report.domain === 'string' && report.domain !== 'inside';
  const parts: Node[] = [
    html(
      'p',
      {class: `status status-${status.replaceAll(' ', '-')}`},
      html('strong', {}, status),
      ` ${report.status_detail}`,
    ),
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
    const value = significant(report, key);
    const shown =
      key === 'efficiency_system' && value !== null ? `${digits(100 * value, 4)} %` : readable(value, unit(key));
    const meaning = metrics.find((m) => m.key === key)?.meaning ?? '';
    list.append(
      html(
        'div',
        {},
        html('dt', {}, name),
        html('dd', {id: `value-${key}`}, shown),
        html('dd', {class: 'meaning'}, meaning),
      ),
    );
  }
  update(parent, [...parts, list]);
}

export function showBalance(table: HTMLTableElement, balance: Balance | null) {
  const rows: Node[] = [html('caption', {}, 'energy balance, mean over a cycle')];
  for (const [name, value, share] of balance ? balanceRows(balance) : []) {
    rows.push(
      html(
        'tr',
        {},
        html('th', {scope: 'row'}, name),
        html('td', {}, readable(value, 'W')),
        html('td', {}, Math.abs(share) < 1e-4 ? share.toExponential(0) : `${digits(100 * share, 4)} %`),
      ),
    );
  }
  update(table, rows);
}

/** Every metric; beside those of pinned designs where there are some, with the difference to the first of them. */
export function showMetrics(
  table: HTMLTableElement,
  metrics: Quantity[],
  report: Report,
  pins: {name: string; report: Report}[],
) {
  const first = pins[0];
  const head = first
    ? ['metric', ...pins.map((pin) => pin.name), 'present', `present against ${first.name}`]
    : ['metric', 'value'];
  const body = html('tbody', {});
  for (const metric of metrics) {
    const value = significant(report, metric.key),
      others = pins.map((pin) => significant(pin.report, metric.key));
    if ([value, ...others].every((x) => x === null)) continue;
    body.append(
      html(
        'tr',
        {},
        html('th', {scope: 'row', title: metric.key}, metric.meaning),
        ...[...others, value].map((x) => html('td', {}, readable(x, metric.unit))),
        ...(first ? [difference(others[0] ?? null, value)] : []),
      ),
    );
  }
  const columns = head.map((text) => html('th', {scope: 'col'}, text));
  update(table, [html('thead', {}, html('tr', {}, ...columns)), body]);
}

function difference(from: number | null, to: number | null): HTMLElement {
  const change = from !== null && to !== null && from !== 0 ? 100 * (to / from - 1) : null;
  return html(
    'td',
    {class: change === null ? '' : change > 0 ? 'more' : change < 0 ? 'less' : ''},
    change === null ? '–' : `${change >= 0 ? '+' : '−'}${digits(Math.abs(change), 3)} %`,
  );
}

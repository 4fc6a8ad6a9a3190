// Values of the paper beside those of the model, as a table.
import {html} from './dom';
import type {Explorer} from './explorer';
import {beside} from './published';
import {digits, readable, withMinus} from './quantities';

/** Null where the paper reports nothing for what is shown. */
export function paperTable(explorer: Explorer): HTMLElement | null {
  const rows = beside(explorer);
  if (rows.length === 0) return null;
  const {metrics} = explorer.core.tables;
  const body = rows.map(({value, model}) => {
    const metric = metrics.find((m) => m.key === value.metric);
    const ours =
      model === null
        ? '–'
        : value.change
          ? `${withMinus(digits(100 * model, 3))} %`
          : value.against !== null
            ? digits(model, 3)
            : readable(model, metric?.unit ?? '1', 3);
    const than = value.against === null ? '' : `, ${value.change ? 'change' : 'ratio'} by springs`;
    return html(
      'tr',
      {},
      html('th', {scope: 'row'}, `${metric?.meaning ?? value.metric}${than}`),
      html('td', {}, withMinus(value.value)),
      html('td', {}, ours),
      html('td', {class: 'where'}, `${value.where}${value.basis === 'calibrated' ? '; used to calibrate S₂, S₃' : ''}`),
    );
  });
  return html(
    'div',
    {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'values of the paper'},
    html(
      'table',
      {class: 'paper'},
      html('caption', {}, 'the paper of 2022 beside this model'),
      html(
        'thead',
        {},
        html('tr', {}, ...['quantity', 'paper', 'model', 'where'].map((t) => html('th', {scope: 'col'}, t))),
      ),
      html('tbody', {}, ...body),
    ),
  );
}

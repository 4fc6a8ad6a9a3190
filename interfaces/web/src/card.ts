// A picture of a design to pass on: what it is, its numbers, mechanism and lift, with the version that computed them.
import {identity} from './about';
import {svg} from './dom';
import type {Explorer} from './explorer';
import {digits, readable} from './quantities';
import {numberOf} from './results';
import {describeDesign, heldUnit} from './state';

const width = 760,
  height = 442;
const numbers: [string, string, string][] = [
  ['frequency_hz', 'flapping frequency', 'Hz'],
  ['lift_mean_n', 'mean lift', 'N'],
  ['lift_to_weight', 'lift over weight', '1'],
  ['power_electrical_w', 'electrical power', 'W'],
  ['current_mean_a', 'mean current', 'A'],
  ['efficiency_system', 'system efficiency', '%'],
];
const paper2022 =
  'Model: "Should friction losses be included in an electromechanical model of a bioinspired flapping-wing micro ' +
  'aerial vehicle …?", Bioinspir. Biomim. 2022';

/** Text in lines of about `most` characters, broken at blanks. */
export function wrapped(text: string, most: number): string[] {
  const lines: string[] = [];
  for (const word of text.split(' ')) {
    const last = lines.at(-1);
    if (last !== undefined && last.length + 1 + word.length <= most) lines[lines.length - 1] = `${last} ${word}`;
    else lines.push(word);
  }
  return lines;
}

/** A copy of a picture of the page at a place of the card. */
function copyOf(id: string, x: number, y: number, wide: number, high: number): SVGElement {
  const copy = document.querySelector<SVGSVGElement>(`#${id}`)!.cloneNode(true) as SVGSVGElement;
  copy.removeAttribute('id');
  copy.removeAttribute('role');
  copy.removeAttribute('aria-label');
  for (const element of copy.querySelectorAll('.live, .cursor, .readout')) element.remove();
  for (const [name, value] of Object.entries({x, y, width: wide, height: high})) copy.setAttribute(name, String(value));
  copy.setAttribute('preserveAspectRatio', 'xMidYMid meet');
  return copy;
}

export function drawCard(card: SVGSVGElement, {shown}: Explorer) {
  card.setAttribute('viewBox', `0 0 ${width} ${height}`);
  card.replaceChildren();
  if (!shown) return;
  const {state, solved} = shown,
    {report} = solved;
  const held = state.hold === 'voltage' ? '' : `, ${state.hold} held at ${readable(state.held, heldUnit[state.hold])}`;
  const title = wrapped(describeDesign(state.design, state.condition) + held, 88).slice(0, 2);
  const status = solved.reached ? (report.status ?? 'undecided') : 'out of reach';
  const outside = report.domain && report.domain !== 'inside' ? ", outside the model's domain of validity" : '';
  const text = (x: number, y: number, content: string, kind = '') =>
    svg('text', {x, y, ...(kind ? {class: kind} : {})}, content);
  card.append(
    ...title.map((line, n) => text(20, 30 + 19 * n, line, 'card-title')),
    text(20, 34 + 19 * title.length, `${status}${outside}`, 'card-status'),
  );
  let y = 96;
  for (const [key, name, unit] of numbers) {
    const value = numberOf(report, key);
    if (value === null) continue;
    const said = unit === '%' ? `${digits(100 * value, 3)} %` : readable(value, unit);
    card.append(text(20, y, name), text(20, y + 20, said, 'card-number'));
    y += 46;
  }
  card.append(copyOf('mechanism', 180, 66, 270, 300));
  if (solved.columns.time_s)
    card.append(copyOf('plot-lift', 455, 70, 290, 150), copyOf('plot-power', 455, 220, 290, 150));
  card.append(
    svg('line', {class: 'grid', x1: 20, x2: width - 20, y1: 386, y2: 386}),
    text(20, 402, identity, 'card-source'),
    ...wrapped(paper2022, 110).map((line, n) => text(20, 417 + 15 * n, line)),
  );
}

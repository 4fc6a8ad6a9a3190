// A trend over one key, a map over two.
import {contours} from 'd3-contour';
import {scaleLinear} from 'd3-scale';
import {interpolateViridis} from 'd3-scale-chromatic';
import {line} from 'd3-shape';
import {set, svg} from '../dom';
import {digits, readable, scaleFor, shownUnit} from '../quantities';
import {cleared, clickable, extent, type Frame, numbersBelow, numbersBeside, placeOf, sayNothing} from './axes';

export interface Axis {
  name: string;
  unit: string;
  values: number[];
}
export interface Outcome {
  statuses: string[];
  status: Float64Array;
  domain: Float64Array;
  metric: Float64Array;
  feasible: boolean[];
  /** The vehicle's mass is known. */
  weighed: boolean;
}
/** What is drawn of a study: `title` says of which design it is, `present` is the design of the page on its axes. */
export interface ShownStudy {
  title: string;
  metric: {name: string; unit: string};
  outcome: Outcome;
  best: number | null;
  present: number[] | null;
}
interface Scaled {
  factor: number;
  title: string;
}

/** Of a metric's name or of a key, which becomes words. */
const scaledOf = (name: string, unit: string, size: number): Scaled => {
  const {factor, unit: shown} = scaleFor(size, unit);
  const words = name.replace(/[._]/g, ' ');
  return {factor, title: shown ? `${words}, ${shownUnit(shown)}` : words};
};
const largest = ([low, high]: [number, number]) => Math.max(Math.abs(low), Math.abs(high));
const ends = (values: number[]): [number, number] => [values[0]!, values[values.length - 1]!];
const noneFlaps = 'no design here flaps';
const trend: Frame = {width: 560, height: 280, left: 60, right: 14, top: 46, bottom: 40};
const map: Frame = {width: 560, height: 460, left: 64, right: 92, top: 50, bottom: 44};
/** With fewer designs along an axis, such as numbers of wings, nothing is drawn between them. */
const fewest = 8;

/** Title above, values of the design under the pointer beside it. `indexAt` finds the design. */
function follow(
  picture: SVGSVGElement,
  frame: Frame,
  {title, metric, outcome}: ShownStudy,
  indexAt: (place: {x: number; y: number}) => number,
  say: (index: number) => string[],
) {
  picture.append(svg('text', {x: 4, y: 14}, title));
  const readout = svg('text', {x: 4, y: frame.height - 6, class: 'readout'});
  picture.append(readout);
  picture.onpointermove = (event) => {
    const index = indexAt(placeOf(event, picture, frame));
    const value = outcome.metric[index]!;
    const result = Number.isFinite(value) ? readable(value, metric.unit) : outcome.statuses[outcome.status[index]!]!;
    readout.textContent = `${say(index).join(', ')}: ${result}`;
  };
  picture.onpointerleave = () => {
    readout.textContent = '';
  };
}

/** `pick` receives the index of the design clicked. */
export function drawTrend(picture: SVGSVGElement, axis: Axis, shown: ShownStudy, pick: (index: number) => void) {
  const {metric, outcome, present} = shown;
  const {width, height, left, right, top, bottom} = trend;
  cleared(picture, trend);
  const range = extent(outcome.metric);
  if (!range) return sayNothing(picture, trend, noneFlaps);
  const horizontal = scaledOf(axis.name, axis.unit, largest(ends(axis.values)));
  const vertical = scaledOf(metric.name, metric.unit, largest(range));
  const x = scaleLinear(
    ends(axis.values).map((v) => v * horizontal.factor),
    [left, width - right],
  );
  const y = scaleLinear([range[0] * vertical.factor, range[1] * vertical.factor], [height - bottom, top]).nice(5);
  numbersBeside(picture, trend, y, 5, true);
  numbersBelow(picture, trend, x, x.ticks(6));
  picture.append(
    svg('text', {x: left, y: 34, class: 'title'}, vertical.title),
    svg('text', {x: width - right, y: height - 6, 'text-anchor': 'end'}, horizontal.title),
  );
  const place = (i: number) => x(axis.values[i]! * horizontal.factor);
  const curve = (defined: (v: number, i: number) => boolean, kind: string) => {
    const path = line<number>(
      (_, i) => place(i),
      (v) => y(v * vertical.factor),
    ).defined((v, i) => Number.isFinite(v) && defined(v, i));
    picture.append(svg('path', {class: `curve ${kind}`, d: path(Array.from(outcome.metric)) ?? ''}));
  };
  curve(() => true, 'series-0');
  curve((_, i) => outcome.domain[i]! > 0, 'outside');
  outcome.status.forEach((status, i) => {
    if (outcome.statuses[status] !== 'flapping') {
      picture.append(svg('rect', {class: 'fails', x: place(i) - 1.5, y: height - bottom - 6, width: 3, height: 6}));
    }
  });
  const here = (present?.[0] ?? NaN) * horizontal.factor,
    [first, last] = ends(axis.values).map((v) => v * horizontal.factor) as [number, number];
  if (here >= first && here <= last) {
    picture.append(svg('line', {class: 'cursor', x1: x(here), x2: x(here), y1: top, y2: height - bottom}));
  }
  const indexAt = (at: {x: number; y: number}) => {
    const wanted = x.invert(at.x) / horizontal.factor;
    return axis.values.reduce((best, v, i) => {
      return Math.abs(v - wanted) < Math.abs(axis.values[best]! - wanted) ? i : best;
    }, 0);
  };
  const dot = svg('circle', {class: 'dot', r: 4, cx: -9, cy: -9});
  picture.append(dot);
  follow(picture, trend, shown, indexAt, (index) => {
    const value = outcome.metric[index]!;
    set(dot, Number.isFinite(value) ? {cx: place(index), cy: y(value * vertical.factor)} : {cx: -9, cy: -9});
    return [`${axis.name} ${readable(axis.values[index], axis.unit)}`];
  });
  clickable(picture, trend, (at) => pick(indexAt(at)));
}

/** Designs row by row, the first axis inside. Grey: no flapping; the feasible region is outlined. */
export function drawMap(
  picture: SVGSVGElement,
  across: Axis,
  up: Axis,
  shown: ShownStudy,
  pick: (index: number) => void,
) {
  const {metric, outcome, best, present} = shown;
  const {width, height, left, right, top, bottom} = map;
  cleared(picture, map);
  const range = extent(outcome.metric);
  if (!range) return sayNothing(picture, map, noneFlaps);
  const columns = across.values.length,
    rows = up.values.length;
  const cell: [number, number] = [(width - left - right) / columns, (height - top - bottom) / rows];
  const m = scaledOf(metric.name, metric.unit, largest(range));
  const levels = scaleLinear(range, [0, 1]).ticks(10),
    bands = [-Infinity, ...levels.filter((level) => level > range[0] && level < range[1])];
  const colour = (band: number) => interpolateViridis(bands.length > 1 ? band / (bands.length - 1) : 0.5);
  picture.append(
    svg('rect', {class: 'fails', x: left, y: top, width: cell[0] * columns, height: cell[1] * rows}),
    columns < fewest || rows < fewest
      ? cellsOf(outcome.metric, columns, cell, (v) => colour(bands.filter((level) => level <= v).length - 1))
      : bandsOf(outcome.metric, columns, rows, cell, bands, colour),
    svg('path', {class: 'feasible', d: outlineOf(outcome.feasible, columns, rows, cell)}),
  );
  const a = scaledOf(across.name, across.unit, largest(ends(across.values))),
    u = scaledOf(up.name, up.unit, largest(ends(up.values)));
  const x = scaleLinear(
    ends(across.values).map((v) => v * a.factor),
    [left + cell[0] / 2, width - right - cell[0] / 2],
  );
  const y = scaleLinear(
    ends(up.values).map((v) => v * u.factor),
    [height - bottom - cell[1] / 2, top + cell[1] / 2],
  );
  numbersBelow(picture, map, x, x.ticks(6));
  numbersBeside(picture, map, y, 6, false);
  picture.append(
    svg('text', {x: width - right, y: height - 10, 'text-anchor': 'end'}, a.title),
    svg('text', {x: 4, y: 36, class: 'title'}, u.title),
    svg('text', {x: width - 4, y: 36, class: 'title', 'text-anchor': 'end'}, m.title),
  );
  const step = (height - top - bottom) / bands.length;
  bands.forEach((level, n) => {
    const foot = height - bottom - n * step;
    picture.append(
      svg('rect', {x: width - right + 14, y: foot - step, width: 12, height: step + 0.5, fill: colour(n)}),
    );
    if (n > 0) picture.append(svg('text', {x: width - right + 30, y: foot + 4}, digits(level * m.factor, 4)));
  });
  const mark = (px: number, py: number, kind: string) => {
    if (px < left || px > width - right || py < top || py > height - bottom) return;
    picture.append(svg('circle', {class: kind, cx: px, cy: py, r: 5}));
  };
  if (present) mark(x(present[0]! * a.factor), y(present[1]! * u.factor), 'here');
  if (best !== null) {
    mark(x(across.values[best % columns]! * a.factor), y(up.values[Math.floor(best / columns)]! * u.factor), 'best');
  }
  const within = (index: number, count: number) => Math.min(count - 1, Math.max(0, Math.floor(index)));
  const indexAt = (at: {x: number; y: number}) =>
    within((height - bottom - at.y) / cell[1], rows) * columns + within((at.x - left) / cell[0], columns);
  follow(picture, map, shown, indexAt, (index) => [
    readable(across.values[index % columns], across.unit),
    readable(up.values[Math.floor(index / columns)], up.unit),
  ]);
  clickable(picture, map, (at) => pick(indexAt(at)));
}

/** Where the picture has a point of the grid, whose row 0 is at the foot. */
const corner = (column: number, row: number, cell: [number, number]) =>
  `${(map.left + column * cell[0]).toFixed(1)},${(map.height - map.bottom - row * cell[1]).toFixed(1)}`;

function cellsOf(metric: Float64Array, columns: number, cell: [number, number], colour: (value: number) => string) {
  const cells = svg('g');
  metric.forEach((value, i) => {
    if (!Number.isFinite(value)) return;
    const d = `M${corner(i % columns, Math.floor(i / columns), cell)}h${cell[0]}v${-cell[1]}h${-cell[0]}z`;
    cells.append(svg('path', {d, fill: colour(value)}));
  });
  return cells;
}

/** One area for each band, the higher ones on the lower ones. */
function bandsOf(
  metric: Float64Array,
  columns: number,
  rows: number,
  cell: [number, number],
  bands: number[],
  colour: (band: number) => string,
) {
  const areas = svg('g', {class: 'bands'});
  const contour = contours().size([columns, rows]);
  const finite = Array.from(metric, (v) => (Number.isFinite(v) ? 1 : 0));
  const values = Array.from(metric, (v) => (Number.isFinite(v) ? v : -Infinity));
  bands.forEach((level, n) => {
    // The lowest band is where there are numbers at all.
    const {coordinates} = n === 0 ? contour.contour(finite, 0.5) : contour.contour(values, level);
    const d = coordinates
      .flat()
      .map((ring) => `M${ring.map(([c, r]) => corner(c!, r!, cell)).join('L')}Z`)
      .join('');
    areas.append(svg('path', {d, fill: colour(n), 'fill-rule': 'evenodd'}));
  });
  return areas;
}

function outlineOf(feasible: boolean[], columns: number, rows: number, cell: [number, number]): string {
  const inside = (c: number, r: number) => c >= 0 && r >= 0 && c < columns && r < rows && feasible[r * columns + c]!;
  const edges: string[] = [];
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      if (!inside(c, r)) continue;
      if (!inside(c - 1, r)) edges.push(`M${corner(c, r, cell)}v${-cell[1]}`);
      if (!inside(c + 1, r)) edges.push(`M${corner(c + 1, r, cell)}v${-cell[1]}`);
      if (!inside(c, r + 1)) edges.push(`M${corner(c, r + 1, cell)}h${cell[0]}`);
      if (!inside(c, r - 1)) edges.push(`M${corner(c, r, cell)}h${cell[0]}`);
    }
  }
  return edges.join('');
}

// A trend over one key, a map over two.
import {scaleLinear} from 'd3-scale';
import {line} from 'd3-shape';
import {svg} from '../dom';
import {digits, scaleFor, shownUnit} from '../quantities';
import {cleared, clickable, extent, type Frame, numbersBelow, numbersBeside, sayNothing} from './axes';

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
const noneFlaps = 'no design here flaps';
const trend: Frame = {width: 560, height: 260, left: 60, right: 14, top: 26, bottom: 40};
const map: Frame = {width: 560, height: 440, left: 64, right: 92, top: 30, bottom: 44};

/** `pick` receives the index of the design clicked. */
export function drawTrend(
  picture: SVGSVGElement,
  axis: Axis,
  metric: {name: string; unit: string},
  outcome: Outcome,
  current: number,
  pick: (index: number) => void,
) {
  const {width, height, left, right, top, bottom} = trend;
  cleared(picture, trend);
  const range = extent(outcome.metric);
  if (!range) return sayNothing(picture, trend, noneFlaps);
  const horizontal = scaledOf(axis.name, axis.unit, largest(extent(axis.values)!));
  const vertical = scaledOf(metric.name, metric.unit, largest(range));
  const x = scaleLinear(
    [axis.values[0] * horizontal.factor, axis.values[axis.values.length - 1] * horizontal.factor],
    [left, width - right],
  );
  const y = scaleLinear([range[0] * vertical.factor, range[1] * vertical.factor], [height - bottom, top]).nice(5);
  numbersBeside(picture, trend, y, 5, true);
  numbersBelow(picture, trend, x, x.ticks(6));
  picture.append(
    svg('text', {x: left, y: 14, class: 'title'}, vertical.title),
    svg('text', {x: width - right, y: height - 6, 'text-anchor': 'end'}, horizontal.title),
  );
  const place = (i: number) => x(axis.values[i] * horizontal.factor);
  const curve = line<number>(
    (_, i) => place(i),
    (v) => y(v * vertical.factor),
  ).defined((v) => Number.isFinite(v));
  picture.append(svg('path', {class: 'curve series-0', d: curve(Array.from(outcome.metric)) ?? ''}));
  const outside = line<number>(
    (_, i) => place(i),
    (v) => y(v * vertical.factor),
  ).defined((v, i) => Number.isFinite(v) && outcome.domain[i] > 0);
  picture.append(svg('path', {class: 'curve outside', d: outside(Array.from(outcome.metric)) ?? ''}));
  outcome.status.forEach((status, i) => {
    if (outcome.statuses[status] !== 'flapping') {
      picture.append(svg('rect', {class: 'fails', x: place(i) - 1.5, y: height - bottom - 6, width: 3, height: 6}));
    }
  });
  const here = current * horizontal.factor;
  if (here >= x.domain()[0] && here <= x.domain()[1]) {
    picture.append(svg('line', {class: 'cursor', x1: x(here), x2: x(here), y1: top, y2: height - bottom}));
  }
  clickable(picture, trend, (place) => {
    const at = x.invert(place.x) / horizontal.factor;
    let nearest = 0;
    axis.values.forEach((v, i) => {
      if (Math.abs(v - at) < Math.abs(axis.values[nearest] - at)) nearest = i;
    });
    pick(nearest);
  });
}

/** Designs row by row, the first axis inside. Cells that do not flap are hatched, the feasible region is outlined. */
export function drawMap(
  picture: SVGSVGElement,
  across: Axis,
  up: Axis,
  metric: {name: string; unit: string},
  outcome: Outcome,
  best: number | null,
  current: [number, number],
  pick: (index: number) => void,
) {
  const {width, height, left, right, top, bottom} = map;
  cleared(picture, map);
  const range = extent(outcome.metric);
  if (!range) return sayNothing(picture, map, noneFlaps);
  const [low, high] = range;
  const columns = across.values.length,
    rows = up.values.length;
  const cell = [(width - left - right) / columns, (height - top - bottom) / rows];
  const shade = (v: number) => (high > low ? (v - low) / (high - low) : 0.5);
  const colour = (share: number) => `hsl(${(250 - 195 * share).toFixed(0)} 62% ${(30 + 42 * share).toFixed(0)}%)`;
  const feasible = (c: number, r: number) =>
    c >= 0 && r >= 0 && c < columns && r < rows && outcome.feasible[r * columns + c];
  const cells = svg('g'),
    outline: string[] = [];
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      const value = outcome.metric[r * columns + c];
      const x = left + c * cell[0],
        y = height - bottom - (r + 1) * cell[1];
      cells.append(
        svg('rect', {
          x,
          y,
          width: cell[0] + 0.4,
          height: cell[1] + 0.4,
          ...(Number.isFinite(value) ? {fill: colour(shade(value))} : {class: 'fails'}),
        }),
      );
      if (!feasible(c, r)) continue;
      if (!feasible(c - 1, r)) outline.push(`M${x},${y}v${cell[1]}`);
      if (!feasible(c + 1, r)) outline.push(`M${x + cell[0]},${y}v${cell[1]}`);
      if (!feasible(c, r + 1)) outline.push(`M${x},${y}h${cell[0]}`);
      if (!feasible(c, r - 1)) outline.push(`M${x},${y + cell[1]}h${cell[0]}`);
    }
  }
  picture.append(cells, svg('path', {class: 'feasible', d: outline.join('')}));
  const a = scaledOf(across.name, across.unit, largest(extent(across.values)!)),
    u = scaledOf(up.name, up.unit, largest(extent(up.values)!));
  const m = scaledOf(metric.name, metric.unit, largest(range));
  const x = scaleLinear(
    [across.values[0] * a.factor, across.values[columns - 1] * a.factor],
    [left + cell[0] / 2, width - right - cell[0] / 2],
  );
  const y = scaleLinear(
    [up.values[0] * u.factor, up.values[rows - 1] * u.factor],
    [height - bottom - cell[1] / 2, top + cell[1] / 2],
  );
  numbersBelow(picture, map, x, x.ticks(6));
  numbersBeside(picture, map, y, 6, false);
  picture.append(
    svg('text', {x: width - right, y: height - 8, 'text-anchor': 'end'}, a.title),
    svg('text', {x: 4, y: 14, class: 'title'}, u.title),
    svg('text', {x: width - 4, y: 14, class: 'title', 'text-anchor': 'end'}, m.title),
  );
  for (let n = 0; n <= 40; ++n) {
    picture.append(
      svg('rect', {
        x: width - right + 14,
        y: height - bottom - ((n + 1) * (height - top - bottom)) / 41,
        width: 12,
        height: (height - top - bottom) / 41 + 0.5,
        fill: colour(n / 40),
      }),
    );
  }
  for (const share of [0, 0.5, 1]) {
    picture.append(
      svg(
        'text',
        {
          x: width - right + 30,
          y: height - bottom - share * (height - top - bottom) + (share === 1 ? 10 : 4 - 4 * share),
        },
        digits((low + share * (high - low)) * m.factor, 3),
      ),
    );
  }
  const mark = (px: number, py: number, kind: string) =>
    picture.append(svg('circle', {class: kind, cx: px, cy: py, r: 5}));
  mark(x(current[0] * a.factor), y(current[1] * u.factor), 'here');
  if (best !== null) {
    mark(x(across.values[best % columns] * a.factor), y(up.values[Math.floor(best / columns)] * u.factor), 'best');
  }
  clickable(picture, map, (place) => {
    const c = Math.floor((place.x - left) / cell[0]);
    const r = Math.floor((height - bottom - place.y) / cell[1]);
    pick(Math.min(rows - 1, Math.max(0, r)) * columns + Math.min(columns - 1, Math.max(0, c)));
  });
}

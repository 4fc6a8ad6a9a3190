// Position and attitude over the time of a flight, in two small plots with a cursor at what is shown.
import {scaleLinear} from 'd3-scale';
import {html, set, svg} from './dom';
import type {FlightTrack} from './flight_track';
import {numbersBelow, numbersBeside} from './pictures/axes';

const frame = {width: 420, height: 140, left: 46, right: 12, top: 22, bottom: 22},
  {width, height, left, right, top, bottom} = frame,
  most = 400; // points of a line

interface Plot {
  axes: SVGGElement;
  lines: SVGPathElement[];
  cursor: SVGLineElement;
  factor: number;
  least: number; // range of the axis
}

export class FlightTrace {
  readonly element = html('div', {class: 'flight-traces'});
  private readonly plots: Plot[];

  constructor() {
    this.plots = [
      this.plot('position', 'm', ['north', 'east', 'height'], 1, 0.1),
      this.plot('attitude', '°', ['roll', 'pitch', 'yaw'], 180 / Math.PI, 10),
    ];
  }

  private plot(title: string, unit: string, names: string[], factor: number, least: number): Plot {
    const axes = svg('g'),
      lines = names.map((_, n) => svg('path', {class: `curve series-${[0, 1, 3][n]}`})),
      cursor = svg('line', {class: 'cursor', y1: top, y2: height - bottom});
    let x = left;
    const labels = [`${title} [${unit}] over time [s]`, ...names].map((text, n) => {
      const label = svg('text', {x, y: 13, class: n ? `label-${[0, 1, 3][n - 1]}` : 'title'}, text);
      x += 6 * text.length + (n ? 8 : 14);
      return label;
    });
    const element = svg(
      'svg',
      {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${title} over the time of the flight`},
      axes,
      ...lines,
      cursor,
      ...labels,
    );
    this.element.append(element);
    return {axes, lines, cursor, factor, least};
  }

  /** Up to what is shown, `time` [s]. */
  draw({trace}: FlightTrack, time: number) {
    let count = trace.time.length;
    while (count > 0 && trace.time[count - 1]! > time) --count;
    const step = Math.max(1, Math.ceil(count / most));
    const rows: number[] = [];
    for (let row = 0; row < count; row += step) rows.push(row);
    if (count && rows.at(-1) !== count - 1) rows.push(count - 1);
    const x = scaleLinear([0, Math.max(0.2, time)], [left, width - right]);
    this.plots.forEach((plot, which) => {
      const values = which ? trace.angles : trace.place;
      const numbers = rows.flatMap((row) => values[row]!.map((v) => v * plot.factor));
      const [low, high] = [Math.min(0, ...numbers), Math.max(0, ...numbers)],
        slack = Math.max(0, plot.least - (high - low)) / 2;
      const y = scaleLinear([low - slack, high + slack], [height - bottom, top]).nice(4);
      plot.axes.replaceChildren();
      numbersBeside(plot.axes, frame, y, 4, true);
      numbersBelow(plot.axes, frame, x, x.ticks(5));
      plot.lines.forEach((line, n) => {
        const points = rows.map(
          (row) => `${x(trace.time[row]!).toFixed(1)},${y(values[row]![n]! * plot.factor).toFixed(1)}`,
        );
        set(line, {d: points.length ? `M${points.join('L')}` : ''});
      });
      set(plot.cursor, {x1: x(time), x2: x(time)});
    });
  }
}

// One cycle in panels, one below the other, with one cursor through all of them.
import {scaleLinear} from 'd3-scale';
import type {Columns} from '../core';
import {html, set, svg, update} from '../dom';
import {digits, scaleFor, shownUnit, withMinus} from '../quantities';
import type {InView} from '../in_view';
import {atShare, type Matched} from '../measured';
import {extent, type Frame, linesOf, numbersBelow, numbersBeside, placeOf, sayNothing} from './axes';

interface Panel {
  id: string;
  title: string;
  unit: string;
  columns: [string, string][];
} // column, label

const panels: Panel[] = [
  {
    id: 'stroke',
    title: 'stroke angle',
    unit: 'rad',
    columns: [
      ['stroke_angle_rad', 'stroke'],
      ['pitch_angle_rad', 'pitch'],
    ],
  },
  {id: 'velocity', title: 'flapping velocity', unit: 'rad/s', columns: [['flapping_velocity_rad_per_s', 'velocity']]},
  {id: 'lift', title: 'lift, all wings', unit: 'N', columns: [['lift_n', 'lift']]},
  {id: 'force', title: 'rod force', unit: 'N', columns: [['rod_force_n', 'rod force']]},
  {id: 'current', title: 'current', unit: 'A', columns: [['current_a', 'current']]},
  {
    id: 'power',
    title: 'power',
    unit: 'W',
    columns: [
      ['power_electrical_w', 'electrical'],
      ['power_motor_w', 'motor output'],
      ['power_friction_w', 'friction'],
      ['power_aerodynamic_w', 'aerodynamic'],
    ],
  },
];

export type Abscissa = 'time' | 'crank angle';
const frame: Frame = {width: 420, height: 150, left: 52, right: 8, top: 22, bottom: 32};
const {width, height, left, right, top, bottom} = frame;

/** What of a panel follows the design. */
interface Parts {
  panel: Panel;
  axes: SVGElement;
  curves: SVGElement;
}
interface Drawn extends Parts {
  figure: HTMLElement;
  picture: SVGSVGElement;
  cursor: SVGLineElement;
  readout: SVGTextElement;
}

const finite = (numbers: Float64Array | undefined): numbers is Float64Array => !!numbers && Number.isFinite(numbers[0]);

export class CyclePlots {
  private readonly drawn: Drawn[];
  private columns: Columns | null = null;
  private abscissa: Abscissa = 'time';
  private place = 0;
  /** Where the pointer reads, whatever the mechanism shows. */
  private reading: number | null = null;

  /** `scrub` receives the share of the cycle that the user points at. */
  constructor(
    parent: HTMLElement,
    private readonly inView: InView,
    scrub: (share: number) => void,
  ) {
    this.drawn = panels.map((panel) => {
      const axes = svg('g'),
        area = {x: left, y: top, width: width - left - right, height: height - top - bottom},
        // What a zoom leaves outside is cut off.
        curves = svg('svg', {...area, viewBox: `${area.x} ${area.y} ${area.width} ${area.height}`});
      const cursor = svg('line', {class: 'cursor', y1: top, y2: height - bottom, x1: left, x2: left});
      const readout = svg('text', {class: 'readout', x: width - right, y: 14, 'text-anchor': 'end'});
      const picture = svg(
        'svg',
        {
          viewBox: `0 0 ${width} ${height}`,
          role: 'img',
          'aria-label': `${panel.title} over one cycle`,
          id: `plot-${panel.id}`,
        },
        axes,
        curves,
        cursor,
        readout,
      );
      const figure = html('figure', {class: 'plot', 'data-picture': panel.id}, picture);
      const share = (event: MouseEvent) => {
        const {x} = placeOf(event, picture, frame);
        return this.shareAt(Math.min(1, Math.max(0, (x - left) / (width - left - right))));
      };
      // The pointer reads all panels at one instant; pressed, it moves the mechanism there.
      picture.addEventListener('pointermove', (event) => {
        if (event.buttons & 1) scrub(share(event));
        else this.read(share(event));
      });
      picture.addEventListener('pointerleave', () => this.read(null));
      picture.addEventListener('pointerdown', (event) => {
        picture.setPointerCapture(event.pointerId);
        this.read(null);
        scrub(share(event));
      });
      parent.append(figure);
      return {panel, figure, picture, axes, curves, cursor, readout};
    });
  }

  pictures(): [string, SVGSVGElement][] {
    return this.drawn.map((d) => [d.panel.id, d.picture]);
  }

  draw(
    columns: Columns | null,
    ghost: Columns | null,
    abscissa: Abscissa,
    forceName: string,
    measured: Matched | null = null,
    residuals = false,
  ) {
    this.columns = columns;
    this.abscissa = abscissa;
    for (const d of this.drawn) {
      const shown = d.panel.columns.filter(([name]) => columns && finite(columns[name]));
      d.figure.hidden = columns !== null && shown.length === 0;
      this.inView.draw(d.figure, () => {
        d.cursor.toggleAttribute('hidden', !columns);
        const next = {panel: d.panel, axes: svg('g'), curves: svg('g')};
        if (!columns || shown.length === 0) {
          sayNothing(next.curves, frame, 'no steady cycle');
          d.readout.textContent = d.panel.title;
        } else {
          const title = d.panel.id === 'force' ? forceName : d.panel.title;
          const compared = measured ? shown.filter(([name]) => measured.columns[name]) : [];
          if (measured && residuals && compared.length > 0)
            this.drawResiduals(next, columns, compared, title, measured);
          else this.drawPanel(next, columns, ghost, shown, title, measured);
        }
        update(d.axes, next.axes.childNodes);
        update(d.curves, next.curves.childNodes);
        this.showCursorIn(d);
      });
    }
  }

  private drawPanel(
    d: Parts,
    columns: Columns,
    ghost: Columns | null,
    shown: [string, string][],
    title: string,
    measured: Matched | null,
  ) {
    const points = shown.flatMap(([name]) => measured?.columns[name] ?? []);
    const all = shown.flatMap(([name]) => [columns[name]!, ...(ghost && finite(ghost[name]) ? [ghost[name]] : [])]);
    const [low, high] = extent(...all, ...points) ?? [0, 0];
    const scale = scaleFor(Math.max(Math.abs(low), Math.abs(high)), d.panel.unit);
    const y = scaleLinear(
      [Math.min(0, low) * scale.factor, Math.max(0, high) * scale.factor],
      [height - bottom, top],
    ).nice(4);
    const along = this.abscissaOf(columns);
    const x = this.across(along.end);
    numbersBeside(d.axes, frame, y, 4, true);
    numbersBelow(d.axes, frame, x, this.ticks(x), 12);
    d.axes.append(
      svg('text', {x: left, y: 14, class: 'title'}, `${title}, ${shownUnit(scale.unit)}`),
      ...(shown.length > 1 ? [legend(shown)] : []),
      svg('text', {x: width - right, y: height - 2, 'text-anchor': 'end'}, along.name),
    );
    const numbers = along.numbers();
    shown.forEach(([name], n) => {
      const path = (from: Columns, axis: Float64Array) =>
        linesOf(
          axis.map((t) => x(t)),
          from[name]!.map((v) => y(v * scale.factor)),
        );
      if (ghost && finite(ghost[name])) {
        const axis = this.abscissaOf(ghost);
        const stretched = axis.numbers().map((t) => (t * along.end) / axis.end);
        d.curves.append(svg('path', {class: `curve ghost series-${n}`, d: path(ghost, stretched)}));
      }
      d.curves.append(svg('path', {class: `curve series-${n}`, d: path(columns, numbers)}));
      const marks = measured?.columns[name];
      if (!marks) return;
      let dots = '';
      marks.forEach((v, row) => {
        const at = atShare(numbers, measured.shares[row]!);
        if (Number.isFinite(v) && Number.isFinite(at))
          dots += `M${x(at).toFixed(1)},${y(v * scale.factor).toFixed(1)}h0`;
      });
      d.curves.append(svg('path', {class: `measured series-${n}`, d: dots}));
    });
  }

  /** What is measured minus what the model has there. */
  private drawResiduals(d: Parts, columns: Columns, shown: [string, string][], title: string, measured: Matched) {
    const residuals = shown.map(([name]) =>
      measured.columns[name]!.map((v, row) => v - atShare(columns[name]!, measured.shares[row]!)),
    );
    const [low, high] = extent(...residuals) ?? [0, 0];
    const scale = scaleFor(Math.max(Math.abs(low), Math.abs(high)), d.panel.unit);
    const y = scaleLinear(
      [Math.min(0, low) * scale.factor, Math.max(0, high) * scale.factor],
      [height - bottom, top],
    ).nice(4);
    const along = this.abscissaOf(columns);
    const x = this.across(along.end);
    numbersBeside(d.axes, frame, y, 4, true);
    numbersBelow(d.axes, frame, x, this.ticks(x), 12);
    d.axes.append(
      svg('text', {x: left, y: 14, class: 'title'}, `${title}, measured − model, ${shownUnit(scale.unit)}`),
      ...(shown.length > 1 ? [legend(shown)] : []),
      svg('text', {x: width - right, y: height - 2, 'text-anchor': 'end'}, along.name),
    );
    const numbers = along.numbers();
    shown.forEach((_, n) => {
      let marks = '';
      residuals[n]!.forEach((v, row) => {
        const at = atShare(numbers, measured.shares[row]!);
        if (!Number.isFinite(v) || !Number.isFinite(at)) return;
        marks += `M${x(at).toFixed(1)},${y(0).toFixed(1)}V${y(v * scale.factor).toFixed(1)}`;
      });
      d.curves.append(svg('path', {class: `residual series-${n}`, d: marks}));
    });
  }

  /** The part of the horizontal axis that is shown, 0 to 1. */
  private part: [number, number] = [0, 1];

  /** Shows a part of the cycle around the cursor, `factor` times as wide; 1 is the whole cycle. */
  zoom(factor: number) {
    const columns = this.columns;
    const row = columns ? Math.round(this.place * (columns.time_s!.length - 1)) : 0;
    const along = columns ? this.abscissaOf(columns) : null;
    const centre = along ? along.at(row) / along.end : 0.5,
      from = Math.min(1 - 1 / factor, Math.max(0, centre - 0.5 / factor));
    this.part = [from, from + 1 / factor];
  }

  private across(end: number) {
    return scaleLinear([this.part[0] * end, this.part[1] * end], [left, width - right]);
  }

  private ticks(x: ReturnType<CyclePlots['across']>): number[] {
    if (this.abscissa === 'time') return x.ticks(5);
    const step = this.part[1] - this.part[0] > 0.6 ? 90 : this.part[1] - this.part[0] > 0.2 ? 30 : 15;
    const [first, last] = x.domain() as [number, number];
    return Array.from({length: 360 / step + 1}, (_, n) => step * n).filter(
      (a) => a >= first - 1e-9 && a <= last + 1e-9,
    );
  }

  private abscissaOf(columns: Columns) {
    const time = this.abscissa === 'time';
    const factor = time ? 1e3 : 180 / Math.PI,
      from = columns[time ? 'time_s' : 'crank_angle_rad']!;
    return {
      numbers: () => from.map((t) => t * factor),
      at: (row: number) => from[row]! * factor,
      end: time ? from[from.length - 1]! * factor : 360,
      name: time ? 'time, ms' : 'crank angle, °',
    };
  }

  /** The share of the cycle in time at a share of the horizontal axis. */
  private shareAt(place: number): number {
    const along = this.part[0] + place * (this.part[1] - this.part[0]);
    if (!this.columns || this.abscissa === 'time') return along;
    const angles = this.columns.crank_angle_rad!;
    let row = 0;
    while (row < angles.length - 1 && angles[row]! < along * 2 * Math.PI) ++row;
    return row / (angles.length - 1);
  }

  private read(share: number | null) {
    this.reading = share;
    this.showCursor();
  }

  /** Shows the values at a share of the cycle. */
  moveCursor(share: number) {
    this.place = share;
    if (this.reading === null) this.showCursor();
  }

  private showCursor() {
    for (const d of this.drawn) this.inView.show(d.figure, () => this.showCursorIn(d));
  }

  private showCursorIn(d: Drawn) {
    const columns = this.columns;
    if (!columns || d.figure.hidden) return;
    const row = Math.round((this.reading ?? this.place) * (columns.time_s!.length - 1));
    const along = this.abscissaOf(columns);
    const x = this.across(along.end)(along.at(row)),
      inside = x >= left - 0.5 && x <= width - right + 0.5;
    set(d.cursor, {x1: x, x2: x});
    d.cursor.toggleAttribute('hidden', !inside);
    if (d.curves.querySelector('.residual')) {
      d.readout.replaceChildren();
      return;
    }
    const parts = d.panel.columns
      .filter(([name]) => finite(columns[name]))
      .map(([name], n) => {
        const value = columns[name]![row]!,
          scale = scaleFor(value, d.panel.unit);
        return svg(
          'tspan',
          {class: `label-${n}`, dx: n ? 6 : 0},
          `${withMinus(digits(value * scale.factor, 3))} ${shownUnit(scale.unit)}`,
        );
      });
    update(d.readout, parts);
  }
}

/** The names of several curves in their colours, below the frame, so that a picture that is saved has them too. */
const legend = (shown: [string, string][]) =>
  svg(
    'text',
    {x: left, y: height - 2, class: 'names'},
    ...shown.map(([, label], n) => svg('tspan', {class: `label-${n}`, ...(n ? {dx: 8} : {})}, label)),
  );

/** What the colours of the panel of powers mean. */
export const powerSeries = panels[panels.length - 1]!.columns.map(([, label]) => label);

// The powers at one instant over the mean flows: each flow is as wide as its power, and marks move along it by the
// energy that has passed. What the moving parts and springs take up or give back is stated below.
import type {Balance, Columns, Values} from '../core';
import {layerOf, set, svg, update} from '../dom';
import {interpolated} from '../measured';
import {readable} from '../quantities';
import type {DrawnFlow, Part} from './sankey';

/** The powers of a cycle [W], row by row; only those that follow from the columns. */
export function powersOf(c: Columns, balance: Balance): Partial<Record<Part, Float64Array>> {
  const rows = c.time_s!.length;
  /** A loss that goes with `size`, whose mean is known. */
  const like = (mean: number, size: (row: number) => number): Float64Array => {
    const sizes = Float64Array.from({length: rows}, (_, row) => size(row));
    const factor = mean / (meanOf(sizes, c.time_s!) || 1);
    return sizes.map((x) => x * factor);
  };
  const current = c.current_a!,
    speed = c.crank_speed_rad_per_s!;
  const turning = c.flapping_velocity_rad_per_s && !finite(speed) ? c.flapping_velocity_rad_per_s : speed;
  const powers: Partial<Record<Part, Float64Array>> = {
    copper: like(balance.copper, (row) => current[row]! ** 2),
    viscous: like(balance.viscous, (row) => turning[row]! ** 2),
    motor_friction: like(balance.motor_friction, (row) => Math.abs(turning[row]!)),
  };
  const taken = {
    electrical: c.power_electrical_w,
    motor: c.power_motor_w,
    friction: c.power_friction_w,
    aerodynamic: c.power_aerodynamic_w,
  };
  for (const [part, numbers] of Object.entries(taken)) if (finite(numbers)) powers[part as Part] = numbers;
  // Between motor and mechanism the gearbox loses a share of what passes.
  if (balance.gear !== 0 && finite(c.power_motor_w)) {
    const passing = c.power_motor_w;
    powers.gear = like(balance.gear, (row) => Math.abs(passing[row]!));
  }
  return powers;
}

const finite = (numbers: Float64Array | undefined): numbers is Float64Array => !!numbers && Number.isFinite(numbers[0]);

/** The mean over time of numbers between which it is linear. */
export function meanOf(numbers: Float64Array, time: Float64Array): number {
  let sum = 0;
  for (let row = 1; row < numbers.length; ++row)
    sum += ((numbers[row]! + numbers[row - 1]!) / 2) * (time[row]! - time[row - 1]!);
  return sum / (time[time.length - 1]! - time[0]!);
}

/** What has passed until each row, as a share of what passes in a cycle. */
function passed(numbers: Float64Array, time: Float64Array, mean: number): Float64Array {
  const whole = mean * (time[time.length - 1]! - time[0]!) || 1;
  const found = new Float64Array(numbers.length);
  for (let row = 1; row < numbers.length; ++row)
    found[row] = found[row - 1]! + ((numbers[row]! + numbers[row - 1]!) / 2) * ((time[row]! - time[row - 1]!) / whole);
  return found;
}

const marks = 4, // that pass a place in a cycle
  apart = 26, // [pixels]
  widest = 3; // of the mean flow

interface Live {
  flow: DrawnFlow;
  power: Float64Array;
  passed: Float64Array;
  wide: SVGPathElement;
  line: SVGPathElement;
}

export class LiveFlow {
  private live: Live[] = [];
  private stored: Float64Array | null = null;
  private note: SVGTextElement | null = null;

  /** Over the flows that drawSankey has drawn. */
  constructor(private readonly picture: SVGSVGElement) {}

  set(flows: DrawnFlow[], balance: Balance | null, columns: Columns | null, values: Values) {
    this.live = [];
    this.stored = this.note = null;
    const layer = layerOf(this.picture, 'moving'),
      drawn: SVGElement[] = [];
    if (!columns || !balance || flows.length === 0) return update(layer, drawn);
    const powers = powersOf(columns, balance),
      time = columns.time_s!;
    const moving = flows.flatMap((flow) => {
      const power = powers[flow.part];
      return power ? [{flow, power, passed: passed(power, time, flow.mean)}] : [];
    });
    for (const {flow} of moving) {
      const path = (kind: string) => svg('path', {class: `live ${kind} flow-${flow.kind}`, d: flow.d});
      drawn.push(path('now'), path('marks'));
    }
    const [, , , height] = this.picture.getAttribute('viewBox')!.split(' ').map(Number);
    drawn.push(svg('text', {class: 'live', x: 4, y: height! - 2}));
    update(layer, drawn);
    const [...children] = layer.children;
    this.live = moving.map((each, n) => ({
      ...each,
      wide: children[2 * n] as SVGPathElement,
      line: children[2 * n + 1] as SVGPathElement,
    }));
    this.note = children[2 * moving.length] as SVGTextElement;
    this.stored = storedPower(powers, balance, time.length);
    this.parts = ['rotor', 'wings', ...(Number(values['spring.stiffness']) > 0 ? ['springs'] : [])];
  }
  private parts: string[] = [];

  show(share: number) {
    for (const {flow, power, passed: gone, wide, line} of this.live) {
      const now = interpolated(power, share) / flow.mean;
      set(wide, {'stroke-width': (flow.width * Math.min(widest, Math.abs(now))).toFixed(1)});
      wide.classList.toggle('back', now < 0);
      set(line, {'stroke-dashoffset': (-marks * apart * interpolated(gone, share)).toFixed(1)});
    }
    if (!this.note || !this.stored) return;
    const now = interpolated(this.stored, share),
      where = `${this.parts.slice(0, -1).join(', ')} and ${this.parts.at(-1)}`;
    this.note.textContent = `now ${readable(Math.abs(now), 'W', 2)} ${now < 0 ? 'from' : 'into'} ${where}`;
  }
}

/** What is neither lost nor given to the air; flows that are known only in the mean count as even. */
function storedPower(powers: Partial<Record<Part, Float64Array>>, balance: Balance, rows: number): Float64Array | null {
  const {electrical} = powers;
  if (!electrical) return null;
  const spent: Part[] = [
    'copper',
    'viscous',
    'motor_friction',
    'electronics',
    'gear',
    'friction',
    'hinge',
    'aerodynamic',
    'residual',
  ];
  return Float64Array.from({length: rows}, (_, row) =>
    spent.reduce((left, part) => left - (powers[part]?.[row] ?? balance[part as keyof Balance]), electrical[row]!),
  );
}

// A measured cycle beside the model's: columns named as in waveform files, over time or crank angle.
import {dsvFormat} from 'd3-dsv';
import type {Columns} from './core';

export interface Measured {
  name: string;
  /** Equal lengths; NaN where a cell has no number. */
  columns: Columns;
  ignored: string[];
}
/** Where each row is in the model's cycle, 0 to 1, and how far its columns are from the model. */
export interface Matched {
  shares: Float64Array;
  columns: Columns;
  /** [s] added to the times of the file, so that deviations are least; null of crank angles. */
  shift: number | null;
  /** Root mean square, in the unit of the column. */
  deviations: Record<string, number>;
}

const abscissae = ['time_s', 'crank_angle_rad'];

/** Throws an Error that says what is missing. */
export function readMeasured(name: string, text: string, known: readonly string[]): Measured {
  const lines = text
    .replace(/^\ufeff/, '')
    .split(/\r?\n/)
    .filter((line) => line.trim() && !line.startsWith('#'));
  const head = lines[0] ?? '';
  const separator = [';', '\t', ','].find((s) => head.includes(s)) ?? ',';
  const rows = dsvFormat(separator).parse(lines.join('\n'));
  const names = rows.columns.map((column) => column.trim());
  const number = (cell: string | undefined) =>
    cell?.trim() ? Number(cell.replace(separator === ';' ? ',' : /$^/, '.')) : NaN;
  const columns: Columns = {};
  names.forEach((column, n) => {
    if (!known.includes(column)) return;
    columns[column] = Float64Array.from(rows, (row) => number(row[rows.columns[n]!]));
  });
  const found = Object.keys(columns);
  if (!found.some((column) => abscissae.includes(column)))
    throw new Error(`${name}: a column time_s or crank_angle_rad is missing; the first line has ${names.join(', ')}`);
  if (found.every((column) => abscissae.includes(column)))
    throw new Error(`${name}: no column of a waveform file, such as current_a or lift_n, is among ${names.join(', ')}`);
  if (rows.length < 2) throw new Error(`${name}: at least two rows of numbers are needed`);
  return {name, columns, ignored: names.filter((column) => !known.includes(column))};
}

/** Of numbers at equal steps from 0 to 1 the one at a share, on a straight line between two. */
export function interpolated(numbers: Float64Array, share: number): number {
  const place = share * (numbers.length - 1),
    row = Math.min(numbers.length - 2, Math.floor(place));
  return numbers[row]! + (place - row) * (numbers[row + 1]! - numbers[row]!);
}

/** Linear between the rows of a cycle, at a share of its period. */
export const atShare = (numbers: Float64Array, share: number) => interpolated(numbers, share - Math.floor(share));

const turn = 2 * Math.PI;

/** The share of the cycle at which the crank is at an angle. */
function shareOfAngle(angles: Float64Array, angle: number): number {
  const first = angles[0]!,
    wanted = first + ((((angle - first) % turn) + turn) % turn);
  let low = 0,
    high = angles.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (angles[middle]! <= wanted) low = middle;
    else high = middle;
  }
  return (low + (wanted - angles[low]!) / (angles[high]! - angles[low]! || 1)) / (angles.length - 1);
}

const meanSquare = (numbers: number[]) => numbers.reduce((sum, x) => sum + x * x, 0) / Math.max(1, numbers.length);

/** The rows in the model's cycle; times are shifted as a whole so that the deviations are least. */
export function match({columns}: Measured, cycle: Columns): Matched {
  const names = [...sizesOf({columns} as Measured, cycle).keys()];
  const deviationsAt = (shares: Float64Array, name: string) => {
    const found: number[] = [];
    columns[name]!.forEach((y, row) => {
      if (Number.isFinite(y) && Number.isFinite(shares[row])) found.push(y - atShare(cycle[name]!, shares[row]!));
    });
    return found;
  };
  const time = columns.time_s,
    period = cycle.time_s![cycle.time_s!.length - 1]!;
  let shift: number | null = null;
  let shares: Float64Array;
  if (time) {
    const at = (s: number) => time.map((t) => (t + s) / period - Math.floor((t + s) / period));
    const sizes = new Map(names.map((name) => [name, meanSquare(Array.from(cycle[name]!)) || 1]));
    const total = (s: number) => {
      const trial = at(s);
      return names.reduce((sum, name) => sum + meanSquare(deviationsAt(trial, name)) / sizes.get(name)!, 0);
    };
    shift = least(total, period);
    shares = at(shift);
  } else {
    shares = columns.crank_angle_rad!.map((angle) => shareOfAngle(cycle.crank_angle_rad!, angle));
  }
  const deviations = Object.fromEntries(names.map((name) => [name, Math.sqrt(meanSquare(deviationsAt(shares, name)))]));
  return {shares, columns, shift, deviations};
}

/**
 * Deviations of the model from a measurement that begins at a share of the period, each over the size of its column in
 * the first cycle compared with, and their derivatives by the beginning.
 */
export function residualsOf({columns}: Measured, cycle: Columns, sizes: ReadonlyMap<string, number>, shift: number) {
  const time = columns.time_s,
    period = cycle.time_s![cycle.time_s!.length - 1]!;
  const residuals: number[] = [],
    byShift: number[] = [];
  for (const [name, size] of sizes) {
    const model = cycle[name]!,
      rows = model.length - 1;
    columns[name]!.forEach((y, row) => {
      const share = time
        ? time[row]! / period + shift
        : shareOfAngle(cycle.crank_angle_rad!, columns.crank_angle_rad![row]!);
      if (!Number.isFinite(y) || !Number.isFinite(share)) return;
      residuals.push((atShare(model, share) - y) / size);
      byShift.push(((atShare(model, share + 0.5 / rows) - atShare(model, share - 0.5 / rows)) * rows) / size);
    });
  }
  return {residuals: Float64Array.from(residuals), byShift: time ? Float64Array.from(byShift) : null};
}

/** The columns that a cycle and a measurement have in common, each with its size. */
export function sizesOf({columns}: Measured, cycle: Columns): Map<string, number> {
  const names = Object.keys(columns).filter(
    (name) => !abscissae.includes(name) && cycle[name] && Number.isFinite(cycle[name][0]),
  );
  return new Map(names.map((name) => [name, Math.sqrt(meanSquare(Array.from(cycle[name]!))) || 1]));
}

/** Where a periodic function is least: the best of equidistant points, then of ever finer ones around it. */
function least(f: (s: number) => number, period: number): number {
  let best = 0,
    lowest = f(0),
    width = period;
  for (let level = 0; level < 4; ++level) {
    const points = level === 0 ? 48 : 12,
      centre = best;
    for (let n = 0; n < points; ++n) {
      const s = centre + width * ((n + 0.5) / points - 0.5),
        value = f(s);
      if (value < lowest) [best, lowest] = [s, value];
    }
    width = (2 * width) / points;
  }
  return best;
}

// What a flight has been so far: rows around what is shown, and fewer of all that went before for the trace.
import type {Columns} from './library';

/** Row by row; `at` joins neighbours by straight lines. */
export class FlightTrack {
  private rows: Columns = {};
  /** One row in so many: time, place and attitude. */
  readonly trace = {time: [] as number[], place: [] as number[][], angles: [] as number[][]};
  private count = 0;

  /** `every`: rows of a wingbeat; the trace has one in that many. */
  constructor(readonly every: number) {}

  get end() {
    const {time_s} = this.rows;
    return time_s?.length ? time_s[time_s.length - 1]! : -Infinity;
  }
  get names() {
    return Object.keys(this.rows);
  }

  /** Rows that follow; those before `keep` [s] are left to the trace. */
  append(columns: Columns, keep: number) {
    const {time_s} = columns;
    if (!time_s?.length) return;
    for (let row = 0; row < time_s.length; ++row, ++this.count) {
      if (this.count % this.every) continue;
      const of = (...names: string[]) => names.map((name) => columns[name]![row]!);
      this.trace.time.push(time_s[row]!);
      this.trace.place.push(of('north_m', 'east_m', 'height_m'));
      this.trace.angles.push(of('roll_rad', 'pitch_rad', 'yaw_rad'));
    }
    const before = this.rows.time_s;
    if (!before) {
      this.rows = columns;
      return;
    }
    // A wingbeat before `keep` stays, for means.
    let first = before.length;
    while (first > 0 && before[first - 1]! >= keep) --first;
    first = Math.max(0, first - this.every - 1);
    for (const [name, added] of Object.entries(columns)) {
      const old = this.rows[name]!.subarray(first),
        joined = new Float64Array(old.length + added.length);
      joined.set(old);
      joined.set(added, old.length);
      this.rows[name] = joined;
    }
  }

  /** Every column at an instant within the rows; angles the short way round. */
  at(time: number): Record<string, number> {
    const {time_s} = this.rows;
    if (!time_s?.length) return {};
    const [row, share] = this.find(time);
    const next = Math.min(row + 1, time_s.length - 1),
      found: Record<string, number> = {};
    for (const [name, numbers] of Object.entries(this.rows)) {
      const from = numbers[row]!;
      let step = numbers[next]! - from;
      if (name.endsWith('_rad')) step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
      found[name] = share ? from + share * step : from;
    }
    return found;
  }

  /** The mean of a column over the rows of the wingbeat before an instant. */
  mean(name: string, time: number): number {
    const numbers = this.rows[name];
    if (!numbers) return NaN;
    const last = this.find(time)[0];
    let sum = 0,
      count = 0;
    for (let row = Math.max(0, last - this.every + 1); row <= last; ++row) {
      if (!Number.isFinite(numbers[row]!)) continue;
      sum += numbers[row]!;
      ++count;
    }
    return sum / count;
  }

  private find(time: number): [row: number, share: number] {
    const time_s = this.rows.time_s!;
    let low = 0,
      high = time_s.length - 1;
    if (time <= time_s[0]!) return [0, 0];
    if (time >= time_s[high]!) return [high, 0];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time_s[middle]! <= time) low = middle;
      else high = middle;
    }
    return [low, (time - time_s[low]!) / (time_s[high]! - time_s[low]!)];
  }
}

/** The largest of 1, 2 and 5 times a power of ten below x. */
export function roundBelow(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}

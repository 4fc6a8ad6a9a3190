// Keys fitted to a measured cycle: least squares by Levenberg and Marquardt, in logarithms of the keys, which are
// positive, and with the time at which the measurement begins as one more unknown.

/** A design: deviations from the measurement, each over the size of its quantity. */
export interface Compared {
  residuals: Float64Array;
  /** By the beginning of the measurement, as a share of the period; null of measurements over crank angles. */
  byShift: Float64Array | null;
}
export interface Fitted {
  values: number[]; // of the keys [SI]
  shift: number; // share of the period
  /** Root mean square of the deviations, each over the size of its quantity. */
  deviation: number;
}
export interface FitResult {
  path: Fitted[]; // designs accepted, the start first
  solved: number;
  /** Standard error of the logarithm of each key from the scatter of the deviations; null: the data do not fix it. */
  errors: (number | null)[];
  /** Whether it ended because nothing gets better, not because of the number of designs. */
  converged: boolean;
}
export interface FitLimits {
  lower: number[];
  upper: number[];
}

const step = 1e-4, // of logarithms, for differences
  mostSolved = 240,
  smallest = 1e-6, // change of logarithms at which it ends
  least = 1e-5, // relative gain at which it ends
  undetermined = 1e-7; // share of a column that the others leave

const rms = (r: Float64Array) => Math.sqrt(r.reduce((sum, x) => sum + x * x, 0) / r.length);

/** Solves a positive definite system in place; null where it is singular. */
export function solvePositive(matrix: number[][], right: number[]): number[] | null {
  const n = right.length,
    a = matrix.map((row) => [...row]),
    x = [...right];
  for (let k = 0; k < n; ++k) {
    let pivot = a[k]![k]!;
    for (let j = 0; j < k; ++j) pivot -= a[k]![j]! ** 2;
    if (!(pivot > undetermined ** 2 * (matrix[k]![k]! || 1))) return null;
    a[k]![k] = Math.sqrt(pivot);
    for (let i = k + 1; i < n; ++i) {
      let sum = a[i]![k]!;
      for (let j = 0; j < k; ++j) sum -= a[i]![j]! * a[k]![j]!;
      a[i]![k] = sum / a[k]![k]!;
    }
  }
  for (let i = 0; i < n; ++i) {
    for (let j = 0; j < i; ++j) x[i]! -= a[i]![j]! * x[j]!;
    x[i]! /= a[i]![i]!;
  }
  for (let i = n - 1; i >= 0; --i) {
    for (let j = i + 1; j < n; ++j) x[i]! -= a[j]![i]! * x[j]!;
    x[i]! /= a[i]![i]!;
  }
  return x;
}

/** `compare` gives null for designs that do not flap; `accepted` receives each design on the path. */
export function fit(
  start: number[],
  shift: number,
  {lower, upper}: FitLimits,
  compare: (values: number[], shift: number) => Compared | null,
  accepted: (fitted: Fitted) => void = () => {},
): FitResult | null {
  const keys = start.length;
  let solved = 1;
  const first = compare(start, shift);
  if (!first) return null;
  let here = {values: start, shift, compared: first, deviation: rms(first.residuals)};
  const path: Fitted[] = [],
    keep = () => {
      const {values, shift: at, deviation} = here;
      path.push({values, shift: at, deviation});
      accepted(path.at(-1)!);
    };
  keep();
  let damping = 1e-3,
    converged = false;
  let columns: Float64Array[] | null = null;
  while (solved < mostSolved && !converged) {
    columns ??= slopes();
    if (!columns) break;
    const unknowns = columns.length,
      r = here.compared.residuals;
    const dot = (a: Float64Array, b: Float64Array) => a.reduce((sum, x, i) => sum + x * b[i]!, 0);
    const normal = columns.map((a) => columns!.map((b) => dot(a, b))),
      right = columns.map((a) => -dot(a, r));
    const damped = normal.map((row, i) => row.map((x, j) => (i === j ? x * (1 + damping) + 1e-300 : x)));
    const change = solvePositive(damped, right);
    if (!change) {
      damping *= 10;
      if (damping > 1e8) break;
      continue;
    }
    if (Math.max(...change.map(Math.abs)) < smallest) {
      converged = true;
      break;
    }
    const values = here.values.map((v, i) =>
      Math.min(upper[i]!, Math.max(lower[i]!, v * Math.exp(Math.max(-0.5, Math.min(0.5, change[i]!))))),
    );
    const at = unknowns > keys ? here.shift + Math.max(-0.05, Math.min(0.05, change[keys]!)) : here.shift;
    const compared = compare(values, at);
    ++solved;
    const deviation = compared ? rms(compared.residuals) : Infinity;
    if (compared && deviation < here.deviation) {
      converged = here.deviation - deviation < least * here.deviation;
      here = {values, shift: at, compared, deviation};
      damping = Math.max(1e-9, damping / 5);
      columns = null;
      keep();
    } else {
      damping *= 4;
      converged = damping > 1e6;
    }
  }
  return {path, solved, errors: errorsOf(columns ?? slopes()), converged};

  /** Of the deviations by the logarithms of the keys and by the beginning. */
  function slopes(): Float64Array[] | null {
    const {values, shift: at, compared} = here;
    const found: Float64Array[] = [];
    for (let k = 0; k < keys; ++k) {
      // Towards the inside, where the value is at its upper limit.
      const sense = values[k]! * Math.exp(step) > upper[k]! ? -1 : 1;
      const moved = compare(
        values.map((v, i) => (i === k ? v * Math.exp(sense * step) : v)),
        at,
      );
      ++solved;
      if (!moved) return null;
      found.push(moved.residuals.map((x, i) => (x - compared.residuals[i]!) / (sense * step)));
    }
    if (compared.byShift) found.push(compared.byShift);
    return found;
  }

  function errorsOf(by: Float64Array[] | null): (number | null)[] {
    const none = here.values.map(() => null);
    if (!by) return none;
    const freedom = here.compared.residuals.length - by.length;
    if (freedom <= 0) return none;
    const sizes = by.map((column) => Math.sqrt(column.reduce((sum, x) => sum + x * x, 0)));
    // What has no effect at all is left out, lest nothing else could be solved for.
    const used = by.map((_, i) => i).filter((i) => sizes[i]! > 0);
    const dot = (i: number, j: number) =>
      by[i]!.reduce((sum, x, n) => sum + x * by[j]![n]!, 0) / (sizes[i]! * sizes[j]!);
    const matrix = used.map((i) => used.map((j) => dot(i, j)));
    const variance = (here.deviation ** 2 * here.compared.residuals.length) / freedom;
    return here.values.map((_, k) => {
      const place = used.indexOf(k);
      if (place < 0) return null;
      const inverse = solvePositive(
        matrix,
        used.map((i) => (i === k ? 1 : 0)),
      );
      const own = inverse?.[place] ?? 0;
      return own > 0 ? Math.sqrt(own * variance) / sizes[k]! : null;
    });
  }
}

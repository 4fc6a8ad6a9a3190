// From a design to one that lifts its weight with little power: sequential linear programming with exact derivatives,
// in logarithms of the keys, within a trust region and the limits of the user.

/** A design: lift over weight and electrical power [W] with their derivatives by the logarithms of the keys. */
export interface Tried {
  values: number[]; // of the keys [SI]
  lift: number;
  power: number;
  liftSlopes: number[];
  powerSlopes: number[];
  inside: boolean; // the model's domain
}
export interface Limits {
  lower: number[];
  upper: number[];
  /** Lift over weight that is wanted. */
  target: number;
}
export interface Found {
  path: Tried[]; // designs accepted, the start first
  tried: number;
  hovers: boolean;
}

const widest = 0.3,
  firstStep = 0.15,
  narrowest = 2e-4,
  mostTrials = 60,
  margin = 5e-4; // of the target, so that the curvature does not leave a step short of it

/**
 * The change of logarithms that costs least power among those that reach the target, to first order; the one that
 * lifts most where none does. With one constraint beside bounds, keys are moved in the order of power per lift.
 */
export function linearStep(from: Tried, {lower, upper, target}: Limits, radius: number): number[] {
  const low = from.values.map((v, i) => Math.min(0, Math.max(-radius, Math.log(lower[i]! / v)))),
    high = from.values.map((v, i) => Math.max(0, Math.min(radius, Math.log(upper[i]! / v))));
  const step = from.powerSlopes.map((slope, i) => (slope > 0 ? low[i]! : slope < 0 ? high[i]! : 0));
  let missing = target * (1 + margin) - from.lift - step.reduce((sum, d, i) => sum + d * from.liftSlopes[i]!, 0);
  const moves = step
    .map((d, i) => {
      const end = from.liftSlopes[i]! > 0 ? high[i]! : low[i]!;
      const gain = (end - d) * from.liftSlopes[i]!;
      return {i, end, gain, price: ((end - d) * from.powerSlopes[i]!) / gain};
    })
    .filter(({gain}) => gain > 0)
    .sort((a, b) => a.price - b.price);
  for (const {i, end, gain} of moves) {
    if (missing <= 0) break;
    step[i]! += Math.min(1, missing / gain) * (end - step[i]!);
    missing -= gain;
  }
  return step;
}

/** `evaluate` gives null where a design does not flap; `accepted` receives each design on the path. */
export function makeHover(
  start: Tried,
  limits: Limits,
  evaluate: (values: number[]) => Tried | null,
  accepted: (tried: Tried) => void = () => {},
): Found {
  const short = (t: Tried) => Math.max(0, limits.target - t.lift);
  const path = [start];
  let here = start,
    radius = firstStep,
    tried = 0,
    idle = 0;
  accepted(start);
  while (radius > narrowest && tried < mostTrials && idle < 3) {
    const step = linearStep(here, limits, radius);
    if (Math.max(...step.map(Math.abs)) < narrowest / 10) break;
    const next = evaluate(here.values.map((v, i) => v * Math.exp(step[i]!)));
    ++tried;
    const better =
      next &&
      (next.inside || !here.inside) &&
      (short(here) > 0 ? short(next) < short(here) : short(next) === 0 && next.power < here.power);
    if (!better) {
      radius /= 3;
      continue;
    }
    idle = short(here) === 0 && here.power - next.power < 1e-5 * here.power ? idle + 1 : 0;
    radius = Math.min(widest, 1.6 * radius);
    here = next;
    path.push(here);
    accepted(here);
  }
  return {path, tried, hovers: short(here) === 0};
}

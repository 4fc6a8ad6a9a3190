// Which joints of the mechanism can be moved by hand, and what moving one does to the key of the vehicle file.
import type {Key, Mechanism, Values} from '../core';
import type {Point} from './mechanism';

export interface Grip {
  readonly joint: 'pin' | 'hinge' | 'tip';
  readonly key: string;
  readonly name: string;
}

const has = (values: Values, key: string) => typeof values[key] === 'number';

/** The joints whose place a number of this vehicle gives; a scheme's joints give none, but for the wing's tip. */
export function gripsOf(m: Mechanism, values: Values, keys: readonly Key[]): Grip[] {
  const grips: Grip[] = [];
  const drawnToScale = m.type === 'slider-crank' || m.type === 'four-bar';
  if (drawnToScale) grips.push({joint: 'pin', key: 'transmission.crank_radius', name: 'crank pin'});
  const hinge = ['transmission.hinge_offset', 'transmission.stroke_amplitude', 'transmission.ground_length'].find(
    (key) => has(values, key),
  );
  if (drawnToScale && hinge) grips.push({joint: 'hinge', key: hinge, name: 'hinge'});
  const wing = wingKey(values, keys);
  if (wing) grips.push({joint: 'tip', key: wing, name: 'wing tip'});
  return grips;
}

/** The length of the wing where the outline has one, else its scale. */
function wingKey(values: Values, keys: readonly Key[]): string | null {
  const wanted = ['wing.planform.length', 'wing.planform.scale'];
  return wanted.find((key) => has(values, key)) ?? keys.find(({key}) => key === 'wing.planform.scale')?.key ?? null;
}

/** How long the wings are: 1 where nothing scales them. */
export const wingSize = (values: Values) => {
  const number = (key: string) => (has(values, key) ? Number(values[key]) : 1);
  return number('wing.planform.length') * number('wing.planform.scale');
};

/** Wings are drawn longer and shorter as those of the file are made so, within limits that leave room for the rest. */
export const drawnWing = (values: Values, base: Values) =>
  Math.min(2.5, Math.max(0.4, wingSize(values) / wingSize(base)));

const along = (from: Point, to: Point, p: Point): number => {
  const [x, y] = [to[0] - from[0], to[1] - from[1]];
  return ((p[0] - from[0]) * x + (p[1] - from[1]) * y) / (x * x + y * y || 1);
};

/** The value of the key with the joint moved from where it is to `p`; null where no vehicle has its joint there. */
export function valueAt(grip: Grip, values: Values, at: (joint: string) => Point, p: Point): number | null {
  const value = has(values, grip.key) ? Number(values[grip.key]) : 1;
  let found: number;
  if (grip.joint === 'pin') found = value * along(at('axis'), at('pin'), p);
  else if (grip.joint === 'tip') found = value * along(at('hinge'), at('tip'), p);
  else if (grip.key === 'transmission.stroke_amplitude')
    found = Math.atan(Number(values['transmission.crank_radius']) / (p[0] - at('axis')[0]));
  else found = p[0] - at('axis')[0];
  return found > 0 ? Number(found.toPrecision(5)) : null;
}

// The mechanism at one instant of the cycle, to scale but for the wings' length; arrows for what acts.
import type {Columns, Mechanism} from '../core';
import {svg} from '../dom';
import {readable} from '../quantities';

type Point = [number, number];

/** What is shown at one instant; forces as shares of the cycle's peaks, -1 to 1. */
export interface Instant {
  crankAngle: number;
  strokeAngle: number;
  rodForce: number;
  lift: number;
  motorTorque: number;
  friction: number;
  angleOfAttack: number | null;
  strokeVelocity: number;
}
/** Where a crank that does not flap rests, and ranges at which a stopped one would [rad]. */
export interface Rest {
  angle: number | null;
  stopped: boolean;
  text: string;
}

const width = 480,
  height = 360;

const onCircle = (centre: Point, radius: number, angle: number): Point => [
  centre[0] + radius * Math.cos(angle),
  centre[1] + radius * Math.sin(angle),
];

/** Lines in metres, y upwards, drawn into a picture whose extent is known beforehand. */
class Sketch {
  readonly group = svg('g');
  constructor(
    private readonly centre: Point,
    private readonly scale: number,
  ) {}
  at([x, y]: Point): Point {
    return [width / 2 + (x - this.centre[0]) * this.scale, height / 2 - (y - this.centre[1]) * this.scale];
  }
  line(a: Point, b: Point, kind: string, opacity = 1) {
    const [x1, y1] = this.at(a),
      [x2, y2] = this.at(b);
    this.group.append(svg('line', {x1, y1, x2, y2, class: kind, opacity}));
  }
  circle(p: Point, pixels: number, kind: string, opacity = 1) {
    const [cx, cy] = this.at(p);
    this.group.append(svg('circle', {cx, cy, r: pixels, class: kind, opacity}));
  }
  ring(p: Point, radius: number, kind: string) {
    this.circle(p, radius * this.scale, kind);
  }
  square(p: Point, half: number) {
    const [x, y] = this.at(p);
    this.group.append(svg('rect', {x: x - half, y: y - half, width: 2 * half, height: 2 * half, class: 'slider'}));
  }
  ground(p: Point) {
    const [x, y] = this.at(p);
    this.group.append(svg('path', {class: 'ground', d: `M${x},${y}l-7,13h14zM${x - 11},${y + 13}h22`}));
    this.circle(p, 3.5, 'joint');
  }
  spring(p: Point) {
    const [x, y] = this.at(p);
    let d = '';
    for (let n = 0; n <= 60; ++n) {
      const radius = 5 + (10 * n) / 60,
        angle = (2 * Math.PI * 2.25 * n) / 60;
      d += `${n ? 'L' : 'M'}${(x + radius * Math.cos(angle)).toFixed(1)},${(y + radius * Math.sin(angle)).toFixed(1)}`;
    }
    this.group.append(svg('path', {class: 'spring', d}));
  }
  /** An arrow from a point, in pixels. */
  arrow(from: Point, dx: number, dy: number, kind: string) {
    if (Math.hypot(dx, dy) < 3) return;
    const [x, y] = this.at(from);
    const angle = Math.atan2(dy, dx),
      tip: Point = [x + dx, y + dy];
    const barb = (turn: number) =>
      onCircle(tip, 7, angle + Math.PI + turn)
        .map((v) => v.toFixed(1))
        .join(',');
    this.group.append(
      svg('path', {
        class: `arrow ${kind}`,
        d: `M${x},${y}L${tip.join(',')}M${barb(0.45)}L${tip.join(',')}L${barb(-0.45)}`,
      }),
    );
  }
  /** The motor's torque as part of a circle around the crank axis. */
  torque(p: Point, pixels: number, share: number) {
    if (Math.abs(share) < 0.03) return;
    const [x, y] = this.at(p),
      sweep = 0.2 + 1.9 * Math.min(1, Math.abs(share)),
      turn = share > 0 ? -1 : 1;
    const start = Math.PI / 2 + 0.3,
      end = start + turn * sweep;
    const a = onCircle([x, y], pixels, start),
      b = onCircle([x, y], pixels, end);
    const heading = end + (turn * Math.PI) / 2;
    const barb = (side: number) =>
      onCircle(b, 7, heading + Math.PI + side)
        .map((v) => v.toFixed(1))
        .join(',');
    this.group.append(
      svg('path', {
        class: 'arrow torque',
        d: `M${a}A${pixels},${pixels} 0 ${sweep > Math.PI ? 1 : 0} ${
          turn > 0 ? 1 : 0
        } ${b}M${barb(0.45)}L${b}L${barb(-0.45)}`,
      }),
    );
  }
  name(text: string, p: Point, anchor: 'start' | 'middle' | 'end', dx = 0, dy = 0) {
    const [x, y] = this.at(p);
    this.group.append(svg('text', {x: x + dx, y: y + dy, 'text-anchor': anchor}, text));
  }
}

function interpolated(numbers: Float64Array, angle: number): number {
  const turns = angle / (2 * Math.PI),
    place = (turns - Math.floor(turns)) * (numbers.length - 1);
  const row = Math.min(numbers.length - 2, Math.floor(place));
  return numbers[row] + (place - row) * (numbers[row + 1] - numbers[row]);
}

/** The stroke angle that the transmission gives at a crank angle. */
export const strokeAt = (m: Mechanism, angle: number) => interpolated(m.columns.stroke_angle_rad, angle);

function sliderCrank(m: Mechanism, i: Instant, range: [number, number], names: boolean): Sketch {
  const r = m.crank_radius,
    wing = 1.3 * m.rod_length,
    y0 = m.mid_stroke_height;
  const reach = Math.max(m.hinge_offset + wing, 1.5 * r);
  const low = Math.min(-1.5 * r, y0 - 0.8 * wing),
    high = Math.max(y0 + 0.8 * wing, y0 + 1.8 * r);
  const scale = Math.min((width - 40) / (2 * reach), (height - 34) / (high - low));
  const s = new Sketch([0, (low + high) / 2], scale);
  const axis: Point = [0, 0],
    pin = onCircle(axis, r, i.crankAngle);
  const slider: Point = [0, interpolated(m.columns.slider_height_m, i.crankAngle)];
  s.line([0, -1.3 * r], [0, y0 + 1.7 * r], 'faint dashed');
  s.ring(axis, r, 'faint');
  for (const side of [1, -1]) {
    const hinge: Point = [side * m.hinge_offset, y0],
      zero = side > 0 ? 0 : Math.PI;
    for (const end of range) s.line(hinge, onCircle(hinge, wing, zero - side * end), 'faint');
    const tip = onCircle(hinge, wing, zero - side * i.strokeAngle);
    s.line(hinge, tip, 'wing');
    s.line(slider, hinge, 'lever');
    if (m.springs) s.spring(hinge);
    s.ground(hinge);
    s.arrow(onCircle(hinge, 0.7 * wing, zero - side * i.strokeAngle), 0, -55 * i.lift, 'lift');
    if (names && side < 0) s.name('wing', tip, 'middle', 0, 20);
    if (names && side > 0 && m.springs) s.name('spring', hinge, 'start', 20, 6);
  }
  s.circle(pin, 9 + 14 * Math.abs(i.friction), 'glow', Math.abs(i.friction));
  s.line(pin, slider, 'rod glow-rod', Math.abs(i.rodForce));
  s.line(pin, slider, 'rod');
  s.line(axis, pin, 'crank');
  s.square(slider, 7);
  s.ground(axis);
  s.circle(pin, 3.5, 'joint');
  const up = Math.sign(i.rodForce);
  const length = Math.hypot(slider[0] - pin[0], slider[1] - pin[1]) || 1;
  s.arrow(
    slider,
    (up * 50 * Math.abs(i.rodForce) * (slider[0] - pin[0])) / length,
    (-up * 50 * Math.abs(i.rodForce) * (slider[1] - pin[1])) / length,
    'force',
  );
  s.torque(axis, Math.max(16, 0.55 * r * scale), i.motorTorque);
  if (names) {
    s.name('crank', [-r, 0], 'end', -10, 4);
    s.name('slider', slider, 'start', 12, -8);
    s.name('rod', [(pin[0] + slider[0]) / 2, (pin[1] + slider[1]) / 2], 'start', 10, 4);
  }
  return s;
}

function fourBar(m: Mechanism, i: Instant, range: [number, number], names: boolean): Sketch {
  const r = m.crank_radius,
    d = m.ground_length,
    p = m.rocker_length,
    wing = 0.9 * (d + p);
  const scale = Math.min((width - 40) / (1.6 * r + d + wing), (height - 40) / (2.2 * wing));
  const s = new Sketch([(d + wing - 1.6 * r) / 2, 0], scale);
  const axis: Point = [0, 0],
    pin = onCircle(axis, r, i.crankAngle),
    hinge: Point = [d, 0];
  const rocker = onCircle(hinge, p, m.ground_angle + i.strokeAngle / m.stroke_ratio);
  s.line(axis, hinge, 'faint dashed');
  s.ring(axis, r, 'faint');
  for (const end of range) s.line(hinge, onCircle(hinge, wing, end), 'faint');
  s.line(hinge, onCircle(hinge, wing, i.strokeAngle), 'wing');
  s.line(hinge, rocker, 'rocker');
  s.circle(pin, 9 + 14 * Math.abs(i.friction), 'glow', Math.abs(i.friction));
  s.line(pin, rocker, 'rod glow-rod', Math.abs(i.rodForce));
  s.line(pin, rocker, 'rod');
  s.line(axis, pin, 'crank');
  if (m.springs) s.spring(hinge);
  s.ground(axis);
  s.ground(hinge);
  s.circle(pin, 3.5, 'joint');
  s.circle(rocker, 3.5, 'joint');
  const length = Math.hypot(rocker[0] - pin[0], rocker[1] - pin[1]) || 1,
    size = 50 * i.rodForce;
  s.arrow(rocker, (size * (rocker[0] - pin[0])) / length, (-size * (rocker[1] - pin[1])) / length, 'force');
  s.arrow(onCircle(hinge, 0.7 * wing, i.strokeAngle), 0, -55 * i.lift, 'lift');
  s.torque(axis, 16 + r * scale, i.motorTorque);
  if (names) {
    s.name('crank', [-r, 0], 'middle', 0, 34);
    s.name('coupler', [(pin[0] + rocker[0]) / 2, (pin[1] + rocker[1]) / 2], 'middle', 0, -10);
    s.name('rocker', rocker, 'start', 8, -6);
    s.name('wing', onCircle(hinge, wing, i.strokeAngle), 'end', -6, -8);
  }
  return s;
}

/** A shaft with a wing: of a direct drive the motor's own, of a tabulated stroke a crank beside it. */
function shaftAndWing(m: Mechanism, i: Instant, range: [number, number], names: boolean): Sketch {
  const direct = m.type === 'direct',
    wing = direct ? 1.6 : 1.2;
  const s = new Sketch(direct ? [0.2, 0] : [0.1, 0], Math.min((width - 60) / (direct ? 2.6 : 3), (height - 40) / 2.9));
  const hinge: Point = direct ? [-0.8, 0] : [0.1, 0],
    axis: Point = direct ? hinge : [-0.9, 0];
  for (const end of range) s.line(hinge, onCircle(hinge, wing, end), 'faint');
  if (!direct) {
    const pin = onCircle(axis, 0.35, i.crankAngle);
    s.ring(axis, 0.35, 'faint');
    s.line(axis, hinge, 'faint dashed');
    s.circle(pin, 9 + 14 * Math.abs(i.friction), 'glow', Math.abs(i.friction));
    s.line(axis, pin, 'crank');
    s.ground(axis);
    s.circle(pin, 3.5, 'joint');
  } else {
    s.circle(hinge, 24, 'motor');
    s.circle(hinge, 26, 'glow', Math.abs(i.friction));
  }
  s.line(hinge, onCircle(hinge, wing, i.strokeAngle), 'wing');
  if (m.springs) s.spring(hinge);
  s.circle(hinge, 3.5, 'joint');
  s.arrow(onCircle(hinge, 0.7 * wing, i.strokeAngle), 0, -55 * i.lift, 'lift');
  s.torque(axis, direct ? 34 : 40, i.motorTorque);
  if (names) {
    s.name(direct ? 'motor' : 'crank', axis, 'middle', 0, direct ? 56 : 76);
    s.name('wing', onCircle(hinge, wing, i.strokeAngle), 'end', -6, -10);
    if (!direct) s.name('stroke from a table', [-0.4, 0], 'middle', 0, 16);
  }
  return s;
}

/** The wing's chord as seen from its tip: it moves to the right where the stroke velocity is positive. */
function chord(i: Instant): SVGGElement {
  const group = svg('g', {class: 'section'});
  if (i.angleOfAttack === null) return group;
  const x = width - 74,
    y = height - 62,
    sense = i.strokeVelocity < 0 ? -1 : 1,
    alpha = (i.angleOfAttack * Math.PI) / 180;
  const dx = 26 * Math.cos(alpha) * sense,
    dy = 26 * Math.sin(alpha);
  group.append(
    svg('line', {class: 'wing', x1: x - dx, y1: y + dy, x2: x + dx, y2: y - dy}),
    svg('circle', {class: 'joint', cx: x + dx, cy: y - dy, r: 3}),
    svg('text', {x, y: y + 44, 'text-anchor': 'middle'}, `wing section, α ${i.angleOfAttack.toFixed(0)}°`),
  );
  return group;
}

function sketchOf(m: Mechanism, i: Instant, range: [number, number], names: boolean): Sketch {
  if (m.type === 'slider-crank') return sliderCrank(m, i, range, names);
  return m.type === 'four-bar' ? fourBar(m, i, range, names) : shaftAndWing(m, i, range, names);
}

export function drawMechanism(
  picture: SVGSVGElement,
  m: Mechanism,
  i: Instant,
  range: [number, number],
  ghost: {mechanism: Mechanism; instant: Instant} | null,
  rest: Rest | null,
) {
  picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const parts: SVGElement[] = [];
  if (ghost) {
    const {group} = sketchOf(ghost.mechanism, ghost.instant, [0, 0], false);
    group.setAttribute('class', 'ghost');
    parts.push(group);
  }
  parts.push(sketchOf(m, i, range, true).group, chord(i));
  if (rest) {
    parts.push(
      svg(
        'g',
        {class: 'rest'},
        svg('rect', {x: 8, y: 8, width: 190, height: 26, rx: 4}),
        svg('text', {x: 16, y: 25}, rest.text),
      ),
    );
  }
  picture.replaceChildren(...parts);
}

/** The peaks of a cycle by which its instants are scaled. */
export interface Peaks {
  force: number;
  lift: number;
  torque: number;
  friction: number;
}
const peak = (numbers: Float64Array | undefined) =>
  numbers && Number.isFinite(numbers[0]) ? numbers.reduce((most, x) => Math.max(most, Math.abs(x)), 0) : 0;
export const peaksOf = (c: Columns): Peaks => ({
  force: peak(c.rod_force_n),
  lift: peak(c.lift_n),
  torque: peak(c.motor_torque_nm),
  friction: peak(c.power_friction_w),
});

/** The instant of a cycle at a share of its period. */
export function instantAt(c: Columns, peaks: Peaks, share: number): Instant {
  const place = share * (c.time_s.length - 1),
    row = Math.min(c.time_s.length - 2, Math.floor(place));
  const at = (numbers: Float64Array) => numbers[row] + (place - row) * (numbers[row + 1] - numbers[row]);
  const of = (name: string, most: number) => (most > 0 ? at(c[name]) / most : 0);
  return {
    crankAngle: at(c.crank_angle_rad),
    strokeAngle: at(c.stroke_angle_rad),
    rodForce: of('rod_force_n', peaks.force),
    lift: of('lift_n', peaks.lift),
    motorTorque: of('motor_torque_nm', peaks.torque),
    friction: of('power_friction_w', peaks.friction),
    angleOfAttack: at(c.angle_of_attack_deg),
    strokeVelocity: at(c.flapping_velocity_rad_per_s),
  };
}

/** A crank at an angle at which nothing moves. */
export const atRest = (m: Mechanism, angle: number): Instant => ({
  crankAngle: angle,
  strokeAngle: m.rotates ? strokeAt(m, angle) : angle,
  rodForce: 0,
  lift: 0,
  motorTorque: 0,
  friction: 0,
  angleOfAttack: null,
  strokeVelocity: 0,
});

export const restText = (status: string, angle: number | null) =>
  angle === null ? status : `${status}, rests at ${readable(angle, 'rad')}`;

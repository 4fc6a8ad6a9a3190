// The mechanism at one instant of the cycle, to scale but for the wings' length; arrows for what acts.
import type {Columns, Mechanism} from '../core';
import {set, svg, update} from '../dom';
import {atShare} from '../measured';
import {readable} from '../quantities';

export type Point = [number, number];

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

export const width = 480,
  height = 360;

/** From metres, y upwards, to the picture, and back. */
export const placeIn = ({centre, scale}: Room, [x, y]: Point): Point => [
  width / 2 + (x - centre[0]) * scale,
  height / 2 - (y - centre[1]) * scale,
];
export const pointOf = ({centre, scale}: Room, [x, y]: Point): Point => [
  centre[0] + (x - width / 2) / scale,
  centre[1] - (y - height / 2) / scale,
];

const onCircle = (centre: Point, radius: number, angle: number): Point => [
  centre[0] + radius * Math.cos(angle),
  centre[1] + radius * Math.sin(angle),
];

/** Lines in metres, y upwards, drawn into a picture whose extent is known beforehand. */
class Sketch {
  readonly group = svg('g');
  readonly scale: number;
  constructor(private readonly room: Room) {
    this.scale = room.scale;
  }
  at(p: Point): Point {
    return placeIn(this.room, p);
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
        d: `M${a.join()}A${pixels},${pixels} 0 ${sweep > Math.PI ? 1 : 0} ${
          turn > 0 ? 1 : 0
        } ${b.join()}M${barb(0.45)}L${b.join()}L${barb(-0.45)}`,
      }),
    );
  }
  name(text: string, p: Point, anchor: 'start' | 'middle' | 'end', dx = 0, dy = 0) {
    const [x, y] = this.at(p);
    this.group.append(svg('text', {x: x + dx, y: y + dy, 'text-anchor': anchor}, text));
  }
}

/** What the numbers of a whole turn are at an angle. */
const atAngle = (numbers: Float64Array, angle: number) => atShare(numbers, angle / (2 * Math.PI));

/** The stroke angle that the transmission gives at a crank angle. */
export const strokeAt = (m: Mechanism, angle: number) => atAngle(m.columns.stroke_angle_rad!, angle);

const jointAt = (m: Mechanism, name: string, angle: number): Point => [
  atAngle(m.columns[`${name}_x`]!, angle),
  atAngle(m.columns[`${name}_y`]!, angle),
];
const between = (a: Point, b: Point, share: number): Point => [
  a[0] + share * (b[0] - a[0]),
  a[1] + share * (b[1] - a[1]),
];

/** Angles, of the crank or of a direct drive's stroke, at which the stroke ends. */
function strokeEnds(m: Mechanism, range: [number, number]): number[] {
  if (!m.rotates) return range;
  const stroke = m.columns.stroke_angle_rad!;
  return [Math.min(...stroke), Math.max(...stroke)].map(
    (end) => (2 * Math.PI * stroke.indexOf(end)) / (stroke.length - 1),
  );
}

/** Where joints are; the wings are drawn `wing` times as long as the library places their tips. */
function jointsAt(m: Mechanism, angle: number, wing: number): (name: string) => Point {
  return (name) => {
    const p = jointAt(m, name, angle);
    const root = m.links.find((l) => l.role === 'wing' && l.to === name)?.from;
    return root === undefined ? p : between(jointAt(m, root, angle), p, wing);
  };
}

const crankOf = (m: Mechanism, angle: number) => {
  if (!m.joints.some((j) => j.name === 'pin')) return 0;
  const [axis, pin] = [jointAt(m, 'axis', angle), jointAt(m, 'pin', angle)];
  return Math.hypot(pin[0] - axis[0], pin[1] - axis[1]);
};

/** The part of the plane that a picture shows. */
export interface Room {
  readonly centre: Point;
  readonly scale: number; // [pixels/m]
}

/** Room for all that moves. */
export function roomFor(m: Mechanism, range: [number, number], wing: number): Room {
  const ends = strokeEnds(m, range),
    crank = crankOf(m, 0);
  const turn = Array.from({length: 45}, (_, n) =>
    m.rotates ? (2 * Math.PI * n) / 45 : between([ends[0]!, 0], [ends[1]!, 0], n / 44)[0],
  );
  const points = turn.flatMap((angle) => m.joints.map((j) => jointsAt(m, angle, wing)(j.name)));
  const x = points.map((p) => p[0]),
    y = points.map((p) => p[1]);
  const high = Math.max(...y, 1.2 * crank),
    low = Math.min(...y, -1.2 * crank),
    left = Math.min(...x, -1.2 * crank),
    right = Math.max(...x);
  // A single wing has its motor or its table's crank beside it.
  const size = hasRod(m) ? 0 : 2.4;
  const scale = Math.min((width - 110) / Math.max(right - left, size), (height - 80) / Math.max(high - low, size));
  return {centre: [(left + right) / 2, (low + high) / 2], scale};
}

export const hasRod = (m: Mechanism) => m.links.some((l) => l.role === 'rod');

function sketchOf({mechanism: m, wing, room}: Drawn, i: Instant, range: [number, number], names: boolean): Sketch {
  const angle = m.rotates ? i.crankAngle : i.strokeAngle,
    ends = strokeEnds(m, range);
  const at = jointsAt(m, angle, wing);
  const turns = m.joints.some((j) => j.name === 'pin'),
    axis: Point = turns ? at('axis') : at('hinge'),
    pin = turns ? at('pin') : null,
    crank = crankOf(m, angle);
  const s = new Sketch(room);
  const labels: (() => void)[] = [];
  const label = (...text: Parameters<Sketch['name']>) => labels.push(() => s.name(...text));
  if (pin) {
    s.ring(axis, crank, 'faint');
    s.circle(pin, 9 + 14 * Math.abs(i.friction), 'glow', Math.abs(i.friction));
    label('crank', [axis[0] - crank, axis[1]], 'end', -10, 4);
  } else {
    s.circle(axis, 24, 'motor');
    s.circle(axis, 26, 'glow', Math.abs(i.friction));
    label('motor', axis, 'middle', 0, 56);
  }
  if (m.type === 'tabulated') label('stroke from a table', between(axis, at('hinge'), 0.5), 'middle', 0, 16);
  for (const {role, from, to} of m.links) {
    const a = at(from),
      b = at(to);
    if (role === 'wing') {
      for (const end of ends) s.line(a, jointsAt(m, end, wing)(to), 'faint');
      if (m.springs) s.spring(a);
      s.arrow(between(a, b, 0.7), 0, -55 * i.lift, 'lift');
      if (to === 'tip') label('wing', b, 'end', -6, -10);
      if (m.springs && to === 'tip') label('spring', a, 'start', 20, 26);
    }
    if (role === 'rod') {
      s.line(a, b, 'rod glow-rod', Math.abs(i.rodForce));
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1,
        size = (50 * i.rodForce) / length;
      s.arrow(b, size * (b[0] - a[0]), -size * (b[1] - a[1]), 'force');
      label(m.type === 'four-bar' ? 'coupler' : 'rod', between(a, b, 0.5), 'start', 10, -6);
      label(to, b, 'start', 12, -8);
    }
    s.line(a, b, role === 'ground' ? 'faint dashed' : role);
  }
  for (const {name, fixed} of m.joints) {
    if (name === 'slider') s.square(at(name), 7);
    else if (fixed && pin) s.ground(at(name));
    else if (fixed || name === 'pin' || name === 'rocker') s.circle(at(name), 3.5, 'joint');
  }
  s.torque(axis, pin ? Math.max(16, 0.55 * crank * s.scale) : 34, i.motorTorque);
  if (names) for (const write of labels) write();
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

/** A mechanism and how it is drawn. */
export interface Drawn {
  mechanism: Mechanism;
  wing: number;
  room: Room;
}

/** Where the joints are in the plane at an instant. */
export const jointsOf = ({mechanism, wing}: Drawn, i: Instant) =>
  jointsAt(mechanism, mechanism.rotates ? i.crankAngle : i.strokeAngle, wing);

export function drawMechanism(
  picture: SVGSVGElement,
  shown: Drawn,
  i: Instant,
  range: [number, number],
  ghost: (Drawn & {instant: Instant}) | null,
  rest: Rest | null,
) {
  set(picture, {viewBox: `0 0 ${width} ${height}`});
  const parts: SVGElement[] = [];
  if (ghost) {
    const {group} = sketchOf(ghost, ghost.instant, [0, 0], false);
    group.setAttribute('class', 'ghost');
    parts.push(group);
  }
  parts.push(sketchOf(shown, i, range, true).group, chord(i));
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
  update(picture, parts);
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
  const place = share * (c.time_s!.length - 1),
    row = Math.min(c.time_s!.length - 2, Math.floor(place));
  const at = (name: string) => {
    const numbers = c[name]!;
    return numbers[row]! + (place - row) * (numbers[row + 1]! - numbers[row]!);
  };
  const of = (name: string, most: number) => (most > 0 ? at(name) / most : 0);
  return {
    crankAngle: at('crank_angle_rad'),
    strokeAngle: at('stroke_angle_rad'),
    rodForce: of('rod_force_n', peaks.force),
    lift: of('lift_n', peaks.lift),
    motorTorque: of('motor_torque_nm', peaks.torque),
    friction: of('power_friction_w', peaks.friction),
    angleOfAttack: at('angle_of_attack_deg'),
    strokeVelocity: at('flapping_velocity_rad_per_s'),
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

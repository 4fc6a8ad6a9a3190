// The 3D picture of a vehicle in free flight: body with attitude, wings with their own strokes, ground, path and aim.
// Lengths are those of wings; x is east, y up, z south.
import {
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  ConeGeometry,
  DoubleSide,
  GridHelper,
  Group,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Shape,
  ShapeGeometry,
  SphereGeometry,
  Vector3,
  type WebGLRenderer,
} from 'three';
import {Stage} from './stage';
import type {FlightBegun} from './answers';

export interface FreeColours {
  paper: string;
  wing: string;
  body: string;
  nose: string;
  path: string;
  aim: string;
  rule: string;
}
/** What is shown: columns of the flight at an instant [SI], and from where. */
export interface FreeLook {
  now: Record<string, number>;
  azimuth: number; // [rad]
  distance: number; // of the eye [wing lengths]
}

const pathLength = 4000;

/** Of a vector in body or earth axes: forward or north, right or east, down. */
const turned = (v: readonly number[]) => new Vector3(v[1], -v[2]!, -v[0]!);

/** Axes of a wing's span, chord (to the trailing edge) and normal in body axes; as wing_axes of the library. */
export function wingAxes(side: number, stroke: number, plane: number, chord: number): number[][] {
  const s = Math.sin(stroke),
    c = Math.cos(stroke),
    ct = Math.cos(plane),
    st = Math.sin(plane);
  const span = [s * ct, side * c, -s * st],
    ahead = [c * ct, -side * s, -c * st],
    down = [st, 0, ct];
  const mix = (a: number, b: number) => ahead.map((x, k) => a * x + b * down[k]!);
  return [span, mix(Math.sin(chord), Math.cos(chord)), mix(Math.cos(chord), -Math.sin(chord))];
}

/** Forward, right and down of a body in earth axes. */
export function bodyAxes(roll: number, pitch: number, yaw: number): number[][] {
  const [sr, cr, sp, cp, sy, cy] = [roll, pitch, yaw].flatMap((a) => [Math.sin(a), Math.cos(a)]) as [
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  return [
    [cp * cy, cp * sy, -sp],
    [sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp],
    [cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp],
  ];
}

export class FreeScene extends Stage {
  private readonly vehicle = new Group();
  private readonly wings: {group: Group; side: number; shoulder: Vector3}[] = [];
  private readonly grid: GridHelper;
  private readonly shadow: Mesh;
  private readonly plumb: Line;
  private readonly aim: Group;
  private readonly path: Line;
  private readonly unit: number; // [m]
  private points = 0;

  constructor(renderer: WebGLRenderer, begun: FlightBegun, colours: FreeColours) {
    super(renderer, colours.paper, 400);
    this.unit = begun.outline.at(-1)?.[0] ?? 0.05;
    this.grid = new GridHelper(60, 60, colours.rule, colours.rule);
    this.scene.add(this.grid);
    this.vehicle.matrixAutoUpdate = false;
    this.addBody(begun, colours);
    for (const wing of begun.wings) this.addWing(wing, begun, colours);
    this.shadow = new Mesh(
      new CircleGeometry(0.5, 32).rotateX(-Math.PI / 2),
      new MeshBasicMaterial({color: colours.body, transparent: true, opacity: 0.25}),
    );
    this.shadow.position.y = 0.005;
    this.plumb = new Line(
      new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3)),
      new LineDashedMaterial({color: colours.rule, dashSize: 0.12, gapSize: 0.12}),
    );
    this.plumb.frustumCulled = false;
    this.aim = new Group();
    const ring = new Mesh(
      new SphereGeometry(0.11, 8, 6),
      new MeshBasicMaterial({color: colours.aim, wireframe: true, transparent: true, opacity: 0.7}),
    );
    const heading = new Mesh(
      new ConeGeometry(0.06, 0.22, 12).rotateX(-Math.PI / 2).translate(0, 0, -0.26),
      new MeshBasicMaterial({color: colours.aim, transparent: true, opacity: 0.7}),
    );
    this.aim.add(ring, heading);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * pathLength), 3));
    this.path = new Line(geometry, new LineBasicMaterial({color: colours.path}));
    this.path.frustumCulled = false;
    geometry.setDrawRange(0, 0);
    this.scene.add(this.vehicle, this.shadow, this.plumb, this.aim, this.path);
  }

  /** An upright body from below the centre of mass to the shoulders, with a nose and a keel. */
  private addBody({wings}: FlightBegun, colours: FreeColours) {
    const above = Math.max(0.1, ...wings.map((w) => -w.shoulder[2]! / this.unit)),
      half = Math.max(0.25, above + 0.08);
    const material = new MeshStandardMaterial({color: colours.body, roughness: 0.7});
    const trunk = new Mesh(new SphereGeometry(1, 24, 16).scale(0.11, half, 0.13), material);
    const nose = new Mesh(
      new ConeGeometry(0.07, 0.26, 16).rotateX(-Math.PI / 2).translate(0, 0.55 * half, -0.2),
      new MeshStandardMaterial({color: colours.nose, roughness: 0.6}),
    );
    const keel = new Mesh(
      new ConeGeometry(0.05, 0.34, 4)
        .scale(0.25, 1, 1)
        .rotateX(Math.PI / 2)
        .translate(0, -0.5 * half, 0.24),
      material,
    );
    this.vehicle.add(trunk, nose, keel);
  }

  private addWing({side, shoulder}: FlightBegun['wings'][number], {outline}: FlightBegun, colours: FreeColours) {
    const shape = new Shape(),
      length = (x: number) => x / this.unit;
    shape.moveTo(length(outline[0]![0]), 0);
    shape.lineTo(length(outline.at(-1)![0]), 0);
    for (const [r, chord] of outline.toReversed()) shape.lineTo(length(r), -length(chord));
    const film = new Mesh(
      new ShapeGeometry(shape),
      new MeshStandardMaterial({color: colours.wing, side: DoubleSide, transparent: true, opacity: 0.72}),
    );
    const spar = new Line(
      new BufferGeometry().setFromPoints([new Vector3(), new Vector3(1, 0, 0)]),
      new LineBasicMaterial({color: colours.body}),
    );
    const group = new Group();
    group.matrixAutoUpdate = false;
    group.add(film, spar);
    this.vehicle.add(group);
    this.wings.push({group, side, shoulder: turned(shoulder).divideScalar(this.unit)});
  }

  /** One more point of the path [m]: north, east, height. */
  extend(places: readonly number[][]) {
    const position = this.path.geometry.getAttribute('position') as BufferAttribute;
    if (this.points + places.length > pathLength) {
      // Half of the points, every other one.
      this.points = Math.floor(this.points / 2);
      for (let n = 0; n < this.points; ++n)
        position.setXYZ(n, position.getX(2 * n), position.getY(2 * n), position.getZ(2 * n));
    }
    for (const [north, east, height] of places)
      position.setXYZ(this.points++, east! / this.unit, height! / this.unit, -north! / this.unit);
    position.needsUpdate = true;
    this.path.geometry.setDrawRange(0, this.points);
  }

  show({now, azimuth, distance}: FreeLook) {
    const at = (name: string) => now[name] ?? 0;
    const [forward, right, down] = bodyAxes(at('roll_rad'), at('pitch_rad'), at('yaw_rad')).map(turned);
    const place = turned([at('north_m'), at('east_m'), -at('height_m')]).divideScalar(this.unit);
    this.vehicle.matrix.makeBasis(right!, down!.negate(), forward!.negate()).setPosition(place);
    for (const [n, {group, side, shoulder}] of this.wings.entries()) {
      const [span, chord, normal] = wingAxes(side, at(`stroke_${n}_rad`), at(`plane_${n}_rad`), at(`chord_${n}_rad`));
      group.matrix = new Matrix4()
        .makeBasis(turned(span!), turned(chord!).negate(), turned(normal!))
        .setPosition(shoulder);
    }
    this.grid.position.set(Math.round(place.x), 0, Math.round(place.z));
    this.shadow.position.setX(place.x).setZ(place.z);
    const line = this.plumb.geometry.getAttribute('position') as BufferAttribute;
    line.setXYZ(0, place.x, place.y, place.z).setXYZ(1, place.x, 0, place.z);
    line.needsUpdate = true;
    this.plumb.computeLineDistances();
    this.aim.position.copy(turned([at('aim_north_m'), at('aim_east_m'), -at('aim_height_m')]).divideScalar(this.unit));
    this.aim.rotation.y = -at('aim_yaw_rad');
    this.camera.position
      .set(distance * Math.sin(azimuth), 0.28 * distance, distance * Math.cos(azimuth))
      .add(place)
      .setY(Math.max(0.15, place.y + 0.28 * distance));
    this.camera.lookAt(place);
    this.render();
  }
}

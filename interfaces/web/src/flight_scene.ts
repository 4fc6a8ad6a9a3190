// The 3D picture of a flying vehicle, by three.js.
import {
  ArrowHelper,
  BufferGeometry,
  CapsuleGeometry,
  DoubleSide,
  Float32BufferAttribute,
  GridHelper,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  Shape,
  ShapeGeometry,
  Vector3,
  type WebGLRenderer,
} from 'three';
import {Stage} from './stage';

/** Lengths in wing lengths. */
export interface Look {
  pairs: number; // of wings, one above the other
  sides: 1 | 2;
  chord: number; // at the root
  rounded: boolean; // the outline
  colours: {paper: string; wing: string; body: string; lift: string; weight: string; rule: string};
}
export interface Pose {
  stroke: number; // [rad]
  chordAngle: number; // [rad]
  height: number; // [wing lengths] above the ground
  lift: number; // over weight
  azimuth: number; // of the eye [rad]
}

interface Wing {
  sweep: Group;
  pitch: Group;
  side: number;
  sense: number;
}

export class FlightScene extends Stage {
  private readonly vehicle = new Group();
  private readonly wings: Wing[] = [];
  private readonly lift: ArrowHelper;
  private readonly weight: ArrowHelper;

  constructor(renderer: WebGLRenderer, look: Look) {
    super(renderer, look.colours.paper, 200);
    const {colours, chord} = look;
    this.scene.add(new GridHelper(24, 24, colours.rule, colours.rule), ruler(colours.rule));
    const body = new Mesh(
      new CapsuleGeometry(0.11, 0.5, 6, 16),
      new MeshStandardMaterial({color: colours.body, roughness: 0.7}),
    );
    body.position.y = -0.16;
    this.vehicle.add(body);
    for (let pair = 0; pair < look.pairs; ++pair) {
      for (const side of look.sides === 2 ? [1, -1] : [1]) this.wings.push(this.wing(look, pair, side, chord));
    }
    const arrow = (direction: number, colour: string) =>
      new ArrowHelper(new Vector3(0, direction, 0), new Vector3(0, 0, 0.02), 1, colour, 0.14, 0.09);
    this.lift = arrow(1, colours.lift);
    this.weight = arrow(-1, colours.weight);
    this.lift.position.y = 0.2;
    this.weight.position.y = -0.52;
    this.vehicle.add(this.lift, this.weight);
    this.scene.add(this.vehicle);
  }

  /** A wing along x whose leading edge is the axis about which it pitches; it sweeps about the vertical. */
  private wing({rounded, colours}: Look, pair: number, side: number, chord: number): Wing {
    const points = Array.from({length: 25}, (_, n) => n / 24);
    const outline = new Shape();
    outline.moveTo(0, 0);
    outline.lineTo(1, 0);
    for (const r of points.toReversed()) outline.lineTo(r, -chord * (rounded ? Math.sqrt(1 - r * r) : 1));
    const film = new Mesh(
      new ShapeGeometry(outline),
      new MeshStandardMaterial({color: colours.wing, side: DoubleSide, transparent: true, opacity: 0.72}),
    );
    const spar = new Line(
      new BufferGeometry().setFromPoints([new Vector3(0, 0, 0), new Vector3(1, 0, 0)]),
      new LineBasicMaterial({color: colours.body}),
    );
    const pitch = new Group(),
      sweep = new Group();
    pitch.add(film, spar);
    pitch.position.x = 0.08;
    sweep.add(pitch);
    sweep.position.y = 0.14 + 0.06 * pair;
    this.vehicle.add(sweep);
    return {sweep, pitch, side, sense: pair % 2 ? -1 : 1};
  }

  show({stroke, chordAngle, height, lift, azimuth}: Pose) {
    for (const {sweep, pitch, side, sense} of this.wings) {
      // At stroke angle 0 the wings point sideways; positive ones sweep both forward, of two pairs to opposite sides.
      const forward = sense * stroke;
      sweep.rotation.y = side > 0 ? -forward : Math.PI + forward;
      pitch.rotation.x = -side * sense * chordAngle;
    }
    this.vehicle.position.y = height;
    this.lift.setDirection(new Vector3(0, lift < 0 ? -1 : 1, 0));
    setArrow(this.lift, lift);
    setArrow(this.weight, 1);
    const eye = 5.2;
    this.camera.position.set(eye * Math.sin(azimuth), height + 1.3, eye * Math.cos(azimuth));
    this.camera.lookAt(0, height - 0.1, 0);
    this.render();
  }
}

function setArrow(arrow: ArrowHelper, size: number) {
  arrow.visible = Math.abs(size) > 0.05;
  const length = 0.55 * Math.min(4, Math.abs(size));
  arrow.setLength(Math.max(0.05, length), Math.min(0.14, 0.6 * length), 0.09);
}

/** A pole behind the vehicle with a mark at each wing length, by which motion is seen. */
function ruler(colour: string): LineSegments {
  const points = [0, 0, -2, 0, 60, -2];
  for (let mark = 0; mark <= 60; ++mark) {
    const half = mark % 5 ? 0.25 : 0.6;
    points.push(-half, mark, -2, half, mark, -2);
  }
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, new LineBasicMaterial({color: colour}));
}

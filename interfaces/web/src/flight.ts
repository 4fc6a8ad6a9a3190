// "In flight": the vehicle in three dimensions. One with a body flies freely (free_flight.ts); of others the wings
// sweep and pitch as in the cycle, and it falls, hovers or climbs as its lift over its weight has it.
import type {Columns, Values} from './core';
import {byId} from './dom';
import {unpackedText} from './embedded';
import type {Explorer, Shown} from './explorer';
import {chordAngles, fate, Flight} from './flight_motion';
import type {Look} from './flight_scene';
import type * as scenesModule from './scenes';
import type {FlightPicture, Scenes} from './scenes';
import {FreeFlight, hasBody} from './free_flight';
import {atShare} from './measured';
import {digits, readable} from './quantities';
import {numberOf} from './results';

type ScenesModule = typeof scenesModule;

/** From the page itself where it stands in it, else from beside it. */
async function loadScenes(): Promise<ScenesModule> {
  const text = await unpackedText('wingbeat-flight');
  if (text === null) return import('./scenes');
  const url = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
  try {
    return (await import(/* @vite-ignore */ url)) as ScenesModule;
  } finally {
    URL.revokeObjectURL(url);
  }
}

const let_go = 6, // wing lengths above the ground
  rest = 900; // [ms] at the ground, or out of sight

export class FlightView {
  /** Of a vehicle with a body, once it has been asked for. */
  free: FreeFlight | null = null;
  private module: ScenesModule | null = null;
  private scenes: Scenes | null = null;
  private scene: FlightPicture | null = null;
  private flight: Flight | null = null;
  private columns: Columns | null = null;
  private angles: Float64Array | null = null;
  private shown: Shown | null = null;
  private wing = 0.05; // [m]
  private weight = 0;
  private share = 0;
  private lookOf = '';
  private landed = 0;
  private readonly canvas = byId<HTMLCanvasElement>('flight');

  constructor(private readonly explorer: Explorer) {
    byId('fly').addEventListener('click', () => void this.toggle());
    byId('let-go').addEventListener('click', () => this.letGo());
    byId('azimuth').addEventListener('input', () => this.draw());
    byId('theme').addEventListener('click', () => {
      if (!this.open || !this.shown) return;
      if (this.scene) this.build(this.shown);
      else this.free?.rebuild();
    });
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    explorer.watch(() => this.update());
  }

  private async toggle() {
    const button = byId('fly');
    if (!byId('flight-view').hidden) {
      byId('flight-view').hidden = true;
      button.textContent = 'show in 3D';
      button.setAttribute('aria-expanded', 'false');
      this.leave();
      return;
    }
    byId('flight-note').textContent = 'Loading.';
    try {
      this.module ??= await loadScenes();
      this.scenes ??= new this.module.Scenes(this.canvas);
      await this.scenes.ready;
      byId('flight-view').hidden = false;
      this.lookOf = '';
      this.shown = null;
      this.update();
      button.textContent = 'leave 3D';
      button.setAttribute('aria-expanded', 'true');
    } catch (error) {
      byId('flight-view').hidden = true;
      byId('flight-note').textContent = `No picture in 3D in this browser: ${(error as Error).message}`;
    }
  }

  private leave() {
    this.scene?.dispose();
    this.scene = null;
    this.free?.dispose();
  }

  private get open() {
    return this.module !== null && !byId('flight-view').hidden;
  }

  private update() {
    const {shown} = this.explorer;
    if (!this.open || !shown || shown === this.shown) return;
    const free = hasBody(this.explorer),
      other = free !== !byId('pilot').hidden || !this.shown;
    this.shown = shown;
    if (other) {
      this.leave();
      byId('pilot').hidden = !free;
      byId('cycle-flight').hidden = free;
      byId('flight-note').textContent = byId('pilot-note').textContent = '';
    }
    if (free) return this.fly(other);
    const {report, columns} = shown.solved;
    this.columns = columns.time_s ? columns : null;
    this.angles = this.columns ? chordAngles(this.columns) : null;
    this.wing = wingLength(shown.values);
    // Of a vehicle with two motors the share that one of them lifts.
    const lift = numberOf(report, 'lift_mean_n'),
      ratio = numberOf(report, 'lift_to_weight');
    this.weight = ratio && lift ? lift / ratio : 0;
    const before = this.flight;
    this.flight = this.columns && this.weight > 0 ? new Flight(this.columns, this.weight) : null;
    // A design that changes in the air continues from where it is.
    if (before && this.flight) [this.flight.height, this.flight.speed] = [before.height, before.speed];
    this.build(shown);
    this.draw();
  }

  private fly(other: boolean) {
    const colours = () => {
      const {paper, wing, body, lift, weight, rule} = lookOf(this.shown!).colours;
      return {paper, wing, body, nose: weight, path: wing, aim: lift, rule};
    };
    this.free ??= new FreeFlight(
      this.explorer,
      this.module!.FlightWorker,
      this.scenes!,
      this.canvas,
      colours,
      () => wingLength(this.shown!.values),
      (text) => {
        byId('pilot-note').textContent = text;
      },
    );
    if (other) void this.free.start();
    else this.free.follow();
  }

  private build(shown: Shown) {
    const look = lookOf(shown);
    const of = JSON.stringify(look);
    if (of === this.lookOf && this.scene) return;
    this.lookOf = of;
    this.scene?.dispose();
    this.scene = this.scenes!.flight(look);
    this.resize();
  }

  private resize() {
    const {clientWidth, clientHeight} = this.canvas;
    if (!this.scene) return this.free?.resize();
    if (!clientWidth) return;
    this.scene.resize(clientWidth, clientHeight);
    this.draw();
  }

  private letGo() {
    this.flight?.rest();
    this.landed = 0;
    this.draw();
  }

  /** The instant of the cycle that the page shows; `playing` moves the vehicle on. */
  show(share: number, playing: boolean) {
    const before = this.share;
    this.share = share;
    if (!this.open || !this.scene || this.canvas.getBoundingClientRect().width === 0) return;
    const {flight} = this;
    if (flight && playing) {
      if (this.landed) {
        if (performance.now() - this.landed > rest) this.letGo();
      } else {
        flight.advance(before, share);
        const height = let_go + flight.height / this.wing;
        if (height < 0.5 || height > 55) this.landed = performance.now();
      }
    }
    this.draw();
  }

  private draw() {
    if (!this.open || !this.scene) return;
    const {columns, angles, share, flight} = this;
    const at = (name: string) => (columns?.[name] ? atShare(columns[name], Math.min(share, 0.999999)) : 0);
    const height = Math.max(0.5, let_go + (flight?.height ?? 0) / this.wing);
    const lift = columns && this.weight > 0 ? this.liftAt(share) / this.weight : 0;
    this.scene.show({
      stroke: at('stroke_angle_rad'),
      chordAngle: angles ? atShare(angles, Math.min(share, 0.999999)) : 0,
      height,
      lift,
      azimuth: (Number(byId<HTMLInputElement>('azimuth').value) * Math.PI) / 180,
    });
    byId('flight-note').textContent = this.sentence();
  }

  private liftAt(share: number) {
    const {solved} = this.shown!;
    return atShare(solved.columns.lift_n!, Math.min(share, 0.999999));
  }

  private sentence(): string {
    const {flight, columns, shown} = this;
    if (!columns) return 'There is no steady cycle: the wings rest.';
    if (!flight) return 'The weight is not known: state vehicle.mass, and the vehicle falls, hovers or climbs.';
    const ratio = numberOf(shown!.solved.report, 'lift_to_weight') ?? 0;
    const moves = `${readable(Math.abs(flight.height), 'm', 2)} ${flight.height < 0 ? 'below' : 'above'} the start`;
    return (
      `It ${fate(ratio)}: lift is ${digits(ratio, 3)} times the weight. ${moves}, ` +
      `${readable(Math.abs(flight.speed), 'm/s', 2)} ${flight.speed < 0 ? 'down' : 'up'}.`
    );
  }
}

/** From the hinge to the tip [m]; 5 cm for wings of which only moments are known. */
function wingLength(values: Values): number {
  const number = (key: string, otherwise: number) =>
    typeof values[key] === 'number' ? Number(values[key]) : otherwise;
  return number('wing.planform.length', 0.05) * number('wing.planform.scale', 1);
}

function lookOf({values, mechanism}: Shown): Look {
  const root = document.body,
    colour = (name: string) => getComputedStyle(root).getPropertyValue(name);
  const probe = (name: string) => {
    const swatch = document.createElement('i');
    swatch.style.color = `var(${name})`;
    root.append(swatch);
    const found = getComputedStyle(swatch).color;
    swatch.remove();
    return found || colour(name);
  };
  const length = values['wing.planform.length'],
    root_chord = values['wing.planform.root_chord'],
    ratio = values['wing.planform.chord_ratio'];
  const chord =
    typeof ratio === 'number'
      ? ratio
      : typeof length === 'number' && typeof root_chord === 'number'
        ? root_chord / length
        : 0.4;
  const motors = typeof values['vehicle.motors'] === 'number' ? values['vehicle.motors'] : 1;
  const wings = mechanism.wing_count * motors;
  return {
    pairs: Math.max(1, Math.floor(wings / 2)),
    sides: wings > 1 ? 2 : 1,
    chord: Math.min(1.5, chord),
    rounded: values['wing.planform.shape'] !== 'rectangle',
    colours: {
      paper: probe('--paper'),
      wing: probe('--accent'),
      body: probe('--wing'),
      lift: probe('--lift'),
      weight: probe('--torque'),
      rule: probe('--rule'),
    },
  };
}

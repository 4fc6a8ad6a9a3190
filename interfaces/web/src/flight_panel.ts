// The controls of free flight and its numbers: set-points of the controller, wind, pushes, slow motion.
import type {FlightBegun} from './answers';
import {byId, html} from './dom';
import type {Aim, Push, Triple} from './flight_core';
import {FlightTrace} from './flight_trace';
import type {FlightTrack} from './flight_track';
import {readable, withMinus} from './quantities';

interface Events {
  start(): void;
  stop(): void;
  aim(aim: Aim): void;
  wind(wind: Triple): void;
  push(push: Push): void;
  look(): void;
}

const controllers: [FlightBegun['controller'], string][] = [
  ['lqr', 'linear-quadratic (LQR)'],
  ['pid', 'cascade (PID)'],
  ['none', 'none: controls of hover'],
];
const rates = [1 / 100, 1 / 50, 1 / 20, 1 / 10, 1 / 5, 1 / 2, 1];
const [speed, spin] = [0.5, 5]; // of a push [m/s], [rad/s]
const pushes: [string, Push][] = [
  [`right, ${speed} m/s`, {v: speed}],
  [`forward, ${speed} m/s`, {u: speed}],
  [`down, ${speed} m/s`, {w: speed}],
  [`roll, ${spin} rad/s`, {p: spin}],
  [`pitch, ${spin} rad/s`, {q: spin}],
  [`yaw, ${spin} rad/s`, {r: spin}],
];
/** Without a sign where nothing is left of the number. */
const fixed = (x: number, digits: number) => withMinus(x.toFixed(digits).replace(/^-(0(?:\.0*)?)$/, '$1'));

const degrees = 180 / Math.PI,
  strongest = 1; // wind [m/s]

/** A slider with its name, unit and value in words. */
class Slider {
  readonly input = html('input', {type: 'range'});
  readonly element: HTMLElement;
  private readonly shown = html('output');
  private digits = 2;

  constructor(
    id: string,
    name: string,
    of: string,
    private readonly unit: string,
    changed: () => void,
  ) {
    this.input.id = id;
    this.shown.htmlFor = id;
    this.input.setAttribute('aria-label', `${name}, ${of}`);
    this.element = html('div', {class: 'flight-slider'}, html('label', {for: id}, name), this.input, this.shown);
    this.input.addEventListener('input', () => {
      this.write();
      changed();
    });
  }
  get value() {
    return Number(this.input.value);
  }
  set(value: number) {
    this.input.value = String(value);
    this.write();
  }
  range(low: number, high: number, step: number) {
    Object.assign(this.input, {min: String(low), max: String(high), step: String(step)});
    this.digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    this.write();
  }
  private write() {
    const text = `${fixed(this.value, this.digits)}${this.unit === '°' ? '' : ' '}${this.unit}`;
    this.shown.textContent = text;
    this.input.setAttribute('aria-valuetext', text);
  }
}

export class FlightPanel {
  playing: boolean;
  charge: number | null = null;
  private begun: FlightBegun | null = null;
  private pacing = Infinity;
  private readonly trace = new FlightTrace();
  private readonly sliders: Record<'north' | 'east' | 'height' | 'yaw' | 'windNorth' | 'windEast' | 'windUp', Slider>;
  private readonly numbers = new Map<string, HTMLElement>();
  private readonly list = html('dl', {class: 'flight-numbers', 'aria-label': 'numbers of the flight'});
  private readonly select: Record<'controller' | 'rate' | 'push', HTMLSelectElement>;
  private readonly button: Record<'play' | 'start' | 'stop' | 'push', HTMLButtonElement>;
  private readonly zoom = html('input', {type: 'range', id: 'flight-zoom', min: '0', max: '100', value: '28'});
  private readonly aims: HTMLFieldSetElement;

  constructor(events: Events) {
    this.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    const aimed = () => events.aim(this.aim),
      blown = () => events.wind(this.wind);
    const slider = (id: string, name: string, of: string, unit: string, changed: () => void) =>
      new Slider(`flight-${id}`, name, of, unit, changed);
    this.sliders = {
      north: slider('north', 'north (x)', 'set-point', 'm', aimed),
      east: slider('east', 'east (y)', 'set-point', 'm', aimed),
      height: slider('height', 'height', 'set-point', 'm', aimed),
      yaw: slider('yaw', 'heading', 'set-point', '°', aimed),
      windNorth: slider('wind-north', 'to north', 'wind', 'm/s', blown),
      windEast: slider('wind-east', 'to east', 'wind', 'm/s', blown),
      windUp: slider('wind-up', 'upwards', 'wind', 'm/s', blown),
    };
    const {north, east, height, yaw, windNorth, windEast, windUp} = this.sliders;
    for (const wind of [windNorth, windEast, windUp]) {
      wind.range(-strongest, strongest, 0.05);
      wind.set(0);
    }
    yaw.range(-180, 180, 5);
    const choice = <V>(id: string, options: [V, string][], chosen: number) => {
      const list = html('select', {id: `flight-${id}`});
      options.forEach(([, text], n) => list.append(html('option', {value: String(n), selected: n === chosen}, text)));
      return list;
    };
    this.select = {
      controller: choice('controller', controllers, 0),
      rate: choice(
        'rate',
        rates.map((r): [number, string] => [r, r === 1 ? 'real time' : `1 / ${1 / r}`]),
        2,
      ),
      push: choice(
        'push-kind',
        pushes.map(([text, push]): [Push, string] => [push, text]),
        0,
      ),
    };
    const button = (id: string, text: string, clicked: () => void) =>
      html('button', {type: 'button', id: `flight-${id}`, click: clicked}, text);
    this.button = {
      play: button('play', 'pause', () => this.play(!this.playing)),
      start: button('start', 'start at hover', () => events.start()),
      stop: button('stop', 'stop', () => events.stop()),
      push: button('push', 'push', () => events.push(pushes[Number(this.select.push.value)]![1])),
    };
    this.select.controller.addEventListener('change', () => events.start());
    this.zoom.addEventListener('input', () => events.look());
    const row = (...parts: HTMLElement[]) => html('div', {class: 'playback'}, ...parts);
    const label = (text: string, {id}: HTMLElement) => html('label', {for: id}, text),
      labelled = (text: string, control: HTMLElement) =>
        html('span', {class: 'flight-choice'}, label(text, control), control);
    this.aims = html(
      'fieldset',
      {},
      html('legend', {}, 'set-points of the controller'),
      ...[north, east, height, yaw].map((s) => s.element),
    );
    byId('pilot').replaceChildren(
      row(
        this.button.start,
        this.button.play,
        this.button.stop,
        labelled('controller', this.select.controller),
        labelled('slow motion', this.select.rate),
        labelled('distance', this.zoom),
      ),
      html(
        'div',
        {class: 'flight-fields'},
        this.aims,
        html(
          'fieldset',
          {},
          html('legend', {}, 'wind'),
          ...[windNorth, windEast, windUp].map((s) => s.element),
          html('div', {class: 'flight-slider'}, label('push', this.select.push), this.select.push, this.button.push),
        ),
      ),
      this.list,
      this.trace.element,
      html(
        'p',
        {class: 'legend arrows'},
        html('b', {class: 'torque'}, 'nose'),
        ' ',
        html('b', {class: 'lift'}, 'set-point and its heading'),
        '. Squares of the ground are a wing length wide. It flies in air, from hover at the voltage that this takes; ' +
          'north is ahead at the start. A push adds to the motion of the body, in its own axes.',
      ),
    );
    this.play(this.playing);
    this.ended();
  }

  get aim(): Aim {
    const {north, east, height, yaw} = this.sliders;
    return {north: north.value, east: east.value, height: height.value, yaw: yaw.value / degrees};
  }
  get wind(): Triple {
    const {windNorth, windEast, windUp} = this.sliders;
    return {north: windNorth.value, east: windEast.value, up: windUp.value};
  }
  get controller() {
    return controllers[Number(this.select.controller.value)]![0];
  }
  /** Seconds of flight in a second. */
  get rate() {
    return rates[Number(this.select.rate.value)]!;
  }
  /** Of the eye [wing lengths]. */
  get distance() {
    return 2.5 * 10 ** (Number(this.zoom.value) / 80);
  }

  play(playing: boolean) {
    this.playing = playing;
    this.button.play.textContent = playing ? 'pause' : 'play';
  }

  /** At the set-points of a start, which reach `size` [m] from there. */
  begin(size: number) {
    const {north, east, height, yaw} = this.sliders;
    for (const slider of [north, east]) {
      slider.range(-size, size, size / 20);
      slider.set(0);
    }
    height.range(size / 10, size, size / 20);
    height.set(0.4 * size);
    yaw.set(0);
    this.begun = null;
    this.pacing = Infinity;
    this.charge = null;
    this.enable(false);
    this.button.stop.disabled = false;
  }
  flies(begun: FlightBegun) {
    this.begun = begun;
    this.list.replaceChildren();
    this.numbers.clear();
    this.enable(true);
    this.aims.disabled = begun.controller === 'none';
  }
  ended() {
    this.enable(false);
    this.button.stop.disabled = true;
  }
  private enable(on: boolean) {
    this.aims.disabled = !on;
    for (const b of [this.button.play, this.button.push]) b.disabled = !on;
  }

  /** Seconds of flight that a second of computing gives. */
  pace(ratio: number) {
    this.pacing = Number.isFinite(this.pacing) ? this.pacing + 0.2 * (ratio - this.pacing) : ratio;
  }

  show(now: Record<string, number>, track: FlightTrack, time: number) {
    const {begun} = this;
    if (!begun) return;
    const metres = (name: string) => `${fixed(now[name] ?? NaN, 3)} m`,
      turn = (name: string) => `${fixed((now[name] ?? NaN) * degrees, 1)}°`;
    const write = (name: string, text: string) => this.write(name, text);
    write('time', `${time.toFixed(3)} s`);
    write('north', metres('north_m'));
    write('east', metres('east_m'));
    write('height', metres('height_m'));
    write('roll', turn('roll_rad'));
    write('pitch', turn('pitch_rad'));
    write('yaw', turn('yaw_rad'));
    write('speed', `${Math.hypot(now.u_m_per_s!, now.v_m_per_s!, now.w_m_per_s!).toFixed(3)} m/s`);
    const kind = begun.amplitude ? 'amplitude' : 'voltage';
    if ('voltage_1_v' in now) {
      write(`${kind} right`, `${now.voltage_0_v!.toFixed(3)} V`);
      write(`${kind} left`, `${now.voltage_1_v.toFixed(3)} V`);
    } else write(kind, `${now.voltage_0_v!.toFixed(3)} V`);
    for (const {name, unit} of begun.controls) {
      if (name.startsWith('voltage')) continue;
      const value = now[name] ?? NaN;
      write(
        name.replaceAll('_', ' '),
        unit === 'rad' ? `${fixed(value * degrees, 2)}°` : `${fixed(value, 3)}${unit === '1' ? '' : ` ${unit}`}`,
      );
    }
    const power = track.mean('electrical_w', time);
    write('electrical power', Number.isFinite(power) ? readable(power, 'W', 3) : '–');
    if (this.charge !== null) write('battery charge', `${(100 * this.charge).toFixed(1)} %`);
    if (this.pacing < 0.95 * this.rate) write('computed at', `${this.pacing.toPrecision(2)} of real time`);
    this.trace.draw(track, time);
  }

  private write(name: string, text: string) {
    let value = this.numbers.get(name);
    if (!value) {
      value = html('dd');
      this.numbers.set(name, value);
      this.list.append(html('div', {}, html('dt', {}, name), value));
    }
    if (value.textContent !== text) value.textContent = text;
  }
}

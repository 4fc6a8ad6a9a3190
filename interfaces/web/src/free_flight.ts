// Free flight of a vehicle with a body: a worker flies some way ahead, the page plays what it has flown.
import type {FlightBegun} from './answers';
import {compiledFlight} from './core';
import {byId} from './dom';
import {Channel, type Outcome} from './engine';
import type {Explorer} from './explorer';
import type {FlightTasks, Push, Wish} from './flight_core';
import {FlightTrack, roundBelow} from './flight_track';
import type {FreeColours} from './free_scene';
import type {FreePicture, Scenes} from './scenes';
import {FlightPanel} from './flight_panel';
import {identityOf} from './state';

const rowsOfWingbeat = 24,
  patience = 180_000, // [ms] for one answer; the trim of wings on hinges takes long on slow machines
  shortest = 0.02, // [s] of flight in a piece
  longest = 0.05;

/** The set-points of a vehicle reach so many wing lengths. */
const reach = (wing: number) => roundBelow(16 * wing);

/** A vehicle that has [body] as far as flight needs it. */
export const hasBody = (explorer: Explorer) => typeof explorer.shown?.values['body.inertia_pitch'] === 'number';

export class FreeFlight {
  readonly panel: FlightPanel;
  track = new FlightTrack(rowsOfWingbeat);
  begun: FlightBegun | null = null;
  /** What is shown [s]. */
  time = 0;
  private compiled: Promise<WebAssembly.Module> | null = null;
  private engine: Channel<FlightTasks> | null = null;
  private scene: FreePicture | null = null;
  private wish: Omit<Wish, 'until'> = {};
  private asked = false;
  private flies = false;
  private ending = '';
  private of = '';
  private text = '';
  private run = 0;
  private last = 0;
  private written = 0;
  private drawn = 0;
  private visible = true;

  constructor(
    private readonly explorer: Explorer,
    private readonly FlightWorker: new () => Worker,
    private readonly scenes: Scenes,
    private readonly canvas: HTMLCanvasElement,
    private readonly colours: () => FreeColours,
    /** Length of a wing [m]. */
    private readonly wing: () => number,
    private readonly say: (text: string) => void,
  ) {
    this.panel = new FlightPanel({
      start: () => void this.start(),
      stop: () => this.stop(),
      aim: (aim) => (this.wish.aim = aim),
      wind: (wind) => (this.wish.wind = wind),
      push: (push) => this.push(push),
      look: () => this.draw(),
    });
    byId('azimuth').addEventListener('input', () => this.draw());
    new IntersectionObserver((entries) => (this.visible = entries.some((e) => e.isIntersecting))).observe(canvas);
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Begins with the design that the page shows. */
  async start() {
    const {shown} = this.explorer;
    if (!shown) return;
    this.end();
    const run = ++this.run;
    const {design} = shown.state,
      size = reach(this.wing());
    this.of = identityOf(design, {});
    this.text = design.text;
    this.panel.begin(size);
    this.say('Trimming for hover and designing the controller …');
    let outcome: Outcome<FlightBegun>;
    try {
      this.engine = await this.channel();
      if (run !== this.run) return this.engine.close();
      const {wind, controller} = this.panel;
      const options = {controller, height: this.panel.aim.height, wind};
      outcome = await this.engine.ask('begin', {stated: {text: design.text, changes: design.changes}, options});
    } catch (error) {
      outcome = {kind: 'failed', why: `The library of flights cannot be loaded: ${(error as Error).message}`};
    }
    if (run !== this.run) return;
    if (outcome.kind !== 'done') return this.refused(outcome);
    const begun = outcome.answer;
    if (!begun.flies) return this.fail(`It cannot be trimmed for hover: ${begun.detail}.`);
    this.begun = begun;
    this.flies = true;
    this.panel.flies(begun);
    this.rebuild();
    this.say(hoverSentence(begun));
    void this.more();
  }

  /** A library of flights in a worker of its own. */
  async channel() {
    this.compiled ??= compiledFlight();
    return new Channel<FlightTasks>(await this.compiled, patience, patience, () => new this.FlightWorker());
  }

  private refused(outcome: Exclude<Outcome<unknown>, {kind: 'done'}>) {
    if (outcome.kind === 'refused') return this.fail(outcome.problems.map((p) => p.message).join(' '));
    if (outcome.kind === 'failed') this.fail(`The flight broke off: ${outcome.why}.`);
  }
  private fail(why: string) {
    this.end();
    this.panel.ended();
    this.say(why);
  }

  /** Ends the worker. */
  private end() {
    this.engine?.close();
    this.engine = null;
    this.flies = this.asked = false;
    this.ending = '';
    this.begun = null;
    this.track = new FlightTrack(rowsOfWingbeat);
    this.time = this.drawn = 0;
    this.wish = {};
  }
  stop() {
    ++this.run;
    this.engine?.close();
    this.engine = null;
    this.flies = this.asked = false;
    this.panel.ended();
    this.say(this.begun ? `Stopped after ${this.time.toFixed(3)} s.` : 'Stopped.');
  }
  /** Leaves the canvas to another picture. */
  dispose() {
    ++this.run;
    this.end();
    this.panel.ended();
    this.scene?.dispose();
    this.scene = null;
  }

  /** The design of the page may be another one now. */
  follow() {
    const {shown} = this.explorer;
    if (!shown || identityOf(shown.state.design, {}) === this.of) return;
    if (shown.state.design.text !== this.text) return void this.start();
    if (!this.engine) return;
    this.stop();
    this.say('The vehicle has changed; what is shown flew before. "Start at hover" flies the present one.');
  }

  private push(push: Push) {
    this.wish.push = push;
    this.say(`Pushed after ${this.track.end.toFixed(3)} s.`);
  }

  /** The next piece, with what has changed meanwhile. */
  private async more() {
    const {engine, run} = this;
    if (!engine || this.asked || !this.flies) return;
    this.asked = true;
    const {wish} = this;
    this.wish = {};
    const from = Math.max(0, this.track.end),
      piece = Math.min(longest, Math.max(shortest, this.ahead));
    const outcome = await engine.ask('fly', {...wish, until: from + piece});
    if (run !== this.run) return;
    this.asked = false;
    if (outcome.kind !== 'done') {
      if (outcome.kind !== 'overtaken') this.refused(outcome);
      return;
    }
    const {columns, flies, detail, time_s} = outcome.answer;
    this.track.append(columns, this.time);
    this.panel.pace((time_s - from) / (outcome.took / 1000));
    this.panel.charge = outcome.answer.charge;
    this.flies = flies;
    if (!flies) this.ending = detail || `It has flown for ${time_s.toFixed(0)} s, the longest flight of this page.`;
  }

  /** [s] of flight that are ready beyond what is shown: a third of a second for who looks. */
  private get ahead() {
    return Math.min(longest, 0.3 * this.panel.rate);
  }

  private frame(now: number) {
    const elapsed = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (this.begun && this.visible && !document.hidden && !byId('pilot').hidden) {
      const {end} = this.track;
      if (this.panel.playing && this.time < end) {
        this.time = Math.min(end, this.time + elapsed * this.panel.rate);
        this.draw();
        if (this.ending && this.time >= end) {
          this.say(this.ending);
          this.engine?.close();
          this.engine = null;
          this.panel.ended();
          this.ending = '';
        }
      }
      if (this.panel.playing || end < 0) {
        if (end - this.time < Math.max(this.ahead, 0.5 * shortest)) void this.more();
        if (end >= 0 && this.drawn === 0) this.draw();
      }
    }
    requestAnimationFrame((later) => this.frame(later));
  }

  /** Another theme, another canvas. */
  rebuild() {
    if (!this.begun) return;
    this.scene?.dispose();
    this.scene = this.scenes.free(this.begun, this.colours());
    this.scene.extend(this.track.trace.place.slice(0, this.drawn));
    this.resize();
  }
  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    if (!this.scene || !clientWidth) return;
    this.scene.resize(clientWidth, clientHeight);
    this.draw();
  }

  private draw() {
    const {track, scene, panel, time} = this;
    if (!scene || track.end < 0) return;
    const now = track.at(time),
      {trace} = track;
    let count = this.drawn;
    while (count < trace.time.length && trace.time[count]! <= time) ++count;
    if (count > this.drawn) scene.extend(trace.place.slice(this.drawn, count));
    this.drawn = count;
    scene.show({
      now,
      azimuth: (Number(byId<HTMLInputElement>('azimuth').value) * Math.PI) / 180,
      distance: panel.distance,
    });
    const clock = performance.now();
    if (clock - this.written < 100) return;
    this.written = clock;
    panel.show(now, track, time);
  }
}

function hoverSentence(begun: FlightBegun): string {
  const by = {
    lqr: 'The linear-quadratic regulator flies it',
    pid: 'The cascade flies it',
    none: 'The controls of hover are held',
  }[begun.controller];
  return [`Trimmed for hover. ${by}.`, ...begun.uncontrolled].join(' ');
}

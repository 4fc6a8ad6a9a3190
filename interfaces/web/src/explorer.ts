// The state of the page and what follows from it: a change is checked at once, solved in a worker, shown when solved.
import {type Controls, type Sensitivity} from './controls';
import {type Core, type Problem, Refused, type RunOptions, type Values} from './core';
import {byId} from './dom';
import {Channel, type Outcome} from './engine';
import {InView} from './in_view';
import {linkOf} from './link';
import {numberOf} from './results';
import {type Design, History, identityOf, maxPins, runOptions, type State} from './state';
import {OwnFiles, shipped} from './vehicles';
import type {Views} from './views';
import type {Computed} from './worker';

/** Results with the state of which they are. */
export interface Shown extends Computed {
  readonly state: State;
  readonly pins: readonly Computed[];
}
export interface Going {
  /** False while a slider still moves. */
  final?: boolean;
  /** The control that asks, which shows why a change is refused: a key, "held"; else the message of the page does. */
  origin?: string;
  /** Undone and redone states are in the history; those of Back and Forward in the browser's, too. */
  from?: 'user' | 'undo' | 'browser';
  /** The address stays as it is. */
  keepAddress?: boolean;
  /** A step of its own, however soon it follows the one before. */
  apart?: boolean;
}
/** Results and how many rows of a cycle were asked for. */
interface Kept {
  computed: Computed;
  rows: number;
}
export type Work = 'solving' | 'solved' | 'failed';

const solveDeadline = 20_000,
  derivativeDeadline = 30_000,
  rows = {resting: 361, moving: 121}, // of a cycle
  kept = 24, // designs
  longest = 500; // entries of the browser's history
/** Entries of the browser's history outlive the page; those of another page's are not taken for this one's. */
const session = crypto.getRandomValues(new Uint32Array(1))[0];

export class Explorer {
  state: State;
  readonly history: History<State>;
  readonly files = new OwnFiles();
  shown: Shown | null = null;
  values: Values = {};
  base: Values = {};
  /** The largest value of each number among the vehicles of the page: a scale for keys that are 0 in one of them. */
  readonly typical: Readonly<Record<string, number>>;
  work: Work = 'solving';
  /** A slider moves: what nobody sees is drawn once it rests. */
  private moving = false;
  readonly inView = new InView(() => this.moving);
  /** When the state was taken, as performance.now(). */
  asked = 0;
  /** Why the state has no results, where work is "failed". */
  failure = '';
  private readonly solver: Channel;
  private readonly slopes: Channel;
  private readonly flights: Channel;
  private readonly cache = new Map<string, Kept>();
  private readonly bases = new Map<string, Values>();
  private readonly listeners: (() => void)[] = [];
  private readonly visited = new Map<number, State>();
  private written = 0;
  private good: State;
  private settle = 0;
  private built = Promise.resolve();
  private step = false;
  private idlers: (() => void)[] = [];
  /** Fields beside those of the keys that show why what they ask for is refused. */
  readonly fields = new Map<string, {complain: (text: string) => void; accept: () => void}>();
  controls!: Controls;
  views!: Views;

  constructor(
    readonly core: Core,
    readonly compiled: WebAssembly.Module,
    state: State,
  ) {
    this.state = this.good = state;
    this.history = new History(state);
    this.solver = new Channel(compiled, solveDeadline, 400);
    this.slopes = new Channel(compiled, derivativeDeadline, 600);
    this.flights = new Channel(compiled, derivativeDeadline, 600);
    this.solver.warm();
    const typical: Record<string, number> = {};
    for (const text of Object.values(shipped)) {
      for (const [key, value] of Object.entries(core.values({text, changes: {}}))) {
        if (typeof value === 'number') typical[key] = Math.max(typical[key] ?? 0, Math.abs(value));
      }
    }
    this.typical = typical;
  }

  /** Called whenever the state or what is known of it changes. */
  watch(listener: () => void) {
    this.listeners.push(listener);
  }
  private notify() {
    for (const listener of this.listeners) listener();
  }

  // ---- changes

  /** Takes a state. False where it is refused, overtaken or ended; the state before stays where it is refused. */
  async go(
    state: State,
    {final = true, origin = '', from = 'user', keepAddress = false, apart = false}: Going = {},
  ): Promise<boolean> {
    const before = this.state;
    let values, base;
    try {
      values = this.core.values(state.design);
      base = this.baseOf(state.design.text);
      for (const pin of state.pins) this.core.values(pin);
    } catch (error) {
      this.refuse(error, origin);
      return false;
    }
    Object.assign(this, {state, values, base, moving: !final});
    if (from !== 'user') this.history.visit(state);
    if (from === 'browser') this.step = false;
    else if (final) this.step = from === 'undo' || this.history.commit(state, apart ? '' : origin) || this.step;
    if (origin) this.accept(origin);
    if (!origin || state.design.text !== before.design.text) {
      this.controls.acceptAll();
      for (const field of this.fields.values()) field.accept();
    }
    this.say('');
    this.showControls();
    return this.solve(origin, final && !keepAddress);
  }

  /** Controls of other keys are built in a task of their own, for they take as long as the rest of a change. */
  private showControls() {
    if (this.controls.move(this.state.design, this.values)) return;
    this.built = new Promise((done) =>
      setTimeout(() => {
        this.controls.build(this.state.design, this.values, this.base);
        done();
      }),
    );
  }

  /** The values of a vehicle file itself. */
  baseOf(text: string): Values {
    const known = this.bases.get(text);
    if (known) return known;
    const base = this.core.values({text, changes: {}});
    this.bases.set(text, base);
    return base;
  }

  /** Why the library refuses a state; nothing where it takes it. */
  problemsOf(state: State): string[] {
    try {
      for (const design of [state.design, ...state.pins]) this.core.values(design);
      return [];
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      return error.problems.map((p) => p.message);
    }
  }

  /** New values of keys, each as text for the library; an empty one takes the key's change back. */
  change(changes: Record<string, string>, going: Going = {}): Promise<boolean> {
    return this.go({...this.state, design: this.changed(this.state.design, changes)}, going);
  }

  changed(design: Design, changes: Record<string, string>): Design {
    const merged = {...design.changes, ...changes};
    for (const key of Object.keys(changes)) {
      // of alternatives the last one given holds
      for (const other of this.core.tables.keys.find((k) => k.key === key)?.alternatives ?? []) delete merged[other];
      if (changes[key] === '') delete merged[key];
    }
    return this.withStartingValues({...design, changes: merged});
  }

  /** A choice may ask for keys that the vehicle lacks: they get the values a new vehicle starts with. */
  private withStartingValues(design: Design): Design {
    let filled = design;
    for (let tries = 0; tries < 6; ++tries) {
      try {
        this.core.values(filled);
        return filled;
      } catch (error) {
        if (!(error instanceof Refused)) throw error;
        const added: Record<string, string> = {};
        for (const {key, message} of error.problems) {
          const row = this.core.tables.keys.find((k) => k.key === key);
          if (row?.example && /missing/.test(message) && !(row.key in filled.changes)) added[row.key] = row.example;
        }
        if (Object.keys(added).length === 0) return design;
        filled = {...filled, changes: {...filled.changes, ...added}};
      }
    }
    return design;
  }

  undo() {
    if (this.history.canUndo) return this.go(this.history.undo(), {from: 'undo'});
  }
  redo() {
    if (this.history.canRedo) return this.go(this.history.redo(), {from: 'undo'});
  }

  pin(design: Design = this.state.design) {
    return this.go({...this.state, pins: [...this.state.pins, design].slice(-maxPins)});
  }

  // ---- what is refused

  refuse(error: unknown, origin = '') {
    const problems: Problem[] = error instanceof Refused ? error.problems : [{message: String(error)}];
    const text = problems.map((p) => p.message).join('\n');
    const field = this.fields.get(origin);
    if (field) field.complain(text);
    else if (!origin || !this.controls.complain(origin, text)) this.say(text);
  }
  private accept(origin: string) {
    this.fields.get(origin)?.accept();
    this.controls.accept(origin);
  }

  /** Above the page. */
  say(text: string) {
    const message = byId('message');
    message.hidden = !text;
    message.textContent = text;
  }

  // ---- solving

  private async solve(origin: string, write: boolean): Promise<boolean> {
    const {state} = this;
    const options = runOptions(state);
    const wanted = [state.design, ...state.pins];
    const count = this.moving ? rows.moving : rows.resting;
    const missing = wanted.filter((design) => !((this.cache.get(identityOf(design, options))?.rows ?? 0) >= count));
    this.work = 'solving';
    this.asked = performance.now();
    clearTimeout(this.settle);
    this.notify();
    if (missing.length) {
      const stated = missing.map(({text, changes}) => ({text, changes}));
      const outcome = await this.solver.ask('designs', {designs: stated, options, rows: count});
      if (outcome.kind !== 'done') return this.unsolved(state, outcome, origin);
      missing.forEach((design, n) => this.keep(design, options, {computed: outcome.answer[n]!, rows: count}));
    }
    await this.built;
    const [current, ...pins] = wanted.map((design) => this.cache.get(identityOf(design, options))?.computed);
    if (!current || pins.some((pin) => !pin)) throw new Error('more pins than designs are kept');
    // Of a slider that moves every design is drawn, though the next one is asked for already.
    this.shown = {...current, state, pins: pins as Computed[]};
    if (state === this.state) {
      this.work = 'solved';
      this.good = state;
    }
    window.firstNumber ??= performance.now();
    this.notify();
    if (state !== this.state) return false;
    this.settle = window.setTimeout(
      () => void (this.moving ? this.rested(write) : this.settled(write)),
      write ? 0 : 120,
    );
    this.rest();
    return true;
  }

  private unsolved(state: State, outcome: Exclude<Outcome<unknown>, {kind: 'done'}>, origin: string): false {
    if (state !== this.state || outcome.kind === 'overtaken') return false;
    if (outcome.kind === 'refused') {
      this.history.remove(state);
      void this.go(this.good, {from: 'browser'}).then(() => this.refuse(new Refused(outcome.problems), origin));
    } else {
      this.work = 'failed';
      this.failure = outcome.why;
      this.moving = false;
      this.inView.flush();
      this.notify();
      this.rest();
    }
    return false;
  }

  private keep(design: Design, options: RunOptions, found: Kept) {
    this.cache.set(identityOf(design, options), found);
    for (const oldest of this.cache.keys()) {
      if (this.cache.size <= kept) break;
      this.cache.delete(oldest);
    }
  }

  /** Ends the computation of the state; what is shown stays, marked as that of another state. */
  stop() {
    this.solver.stop('stopped');
  }
  again() {
    return this.solve('', true);
  }

  /** The slider has stopped, or is held: the cycle in all its rows, and what is out of sight. */
  private rested(write: boolean) {
    this.moving = false;
    this.inView.flush();
    return this.solve('', write);
  }

  /** When nothing is being solved for the state. */
  idle(): Promise<void> {
    if (this.work !== 'solving') return Promise.resolve();
    return new Promise((done) => this.idlers.push(done));
  }
  private rest() {
    for (const done of this.idlers.splice(0)) done();
  }

  // ---- after the last of a row of changes: derivatives, endurance, the address

  private async settled(write: boolean) {
    const {state, shown} = this;
    if (!shown || shown.state !== state) return;
    void this.findEndurance(shown);
    if (write) void this.writeAddress(state);
    const keys = this.core.tables.keys
      .filter((k) => k.number && !k.whole && typeof shown.values[k.key] === 'number' && shown.values[k.key] !== 0)
      .map((k) => k.key);
    // Of a lift that is held there are no derivatives.
    if (shown.solved.report.status !== 'flapping' || !shown.solved.reached || state.hold === 'lift')
      return this.controls.sensitivities({});
    const {text, changes} = state.design;
    const found = await this.slopes.ask('gradients', {stated: {text, changes}, keys, options: runOptions(state)});
    if (state !== this.state) return;
    this.controls.sensitivities(found.kind === 'done' ? this.relative(shown, keys, found.answer) : {});
    document.body.dataset.sensitivities = 'shown';
  }

  private relative(shown: Shown, keys: string[], found: Record<string, (number | null)[]>) {
    const slopeOf = (metric: string) => {
      const column = this.core.tables.metrics.findIndex((m) => m.key === metric),
        size = numberOf(shown.solved.report, metric);
      return (key: string) => {
        const slope = found[key]?.[column],
          value = shown.values[key];
        return typeof slope === 'number' && typeof value === 'number' && size ? (slope * value) / size : null;
      };
    };
    const lift = slopeOf('lift_mean_n'),
      power = slopeOf('power_electrical_w');
    const sensitivities: Record<string, Sensitivity> = {};
    for (const key of keys) sensitivities[key] = {lift: lift(key), power: power(key)};
    return sensitivities;
  }

  /** How long it hovers and how long the battery lasts: some forty designs of the vehicle, beside the page. */
  private async findEndurance(shown: Shown) {
    const {report} = shown.solved;
    if (!String(shown.values['supply.type']).startsWith('battery') || report.status !== 'flapping') return;
    if (report.endurance_s !== null) return;
    const {text, changes} = shown.state.design;
    const options = {...runOptions(shown.state), endurance: true};
    const found = await this.flights.ask('report', {stated: {text, changes}, options});
    if (found.kind !== 'done') return;
    report.hover_s = found.answer.hover_s;
    report.endurance_s = found.answer.endurance_s;
    if (this.shown !== shown) return;
    this.shown = {...shown}; // its report says more now
    this.notify();
  }

  /** A step of the history is a step of the browser's too, so that Back undoes it. */
  private async writeAddress(state: State) {
    const step = this.step;
    this.step = false;
    const link = await linkOf(state, shipped);
    const entry = {session, id: ++this.written};
    this.visited.set(entry.id, state);
    this.visited.delete(entry.id - longest);
    if (step) history.pushState(entry, '', link);
    else history.replaceState(entry, '', link);
    document.body.dataset.address = String(entry.id);
  }

  /** The state of an entry of the browser's history, where this page made it. */
  visitedState(entry: unknown): State | null {
    const {session: of, id} = (entry ?? {}) as {session?: unknown; id?: unknown};
    return of === session && typeof id === 'number' ? (this.visited.get(id) ?? null) : null;
  }
}

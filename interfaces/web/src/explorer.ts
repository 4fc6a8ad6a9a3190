// From a state to what the page shows: everything that follows a change.
import {type Background} from './background';
import {
  type Columns,
  type Core,
  type Mechanism,
  type Problem,
  Refused,
  type Solved,
  type StartUp,
  type Stated,
  type Values,
} from './core';
import {Controls, type Sensitivity} from './controls';
import {byId} from './dom';
import {pythonProgram, shellCommand} from './elsewhere';
import {type Abscissa, CyclePlots} from './pictures/cycle_plots';
import {
  atRest,
  drawMechanism,
  type Instant,
  instantAt,
  type Peaks,
  peaksOf,
  restText,
  strokeAt,
} from './pictures/mechanism';
import {drawSankey} from './pictures/sankey';
import {Playback} from './playback';
import {numberOf, showBalance, showHeadline, showMetrics} from './results';
import {type Design, linkOf, runOptions, type State} from './state';
import {shipped} from './vehicles';

declare global {
  /** When the first result stood on the page [ms since navigation]. */
  interface Window {
    firstNumber?: number;
  }
}

const rows = 361;
const fullTurn = Float64Array.from({length: 181}, (_, n) => (2 * Math.PI * n) / 180);

/** What is known of one design. */
interface Computed {
  values: Values;
  solved: Solved;
  mechanism: Mechanism;
  startUp: StartUp | null;
  peaks: Peaks | null;
  range: [number, number];
}

export class Explorer {
  state: State;
  current!: Computed;
  private pinned: Computed | null = null;
  private base: Values = {};
  private readonly controls: Controls;
  readonly plots: CyclePlots;
  readonly playback: Playback;
  private readonly typical: Record<string, number> = {};
  private settle = 0;
  private flowRoom = 0;
  abscissa: Abscissa = 'time';
  /** Set by those who show tools and studies. */
  refreshTools: () => void = () => {};
  keysChanged: () => void = () => {};

  constructor(
    readonly core: Core,
    readonly background: Background,
    state: State,
  ) {
    this.state = state;
    this.findTypical();
    this.controls = new Controls(byId('controls'), core.tables.keys, this.typical, {
      change: (key, value, final) => this.change({[key]: value}, final),
      reset: (key) => this.withdraw(key),
    });
    this.plots = new CyclePlots(byId('plots'), (share) => {
      this.pause();
      this.playback.show(share);
    });
    this.playback = new Playback(
      () => this.period(),
      (share) => this.drawInstant(share),
      () => this.hasCycle(),
    );
  }

  /** The largest value of each number among the vehicles that come along: a scale for keys that are 0 here. */
  private findTypical() {
    for (const text of Object.values(shipped)) {
      for (const [key, value] of Object.entries(this.core.values({text, changes: {}}))) {
        if (typeof value === 'number') this.typical[key] = Math.max(this.typical[key] ?? 0, Math.abs(value));
      }
    }
  }

  typicalOf(key: string) {
    return this.typical[key] ?? 0;
  }

  // ---- changes

  /** Takes the state and shows it; what the library refuses is said, and the state before stays. */
  open(state: State): boolean {
    const before = this.state;
    this.state = state;
    try {
      this.base = this.core.values({text: state.design.text, changes: {}});
      this.pinned = state.pinned ? this.computed(state.pinned) : null;
      this.update(true);
      return true;
    } catch (error) {
      this.state = before;
      if (this.current) this.base = this.core.values({text: before.design.text, changes: {}});
      this.complain(error);
      return false;
    }
  }

  /** New values of keys, each as text for the library. */
  change(changes: Record<string, string>, final = true) {
    const before = this.state.design;
    const merged = {...before.changes, ...changes};
    for (const key of Object.keys(changes)) {
      // of alternatives the last one given holds
      for (const other of this.core.tables.keys.find((k) => k.key === key)?.alternatives ?? []) delete merged[other];
      if (changes[key] === '') delete merged[key];
    }
    this.attempt({...before, changes: merged}, final);
  }

  withdraw(key: string) {
    const changes = {...this.state.design.changes};
    delete changes[key];
    this.attempt({...this.state.design, changes}, true);
  }

  private attempt(design: Design, final: boolean) {
    const before = this.state.design;
    const filled = this.withStartingValues(design);
    this.state.design = filled;
    try {
      this.update(final);
    } catch (error) {
      this.state.design = before;
      this.complain(error);
    }
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

  /** Beside the control of the key, or above the page where there is none, and for what a file says. */
  complain(error: unknown, ofFile = false) {
    const problems: Problem[] = error instanceof Refused ? error.problems : [{message: String(error)}];
    const others = problems.filter((p) => ofFile || !p.key || !this.controls.complain(p.key, p.message));
    const message = byId('message');
    message.hidden = others.length === 0;
    message.textContent = others.map((p) => p.message).join('\n');
    if (this.current) this.controls.show(this.stated, this.current.values, this.base);
  }

  // ---- from the state to the page

  get stated(): Stated {
    return this.state.design;
  }
  hasCycle() {
    return !!this.current?.solved.columns.time_s;
  }

  private period(): number {
    if (!this.current) return 0;
    const time = this.hasCycle() ? this.current.solved.columns.time_s : this.current.startUp?.columns.time_s;
    return time && time.length ? time[time.length - 1] : 0;
  }

  private computed(stated: Stated): Computed {
    const options = runOptions(this.state);
    const values = this.core.values(stated);
    const solved = this.core.solve(stated, {...options, rows});
    const mechanism = this.core.mechanism(stated, fullTurn);
    const cycle = solved.columns.time_s ? solved.columns : null;
    const startUp = cycle || solved.report.status === null ? null : this.core.startUp(stated, options);
    const stroke = mechanism.rotates
      ? mechanism.columns.stroke_angle_rad
      : (cycle?.stroke_angle_rad ?? new Float64Array([0]));
    const range: [number, number] = [stroke.reduce((a, b) => Math.min(a, b)), stroke.reduce((a, b) => Math.max(a, b))];
    return {values, solved, mechanism, startUp, peaks: cycle ? peaksOf(cycle) : null, range};
  }

  private update(final: boolean) {
    const computed = this.computed(this.stated);
    this.current = computed;
    const {solved} = computed;
    byId('message').hidden = true;
    this.controls.clearComplaints();
    this.controls.show(this.stated, computed.values, this.base);
    showHeadline(byId('headline'), solved, this.core.tables.metrics);
    window.firstNumber ??= performance.now();
    const cycle = this.hasCycle() ? solved.columns : null;
    this.drawFlows();
    showBalance(byId('balance'), cycle ? solved.balance : null);
    this.showAllMetrics();
    this.drawCycle();
    if (!cycle) this.playback.share = 0;
    this.drawInstant(this.playback.share);
    clearTimeout(this.settle);
    this.settle = window.setTimeout(() => this.settled(), final ? 0 : 120);
  }

  /** Pictures whose letters keep their size follow the width of the page. */
  resized() {
    this.flowRoom = 0;
    this.drawFlows();
  }

  private drawFlows() {
    const picture = document.querySelector<SVGSVGElement>('#sankey')!;
    this.flowRoom ||= picture.clientWidth; // a layout of the page, so not at each change
    drawSankey(picture, this.hasCycle() ? this.current.solved.balance : null, this.flowRoom);
  }

  drawCycle() {
    const force =
      {'four-bar': 'coupler force', tabulated: 'reaction'}[this.current.mechanism.type as string] ?? 'rod force';
    const ghost = this.pinned?.solved.columns.time_s ? this.pinned.solved.columns : null;
    this.plots.draw(this.hasCycle() ? this.current.solved.columns : null, ghost, this.abscissa, force);
  }

  private drawInstant(share: number) {
    if (!this.current) return;
    const {mechanism, range, solved, startUp} = this.current;
    const picture = document.querySelector<SVGSVGElement>('#mechanism')!;
    const status = solved.report.status ?? 'undecided';
    let rest = null;
    let instant: Instant;
    if (this.hasCycle()) {
      instant = instantAt(solved.columns, this.current.peaks!, share);
      this.plots.moveCursor(share);
    } else {
      const angle = solved.evidence.angle_rad ?? startUp?.evidence.angle_rad ?? null;
      instant = this.startingInstant(startUp?.columns ?? null, mechanism, share, angle ?? 0);
      rest = {angle, stopped: share >= 1, text: restText(status, angle)};
    }
    const ghost = this.pinned?.peaks
      ? {mechanism: this.pinned.mechanism, instant: instantAt(this.pinned.solved.columns, this.pinned.peaks, share)}
      : null;
    drawMechanism(picture, mechanism, instant, range, ghost, rest);
    const scrub = byId<HTMLInputElement>('scrub');
    if (document.activeElement !== scrub) scrub.value = String(Math.round(share * 1000));
  }

  /** On the way to where it stops. */
  private startingInstant(columns: Columns | null, mechanism: Mechanism, share: number, angle: number): Instant {
    if (!columns || columns.time_s.length < 2) return atRest(mechanism, angle);
    const time = columns.time_s,
      now = share * time[time.length - 1];
    let row = 1;
    while (row < time.length - 1 && time[row] < now) ++row;
    const part = Math.min(1, (now - time[row - 1]) / (time[row] - time[row - 1] || 1));
    const theta =
      columns.crank_angle_rad[row - 1] + part * (columns.crank_angle_rad[row] - columns.crank_angle_rad[row - 1]);
    const instant = atRest(mechanism, theta);
    if (mechanism.rotates) instant.strokeAngle = strokeAt(mechanism, theta);
    return instant;
  }

  /** After the last of a row of changes: derivatives, the link, the commands. */
  private async settled() {
    const state = this.state;
    this.findEndurance();
    byId('shell').textContent = shellCommand(state);
    byId('python').textContent = pythonProgram(state);
    linkOf(state).then((link) => {
      if (state === this.state) history.replaceState(null, '', link);
    });
    byId('restore').toggleAttribute('disabled', Object.keys(state.design.changes).length === 0);
    this.keysChanged();
    const {values, solved} = this.current;
    const keys = this.core.tables.keys
      .filter((k) => k.number && !k.whole && typeof values[k.key] === 'number' && values[k.key] !== 0)
      .map((k) => k.key);
    // Of a lift that is held there are no derivatives.
    if (solved.report.status !== 'flapping' || state.hold === 'lift') return this.controls.sensitivities({});
    const found = await this.background.gradients(
      {text: this.stated.text, changes: {...this.stated.changes}},
      keys,
      runOptions(state),
    );
    if (!found) return;
    const metric = (key: string) => this.core.tables.metrics.findIndex((m) => m.key === key);
    const lift = metric('lift_mean_n'),
      power = metric('power_electrical_w');
    const sensitivities: Record<string, Sensitivity> = {};
    for (const key of keys) {
      const relative = (m: number, of: string) => {
        const slope = found[key]?.[m],
          value = numberOf(solved.report, of);
        return typeof slope === 'number' && value !== null && value !== 0
          ? (slope * (values[key] as number)) / value
          : null;
      };
      sensitivities[key] = {lift: relative(lift, 'lift_mean_n'), power: relative(power, 'power_electrical_w')};
    }
    this.controls.sensitivities(sensitivities);
    document.body.dataset.sensitivities = 'shown';
  }

  /** How long it hovers and how long the battery lasts: some forty designs of the vehicle, beside the page. */
  private async findEndurance() {
    const current = this.current;
    if (!String(current.values['supply.type']).startsWith('battery') || current.solved.report.status !== 'flapping')
      return;
    const stated = {text: this.stated.text, changes: {...this.stated.changes}};
    const found = await this.background.report(stated, {...runOptions(this.state), endurance: true});
    if (!found || this.current !== current) return;
    current.solved.report.hover_s = found.hover_s;
    current.solved.report.endurance_s = found.endurance_s;
    this.showAllMetrics();
  }

  private showAllMetrics() {
    const {report} = this.current.solved;
    showMetrics(byId('metrics'), this.core.tables.metrics, report, this.pinned?.solved.report ?? null);
  }

  // ---- comparison and playback

  pinnedReport() {
    return this.pinned?.solved.report ?? null;
  }

  pin() {
    this.open({...this.state, pinned: {...this.state.design, changes: {...this.state.design.changes}}});
    this.showPins();
  }
  unpin() {
    this.open({...this.state, pinned: null});
    this.showPins();
  }
  showPins() {
    byId('unpin').hidden = !this.state.pinned;
  }

  pause() {
    this.play(false);
  }
  play(on: boolean) {
    this.playback.playing = on;
    if (on && !this.hasCycle() && this.playback.share >= 1) this.playback.share = 0;
    const button = byId('play');
    button.textContent = on ? 'pause' : 'play';
    button.setAttribute('aria-pressed', String(on));
  }
}

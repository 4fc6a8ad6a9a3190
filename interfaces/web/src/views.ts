// What the page shows of results: headline, mechanism, flows, cycle, tables. Each is of the state of explorer.shown;
// where that is not the state of the page, the page says so.
import type {Columns, Mechanism} from './core';
import {byId, html, setValue} from './dom';
import type {Explorer, Shown} from './explorer';
import {type Abscissa, CyclePlots} from './pictures/cycle_plots';
import {match, type Matched, type Measured} from './measured';
import {LiveFlow} from './pictures/live_flow';
import * as drawn from './pictures/mechanism';
import {drawSankey} from './pictures/sankey';
import {drawnWing} from './pictures/grips';
import {Playback} from './playback';
import {readable} from './quantities';
import {showBalance, showHeadline} from './results';
import {describeDesign, type State} from './state';
import {Touch} from './touch';
import type {Computed} from './worker';

/** [ms] that a computation may take before the page says that it runs. */
const unnoticed = 250;
/** [ms] after a change within which most vehicles are drawn anew. */
const soon = 80;

const describe = (state: State) =>
  describeDesign(state.design, state.condition) +
  (state.hold === 'voltage' ? '' : `, ${state.hold} held at ${state.held} ${state.hold === 'lift' ? 'N' : 'Hz'}`);

export class Views {
  readonly plots: CyclePlots;
  readonly playback: Playback;
  abscissa: Abscissa = 'time';
  private flowRoom = 0;
  private drawn: Shown | null = null;
  private peaks: drawn.Peaks | null = null;
  private range: [number, number] = [0, 0];
  private ghostPeaks: drawn.Peaks | null = null;
  private notice = 0;
  private measured: Measured | null = null;
  private readonly touch: Touch;
  private readonly flow: LiveFlow;
  private picture: drawn.Drawn | null = null;
  private ghostPicture: drawn.Drawn | null = null;
  /** Called with what is measured, or null when that is taken away. */
  measuredChanged: (measured: Measured | null) => void = () => {};
  /** Others that follow the instant that the page shows. */
  readonly followers: ((share: number, playing: boolean) => void)[] = [];

  constructor(private readonly explorer: Explorer) {
    this.touch = new Touch(explorer, document.querySelector<SVGSVGElement>('#mechanism')!, {
      playing: () => this.playback.playing,
      set: (on) => this.play(on),
    });
    this.flow = new LiveFlow(document.querySelector<SVGSVGElement>('#sankey')!);
    this.plots = new CyclePlots(byId('plots'), explorer.inView, (share) => {
      this.pause();
      this.playback.show(share);
    });
    this.playback = new Playback(
      () => this.period(),
      (share) => this.drawInstant(share),
      () => this.hasCycle(),
      () => explorer.work === 'solving' && performance.now() - explorer.asked < soon,
    );
    explorer.watch(() => this.update());
  }

  hasCycle() {
    return !!this.drawn?.solved.columns.time_s;
  }
  private get cycle(): Columns | null {
    return this.drawn && this.hasCycle() ? this.drawn.solved.columns : null;
  }
  private get ghost(): Computed | null {
    return this.drawn?.pins[0] ?? null;
  }

  private period(): number {
    const time = this.cycle?.time_s ?? this.drawn?.startUp?.columns.time_s;
    return time?.[time.length - 1] ?? 0;
  }

  // ---- from the state to the page

  private update() {
    const {explorer} = this,
      {shown} = explorer;
    if (shown && shown !== this.drawn) this.draw(shown);
    this.showWork();
  }

  /** Whether what is shown is of the state of the page; if not, of which, and what to do about it. */
  private showWork() {
    const {explorer} = this,
      {work, shown, state} = explorer;
    const current = shown?.state === state && work === 'solved';
    clearTimeout(this.notice);
    if (current) return this.showNotice(null);
    const say = () => {
      const of =
        shown && shown.state !== state ? ` Pictures and numbers below are those of ${describe(shown.state)}.` : '';
      const [text, label, act] =
        work === 'failed'
          ? ([`Not computed: ${explorer.failure}.`, 'compute again', () => void explorer.again()] as const)
          : (['Computing.', 'stop', () => explorer.stop()] as const);
      this.showNotice([
        html('strong', {}, describe(state)),
        ` ${text}${of} `,
        html('button', {type: 'button', id: 'stop', click: act}, label),
      ]);
    };
    if (work === 'failed') say();
    else this.notice = window.setTimeout(say, unnoticed);
  }

  private showNotice(parts: (Node | string)[] | null) {
    const notice = byId('notice');
    const focused = notice.contains(document.activeElement);
    notice.hidden = parts === null;
    notice.replaceChildren(...(parts ?? []));
    document.body.toggleAttribute('data-other-state', parts !== null);
    if (focused) (notice.querySelector('button') ?? byId('headline')).focus();
  }

  private draw(shown: Shown) {
    this.drawn = shown;
    const {solved, mechanism} = shown,
      cycle = this.cycle;
    const stroke = mechanism.rotates
      ? mechanism.columns.stroke_angle_rad!
      : (cycle?.stroke_angle_rad ?? new Float64Array([0]));
    this.range = [stroke.reduce((a, b) => Math.min(a, b)), stroke.reduce((a, b) => Math.max(a, b))];
    this.peaks = cycle ? drawn.peaksOf(cycle) : null;
    const picture = this.drawnAs(shown, shown.state.design.text, this.range);
    this.picture = {...picture, room: this.touch.room ?? picture.room};
    const ghost = this.ghost,
      text = shown.state.pins[0]?.text;
    this.ghostPicture = ghost && text !== undefined ? this.drawnAs(ghost, text, [0, 0]) : null;
    const other = this.ghost?.solved.columns;
    this.ghostPeaks = other?.time_s ? drawn.peaksOf(other) : null;
    showHeadline(byId('headline-numbers'), solved, this.explorer.core.tables.metrics);
    const {inView} = this.explorer;
    inView.draw(document.querySelector('#sankey')!, () => this.drawFlows());
    inView.draw(byId('balance'), () => showBalance(byId('balance'), cycle ? solved.balance : null));
    this.drawCycle();
    if (!cycle) this.playback.share = 0;
    this.drawInstant(this.playback.share);
  }

  private drawnAs({mechanism, values}: Computed, text: string, range: [number, number]): drawn.Drawn {
    const wing = drawnWing(values, this.explorer.baseOf(text));
    return {mechanism, wing, room: drawn.roomFor(mechanism, range, wing)};
  }

  /** Pictures whose letters keep their size follow the width of the page. */
  resized() {
    this.flowRoom = 0;
    this.drawFlows();
  }

  private drawFlows() {
    const picture = document.querySelector<SVGSVGElement>('#sankey')!;
    this.flowRoom ||= picture.clientWidth; // a layout of the page, so not at each change
    const balance = this.drawn && this.hasCycle() ? this.drawn.solved.balance : null;
    const flows = drawSankey(picture, balance, this.flowRoom);
    this.flow.set(flows, balance, this.cycle, this.drawn?.values ?? {});
    this.flow.show(this.playback?.share ?? 0);
  }

  drawCycle() {
    if (!this.drawn) return;
    const force =
      {'four-bar': 'coupler force', tabulated: 'reaction'}[this.drawn.mechanism.type as string] ?? 'rod force';
    const legend = byId('force-name');
    legend.textContent = force;
    legend.hidden = !drawn.hasRod(this.drawn.mechanism); // an arrow is drawn where there is a rod
    const ghost = this.ghost?.solved.columns;
    const matched = this.measured && this.cycle ? match(this.measured, this.cycle) : null;
    this.plots.draw(this.cycle, ghost?.time_s ? ghost : null, this.abscissa, force, matched, this.residuals);
    this.showMeasured(matched);
  }

  /** A measured cycle in the panels of its columns; null takes it away. */
  measure(measured: Measured | null) {
    this.measured = measured;
    this.drawCycle();
    this.measuredChanged(measured);
  }
  get measurement() {
    return this.measured;
  }
  /** Whether panels of measured columns show the measurement minus the model. */
  residuals = false;

  private showMeasured(matched: Matched | null) {
    const note = byId('measured'),
      {measured} = this;
    note.hidden = measured === null;
    if (!measured) return;
    const quantities = this.explorer.core.tables.waveforms;
    const parts = Object.entries(matched?.deviations ?? {}).map(([key, value]) => {
      const {meaning, unit} = quantities.find((q) => q.key === key)!;
      return `${meaning} ${readable(value, unit, 3)}`;
    });
    const text = matched
      ? `Root mean square deviation from the model: ${parts.join(', ')}.` +
        (matched.shift === null ? '' : ` Times are shifted by ${readable(matched.shift, 's', 3)}.`)
      : 'The design has no steady cycle to compare with.';
    const ignored = measured.ignored.length ? ` Columns not used: ${measured.ignored.join(', ')}.` : '';
    const remove = html('button', {type: 'button', click: () => this.measure(null)}, 'remove the measurement');
    note.replaceChildren(html('strong', {}, measured.name), `: ${text}${ignored} `, remove);
  }

  private drawInstant(share: number) {
    if (!this.drawn) return;
    const {mechanism, solved, startUp} = this.drawn,
      {inView} = this.explorer,
      cycle = this.cycle;
    const picture = document.querySelector<SVGSVGElement>('#mechanism')!;
    let rest = null;
    let instant: drawn.Instant;
    if (cycle && this.peaks) {
      instant = drawn.instantAt(cycle, this.peaks, share);
      this.plots.moveCursor(share);
    } else {
      const angle = solved.evidence.angle_rad ?? startUp?.evidence.angle_rad ?? null;
      instant = startingInstant(startUp?.columns ?? null, mechanism, share, angle ?? 0);
      const status = solved.reached ? (solved.report.status ?? 'undecided') : 'out of reach';
      rest = {angle, stopped: share >= 1, text: drawn.restText(status, solved.reached ? angle : null)};
    }
    const ghost =
      this.ghost && this.ghostPeaks && this.ghostPicture
        ? {...this.ghostPicture, instant: drawn.instantAt(this.ghost.solved.columns, this.ghostPeaks, share)}
        : null;
    drawn.drawMechanism(picture, this.picture!, instant, this.range, ghost, rest);
    this.touch.show(this.picture!, instant);
    inView.show(document.querySelector('#sankey')!, () => this.flow.show(this.playback.share));
    for (const follow of this.followers) follow(share, this.playback?.playing ?? false);
    const scrub = byId<HTMLInputElement>('scrub');
    if (document.activeElement !== scrub) setValue(scrub, String(Math.round(share * 1000)));
  }

  pause() {
    this.play(false);
  }
  play(on: boolean) {
    this.playback.playing = on;
    if (!on) this.explorer.inView.flush();
    if (on && !this.hasCycle() && this.playback.share >= 1) this.playback.share = 0;
    const button = byId('play');
    button.textContent = on ? 'pause' : 'play';
    button.setAttribute('aria-pressed', String(on));
  }
}

/** On the way to where it stops. */
function startingInstant(columns: Columns | null, mechanism: Mechanism, share: number, angle: number): drawn.Instant {
  const time = columns?.time_s,
    angles = columns?.crank_angle_rad;
  if (!time || !angles || time.length < 2) return drawn.atRest(mechanism, angle);
  const now = share * time[time.length - 1]!;
  let row = 1;
  while (row < time.length - 1 && time[row]! < now) ++row;
  const part = Math.min(1, (now - time[row - 1]!) / (time[row]! - time[row - 1]! || 1));
  const theta = angles[row - 1]! + part * (angles[row]! - angles[row - 1]!);
  const instant = drawn.atRest(mechanism, theta);
  if (mechanism.rotates) instant.strokeAngle = drawn.strokeAt(mechanism, theta);
  return instant;
}

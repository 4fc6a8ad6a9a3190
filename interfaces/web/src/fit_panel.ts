// "Fit to the measurement": keys that may change within limits, until the cycle is as near to the measured one as it
// can be; computed in a worker, which can be stopped.
import {Refused} from './core';
import {byId} from './dom';
import {Channel} from './engine';
import type {Explorer} from './explorer';
import type {FitResult, Fitted} from './fit';
import {KeyLimits} from './limits';
import {digits, exact, readable} from './quantities';
import {runOptions, type State} from './state';

const deadline = 60_000; // without a design accepted [ms]
const proposed = [
  ['friction.radius', 'friction.torque', 'friction.damping'],
  ['aerodynamics.pitch_coefficient', 'pitch.stiffness'],
];

export class FitPanel {
  private readonly channel: Channel;
  private readonly limits: KeyLimits;

  constructor(private readonly explorer: Explorer) {
    this.channel = new Channel(explorer.compiled, deadline, 0);
    const note = byId('fit-note');
    this.limits = new KeyLimits(explorer, 'fit', proposed, (text) => (note.textContent = text));
    byId('fit').addEventListener('click', () => {
      if (this.channel.busy) this.channel.stop('stopped');
      else void this.run();
    });
    const residuals = byId<HTMLInputElement>('residuals');
    residuals.addEventListener('change', () => {
      explorer.views.residuals = residuals.checked;
      explorer.views.drawCycle();
    });
    explorer.views.measuredChanged = (measured) => {
      byId('fitting').hidden = measured === null;
      note.textContent = '';
      if (!measured && this.channel.busy) this.channel.stop('stopped');
    };
  }

  private async run() {
    const {explorer} = this,
      {state} = explorer,
      {measurement} = explorer.views,
      note = byId('fit-note');
    note.textContent = '';
    const limits = this.limits.read();
    if (!limits || !measurement) return;
    const {keys, lower, upper} = limits;
    byId('fit').textContent = 'stop';
    note.textContent = 'Computing.';
    let designs = 0;
    const outcome = await this.channel.ask(
      'fit',
      {
        stated: {text: state.design.text, changes: state.design.changes},
        keys,
        limits: {lower, upper},
        options: runOptions(state),
        measured: measurement,
      },
      ({values, deviation}: Fitted) => {
        const at = keys.map((key, n) => `${key} ${readable(values[n], this.limits.unitOf(key))}`);
        note.textContent = `Computing. Step ${designs++}: deviation ${percent(deviation)}, ${at.join(', ')}.`;
      },
    );
    byId('fit').textContent = 'fit';
    if (outcome.kind === 'refused') note.textContent = new Refused(outcome.problems).message;
    else if (outcome.kind === 'failed') note.textContent = `Not computed: ${outcome.why}.`;
    else if (outcome.kind === 'done') await this.take(state, keys, outcome.answer, {lower, upper});
  }

  /** The last design becomes the state of the page, in one step, unless that has changed meanwhile. */
  private async take(
    state: State,
    keys: string[],
    {path, solved, errors, converged}: FitResult,
    {lower, upper}: {lower: number[]; upper: number[]},
  ) {
    const {explorer} = this,
      first = path[0]!,
      last = path[path.length - 1]!;
    const said = keys.map((key, n) => {
      const value = last.values[n]!,
        error = errors[n];
      const unit = this.limits.unitOf(key);
      const limit = value <= lower[n]! * 1.000001 || value >= upper[n]! * 0.999999 ? ', at its limit' : '';
      const spread = error === null || error === undefined ? ' (the data do not fix it)' : ` ± ${percent(error)}`;
      return `${key} ${readable(first.values[n], unit)} to ${readable(value, unit)}${spread}${limit}`;
    });
    byId('fit-note').textContent =
      `${solved} designs were solved. Deviation ${percent(first.deviation)} to ${percent(last.deviation)} of the ` +
      `size of the quantities measured; ${said.join(', ')}.` +
      (converged ? '' : ' It ended before the deviation was least: fit again to go on.');
    document.body.dataset.fit = converged ? 'converged' : 'ended';
    if (explorer.state !== state) return;
    const changes = Object.fromEntries(keys.map((key, n) => [key, exact(Number(last.values[n]!.toPrecision(7)))]));
    await explorer.go({...state, design: explorer.changed(state.design, changes)});
  }
}

const percent = (share: number) => `${digits(100 * share, 3)} %`;

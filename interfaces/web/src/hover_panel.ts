// "Make it hover": which keys may change and within which limits, and the path to a design that lifts its weight.
import {Refused} from './core';
import {byId} from './dom';
import {Channel} from './engine';
import type {Explorer} from './explorer';
import type {Found, Tried} from './hover';
import {KeyLimits} from './limits';
import {drawPath} from './pictures/hover_path';
import {exact, readable} from './quantities';
import {describeDesign, type State} from './state';

const deadline = 60_000; // without a design accepted [ms]
const proposed = [['supply.voltage', 'supply.amplitude', 'supply.duty'], ['transmission.crank_radius']];

export class HoverPanel {
  private readonly channel: Channel;
  private readonly limits: KeyLimits;

  constructor(private readonly explorer: Explorer) {
    this.channel = new Channel(explorer.compiled, deadline, 0);
    byId('hover').addEventListener('click', () => {
      if (this.channel.busy) this.channel.stop('stopped');
      else void this.run();
    });
    this.limits = new KeyLimits(explorer, 'hover', proposed, (text) => (byId('hover-note').textContent = text));
  }

  private async run() {
    const {explorer} = this,
      {state} = explorer,
      note = byId('hover-note');
    note.textContent = '';
    const target = this.limits.number(byId<HTMLInputElement>('hover-target'), '1');
    const limits = this.limits.read();
    if (target === null || !limits) return;
    if (typeof explorer.values['vehicle.mass'] !== 'number') {
      note.textContent = 'The weight is not known: state vehicle.mass first.';
      return;
    }
    const {keys, lower, upper} = limits,
      path: Tried[] = [];
    byId('hover').textContent = 'stop';
    note.textContent = 'Computing.';
    const outcome = await this.channel.ask(
      'hover',
      {
        stated: {text: state.design.text, changes: state.design.changes},
        keys,
        limits: {lower, upper, target},
        options: {condition: state.condition},
      },
      (tried: Tried) => {
        path.push(tried);
        this.draw(state, keys, path, target);
      },
    );
    byId('hover').textContent = 'make it hover';
    if (outcome.kind === 'refused') note.textContent = new Refused(outcome.problems).message;
    else if (outcome.kind === 'failed') note.textContent = `Not computed: ${outcome.why}.`;
    else if (outcome.kind === 'done') await this.take(state, keys, outcome.answer, target);
  }

  private draw(state: State, keys: string[], path: Tried[], target: number) {
    const picture = document.querySelector<SVGSVGElement>('#hover-picture')!;
    picture.removeAttribute('hidden');
    drawPath(picture, describeDesign(state.design, state.condition, keys), path, target);
  }

  /** The last design of the path becomes the state of the page, in one step, unless that has changed meanwhile. */
  private async take(state: State, keys: string[], {path, tried, hovers}: Found, target: number) {
    const {explorer} = this,
      first = path[0]!,
      last = path[path.length - 1]!,
      unitOf = this.limits.unitOf;
    const changes = Object.fromEntries(keys.map((key, n) => [key, exact(Number(last.values[n]!.toPrecision(7)))]));
    const moves = keys.map(
      (key, n) => `${key} ${readable(first.values[n], unitOf(key))} to ${readable(last.values[n], unitOf(key))}`,
    );
    const lifts = `${readable(first.lift, '1')} to ${readable(last.lift, '1')}`,
      aim = `${tried + 1} designs were solved. Lift over weight ${lifts}, `;
    byId('hover-note').textContent =
      (hovers ? '' : `No design within these limits reaches ${target}. `) +
      `${aim}electrical power ${readable(first.power, 'W')} to ${readable(last.power, 'W')}; ${moves.join(', ')}.` +
      (last.inside ? '' : " The last design is outside the model's domain of validity.");
    document.body.dataset.hover = hovers ? 'reached' : 'not reached';
    if (explorer.state !== state) return;
    const design = explorer.changed(state.design, changes);
    await explorer.go({...state, design, hold: 'voltage', held: 0});
  }
}

// "Make it hover": which keys may change and within which limits, and the path to a design that lifts its weight.
import {sweepRange} from './controls';
import {Refused} from './core';
import {byId, html} from './dom';
import {Channel} from './engine';
import type {Explorer} from './explorer';
import type {Found, Tried} from './hover';
import {drawPath} from './pictures/hover_path';
import {exact, readable} from './quantities';
import {describeDesign, type State} from './state';

const deadline = 60_000, // without a design accepted [ms]
  mostKeys = 6;
/** Keys that are proposed, the first of each line that the vehicle has. */
const proposed = [['supply.voltage', 'supply.amplitude', 'supply.duty'], ['transmission.crank_radius']];

interface Row {
  key: string;
  low: HTMLInputElement;
  high: HTMLInputElement;
}

export class HoverPanel {
  private readonly channel: Channel;
  private rows: Row[] = [];
  private offered = '';

  constructor(private readonly explorer: Explorer) {
    this.channel = new Channel(explorer.compiled, deadline, 0);
    byId('hover').addEventListener('click', () => {
      if (this.channel.busy) this.channel.stop('stopped');
      else void this.run();
    });
    byId<HTMLSelectElement>('hover-add').addEventListener('change', (event) => {
      const select = event.currentTarget as HTMLSelectElement;
      if (select.value && this.rows.length < mostKeys) this.add(select.value);
      select.value = '';
    });
    explorer.watch(() => this.offer());
    this.offer();
  }

  private unitOf = (key: string) => this.explorer.core.tables.keys.find((k) => k.key === key)?.unit ?? '1';

  /** Positive numbers of the vehicle; another vehicle starts with the proposal. */
  private offer() {
    const {values, core, state} = this.explorer;
    const names = core.tables.keys.filter((k) => k.number && !k.whole && Number(values[k.key]) > 0).map((k) => k.key);
    const offered = state.design.text + names.join();
    if (offered === this.offered) return;
    this.offered = offered;
    byId('hover-add').replaceChildren(
      html('option', {value: ''}, 'add a key'),
      ...names.map((name) => html('option', {value: name}, name)),
    );
    this.rows = [];
    byId('hover-keys').replaceChildren();
    for (const choice of proposed) {
      const key = choice.find((name) => names.includes(name));
      if (key) this.add(key);
    }
  }

  private add(key: string) {
    const {core, values, typical} = this.explorer;
    const row = core.tables.keys.find((k) => k.key === key),
      value = Number(values[key]);
    if (!row || this.rows.some((r) => r.key === key)) return;
    const [low, high] = sweepRange(row, value, typical[key] ?? 0) ?? [value / 2, value * 2];
    const field = (name: string, number: number) =>
      html('input', {type: 'text', value: readable(number, row.unit ?? '1', 5), 'aria-label': `${key}, ${name}`});
    const limits = {key, low: field('lower limit', Math.max(low, value / 4)), high: field('upper limit', 2 * high)};
    if (row.upper !== null) limits.high.value = readable(Math.min(2 * high, row.upper), row.unit ?? '1', 5);
    this.rows.push(limits);
    const remove = html('button', {type: 'button', 'aria-label': `remove ${key}`}, 'remove');
    const line = html(
      'tr',
      {},
      html('th', {scope: 'row'}, key),
      ...[limits.low, limits.high, remove].map((e) => html('td', {}, e)),
    );
    remove.addEventListener('click', () => {
      this.rows = this.rows.filter((r) => r !== limits);
      line.remove();
      byId('hover-add').focus();
    });
    byId('hover-keys').append(line);
  }

  /** The number of a field, which is marked where it is none. */
  private number(field: HTMLInputElement, unit: string): number | null {
    let value: number | null = null;
    try {
      value = this.explorer.core.quantity(field.value.trim(), unit);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      byId('hover-note').textContent = `${field.getAttribute('aria-label')}: ${error.message}`;
    }
    if (value !== null && !(value > 0)) {
      byId('hover-note').textContent = `${field.getAttribute('aria-label')}: expected a number above 0`;
      value = null;
    }
    if (value === null) field.setAttribute('aria-invalid', 'true');
    else field.removeAttribute('aria-invalid');
    return value;
  }

  private async run() {
    const {explorer, rows} = this,
      {state} = explorer,
      note = byId('hover-note');
    note.textContent = '';
    const target = this.number(byId<HTMLInputElement>('hover-target'), '1');
    const lower = rows.map((row) => this.number(row.low, this.unitOf(row.key))),
      upper = rows.map((row) => this.number(row.high, this.unitOf(row.key)));
    if (target === null || [...lower, ...upper].includes(null)) return;
    if (rows.length === 0) return (note.textContent = 'Add a key that may change.');
    const crossed = rows.find((_, n) => lower[n]! >= upper[n]!);
    if (crossed) return (note.textContent = `${crossed.key}: the lower limit must be below the upper one.`);
    if (typeof explorer.values['vehicle.mass'] !== 'number') {
      return (note.textContent = 'The weight is not known: state vehicle.mass first.');
    }
    const keys = rows.map((row) => row.key),
      path: Tried[] = [];
    byId('hover').textContent = 'stop';
    note.textContent = 'Computing.';
    const outcome = await this.channel.ask(
      'hover',
      {
        stated: {text: state.design.text, changes: state.design.changes},
        keys,
        limits: {lower: lower as number[], upper: upper as number[], target},
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
      last = path[path.length - 1]!;
    const changes = Object.fromEntries(keys.map((key, n) => [key, exact(Number(last.values[n]!.toPrecision(7)))]));
    const moves = keys.map(
      (key, n) =>
        `${key} ${readable(first.values[n], this.unitOf(key))} to ${readable(last.values[n], this.unitOf(key))}`,
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

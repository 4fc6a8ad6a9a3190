// A table of keys with limits, for searches that may change them: keys are added from a list and taken out again.
import {sweepRange} from './controls';
import {Refused} from './core';
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {readable} from './quantities';

interface Row {
  key: string;
  low: HTMLInputElement;
  high: HTMLInputElement;
}
export interface Limited {
  keys: string[];
  lower: number[];
  upper: number[];
}

const mostKeys = 6;

export class KeyLimits {
  private rows: Row[] = [];
  private offered = '';

  /** `id`-keys is the table's body, `id`-add the list; of each line of `proposed` the first that the vehicle has. */
  constructor(
    private readonly explorer: Explorer,
    private readonly id: string,
    private readonly proposed: string[][],
    private readonly say: (text: string) => void,
  ) {
    byId<HTMLSelectElement>(`${id}-add`).addEventListener('change', (event) => {
      const select = event.currentTarget as HTMLSelectElement;
      if (select.value && this.rows.length < mostKeys) this.add(select.value);
      select.value = '';
    });
    explorer.watch(() => this.offer());
    this.offer();
  }

  unitOf = (key: string) => this.explorer.core.tables.keys.find((k) => k.key === key)?.unit ?? '1';

  /** Positive numbers of the vehicle; another vehicle starts with the proposal. */
  private offer() {
    const {values, core, state} = this.explorer;
    const names = core.tables.keys.filter((k) => k.number && !k.whole && Number(values[k.key]) > 0).map((k) => k.key);
    const offered = state.design.text + names.join();
    if (offered === this.offered) return;
    this.offered = offered;
    byId(`${this.id}-add`).replaceChildren(
      html('option', {value: ''}, 'add a key'),
      ...names.map((name) => html('option', {value: name}, name)),
    );
    this.rows = [];
    byId(`${this.id}-keys`).replaceChildren();
    for (const choice of this.proposed) {
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
      html('input', {
        type: 'text',
        value: readable(number, row.unit ?? '1', 5),
        'aria-label': `${key}, ${name}${this.id === 'hover' ? '' : ` of the ${this.id}`}`,
      });
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
      byId(`${this.id}-add`).focus();
    });
    byId(`${this.id}-keys`).append(line);
  }

  /** The positive number of a field, which is marked where it is none. */
  number(field: HTMLInputElement, unit: string): number | null {
    let value: number | null = null;
    try {
      value = this.explorer.core.quantity(field.value.trim(), unit);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.say(`${field.getAttribute('aria-label')}: ${error.message}`);
    }
    if (value !== null && !(value > 0)) {
      this.say(`${field.getAttribute('aria-label')}: expected a number above 0`);
      value = null;
    }
    if (value === null) field.setAttribute('aria-invalid', 'true');
    else field.removeAttribute('aria-invalid');
    return value;
  }

  /** Keys and limits, or null where something is missing or wrong, which is said. */
  read(): Limited | null {
    const {rows} = this;
    const lower = rows.map((row) => this.number(row.low, this.unitOf(row.key))),
      upper = rows.map((row) => this.number(row.high, this.unitOf(row.key)));
    if ([...lower, ...upper].includes(null)) return null;
    const crossed = rows.find((_, n) => lower[n]! >= upper[n]!);
    if (rows.length === 0) this.say('Add a key that may change.');
    else if (crossed) this.say(`${crossed.key}: the lower limit must be below the upper one.`);
    else return {keys: rows.map((row) => row.key), lower: lower as number[], upper: upper as number[]};
    return null;
  }
}

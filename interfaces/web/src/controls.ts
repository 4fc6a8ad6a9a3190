// A control for every key of the vehicle file, from the library's table: slider, value with unit, sensitivities.
import type {Key, Stated, Values} from './core';
import {html, setValue} from './dom';
import {exact, readable, shownUnit} from './quantities';

export interface Sensitivity {
  lift: number | null;
  power: number | null;
} // relative change per relative change

interface Row {
  /** What it shows, so that only what is new is written. */
  shown: string;
  /** A text that was refused stays in its field until another one is taken. */
  refused: boolean;
  /** While the pointer holds the slider it is where the pointer is. */
  held: boolean;
  key: Key;
  element: HTMLElement;
  slider: HTMLInputElement | null;
  field: HTMLInputElement | HTMLSelectElement;
  bars: HTMLElement | null;
  note: HTMLElement;
  range: {low: number; high: number; log: boolean} | null;
}
interface Events {
  /** A value as it stands in a vehicle file; false while the slider still moves. */
  change(key: string, value: string, final: boolean): void;
  reset(key: string): void;
}

const steps = 1000;
const typed = /^(name|file)$/;

/** The words of "none, viscous or constant". */
export const choicesOf = (key: Key) =>
  key.range === 'true or false'
    ? ['true', 'false']
    : key.range
        .split(/,| or /)
        .map((word) => word.trim().replaceAll('"', ''))
        .filter((word) => /^[a-z][a-z0-9-]*$/.test(word));

/** True where the choices made leave a place for the key: "friction.type = viscous|constant", "motor.gear_ratio". */
function hasPlace(key: Key, values: Values): boolean {
  if (!key.only_with) return true;
  const [path, allowed] = key.only_with.split(' = ');
  const value = values[path!];
  if (value === undefined || value === null) return false;
  return !allowed || allowed.split('|').some((word) => word.trim() === String(value));
}

function rangeOf(key: Key, base: number, elsewhere: number): Row['range'] {
  const size = Math.abs(base) || elsewhere;
  if (key.lower !== null && key.upper !== null) return {low: key.lower, high: key.upper, log: false};
  if (!(size > 0)) return null;
  if (key.lower === null) return {low: base - 2 * size, high: base + 2 * size, log: false};
  if (base <= 0) return {low: key.lower, high: 2 * size, log: false};
  if (key.whole) return {low: Math.max(key.lower, 1), high: Math.max(4 * base, 4), log: false};
  const low = base / 4,
    high = base * 4;
  return key.lower > low ? {low: key.lower, high, log: false} : {low, high, log: true};
}

export class Controls {
  private rows: Row[] = [];
  private layout = '';
  private text: string | null = null;

  /** `typical` is a size for keys that are 0 in the vehicle: the largest of the shipped vehicles. */
  constructor(
    private readonly parent: HTMLElement,
    private readonly keys: Key[],
    private readonly typical: Record<string, number>,
    private readonly events: Events,
  ) {}

  /** Moves the controls. False where keys come or go, so that they have to be built anew. */
  move(stated: Stated, values: Values): boolean {
    if (stated.text !== this.text || layoutOf(this.shownKeys(values), values) !== this.layout) return false;
    for (const row of this.rows) this.moveRow(row, values[row.key.key], row.key.key in stated.changes);
    return true;
  }

  /** Builds the controls anew. `base` are the values of the file itself. */
  build(stated: Stated, values: Values, base: Values) {
    const keys = this.shownKeys(values);
    const focused = this.parent.contains(document.activeElement) ? document.activeElement?.id : '';
    this.buildRows(keys, values, base);
    this.layout = layoutOf(keys, values);
    this.text = stated.text;
    if (focused) document.getElementById(focused)?.focus();
    this.move(stated, values);
  }

  private shownKeys(values: Values): Key[] {
    return this.keys.filter(
      (key) => hasPlace(key, values) && !(typed.test(key.key.split('.').pop() ?? '') && !key.number),
    );
  }

  sensitivities(found: Record<string, Sensitivity>) {
    let most = 0.01;
    for (const s of Object.values(found)) most = Math.max(most, Math.abs(s.lift ?? 0), Math.abs(s.power ?? 0));
    for (const row of this.rows) {
      if (!row.bars) continue;
      const s = found[row.key.key];
      const parts = (['lift', 'power'] as const).map((what) => {
        const x = s?.[what] ?? null;
        const size = x === null ? 0 : 50 * Math.min(1, Math.abs(x) / most);
        return html(
          'span',
          {class: `bar bar-${what}`},
          html('i', {style: `width:${size}%;${x !== null && x < 0 ? 'right' : 'left'}:50%`}),
        );
      });
      row.bars.replaceChildren(...parts);
      const said = (x: number | null) => {
        if (x === null) return 'none';
        return `${x >= 0 ? '+' : '−'}${Math.abs(x).toPrecision(2)} %`;
      };
      row.bars.title = s ? `1 % more: lift ${said(s.lift)}, electrical power ${said(s.power)}` : '';
      row.bars.setAttribute('aria-label', row.bars.title);
      row.bars.setAttribute('aria-hidden', String(!s)); // no picture where there are no sensitivities
    }
  }

  /** Marks the control of the key, which is brought to sight; false where there is none. */
  complain(key: string, message: string) {
    const row = this.rows.find((r) => r.key.key === key);
    if (!row) return false;
    row.refused = true;
    row.note.textContent = `${message}. In use: ${row.shown.trim() || 'none'}`;
    row.field.setAttribute('aria-invalid', 'true');
    row.field.setAttribute('aria-describedby', row.note.id);
    for (let e: Element | null = row.element; e && e !== this.parent; e = e.parentElement) {
      if (e instanceof HTMLDetailsElement) e.open = true;
    }
    row.element.scrollIntoView({block: 'nearest'});
    return true;
  }

  /** A value of the key has been taken. */
  accept(key: string) {
    const row = this.rows.find((r) => r.key.key === key);
    if (!row?.refused) return;
    row.refused = false;
    row.note.textContent = '';
    row.field.removeAttribute('aria-invalid');
    row.field.removeAttribute('aria-describedby');
    this.write(row);
  }
  acceptAll() {
    for (const row of this.rows) this.accept(row.key.key);
  }

  private buildRows(keys: Key[], values: Values, base: Values) {
    const open = new Set(
      Array.from(this.parent.querySelectorAll('details[open]'), (d) => (d as HTMLElement).dataset.section),
    );
    const first = this.rows.length === 0;
    this.rows = [];
    this.parent.replaceChildren();
    const sections = new Map<string, Key[]>();
    for (const key of keys) {
      const section = key.key.split('.')[0]!;
      sections.set(section, [...(sections.get(section) ?? []), key]);
    }
    for (const [section, members] of sections) {
      const stated = members.filter((key) => values[key.key] !== undefined);
      const others = members.filter((key) => values[key.key] === undefined);
      const body = html('div', {class: 'rows'}, ...stated.map((key) => this.build_row(key, values, base)));
      if (others.length) {
        body.append(
          html(
            'details',
            {class: 'others', 'data-section': `${section}+`, ...(open.has(`${section}+`) ? {open: true} : {})},
            html('summary', {}, others.length === 1 ? '1 optional key' : `${others.length} optional keys`),
            ...others.map((key) => this.build_row(key, values, base)),
          ),
        );
      }
      const isOpen = first ? ['supply', 'transmission', 'friction', 'spring'].includes(section) : open.has(section);
      this.parent.append(
        html(
          'details',
          {class: 'section', 'data-section': section, ...(isOpen ? {open: true} : {})},
          html('summary', {}, section),
          body,
        ),
      );
    }
  }

  private build_row(key: Key, values: Values, base: Values): HTMLElement {
    const name = key.key.slice(key.key.indexOf('.') + 1),
      id = `key-${key.key.replaceAll('.', '-')}`;
    const note = html('p', {class: 'complaint', role: 'alert', id: `${id}-note`});
    const meaning = `${key.meaning}${key.unit && key.unit !== '1' ? ` [${shownUnit(key.unit)}]` : ''}, ${key.range}`;
    const label = html('label', {for: id, title: meaning}, name.replaceAll('_', ' '));
    const reset = html(
      'button',
      {
        type: 'button',
        class: 'reset',
        title: `${key.key} as in the file`,
        'aria-label': `${key.key} as in the file`,
        click: () => {
          this.events.reset(key.key);
          document.getElementById(id)?.focus();
        },
      },
      '↺',
    );
    const element = html('div', {class: 'row', 'data-key': key.key}, label, reset);
    let slider: HTMLInputElement | null = null,
      bars: HTMLElement | null = null,
      range: Row['range'] = null;
    let field: HTMLInputElement | HTMLSelectElement;
    const choices = key.number ? [] : choicesOf(key);
    if (choices.length) {
      field = html(
        'select',
        {id, change: () => this.events.change(key.key, field.value, true)},
        ...(values[key.key] === undefined ? [html('option', {value: ''}, 'not stated')] : []),
        ...choices.map((word) => html('option', {value: word}, word)),
      );
    } else {
      field = html('input', {
        id,
        type: 'text',
        spellcheck: 'false',
        autocomplete: 'off',
        placeholder: key.quantity ?? key.range,
        change: () => {
          if (field.value.trim()) this.events.change(key.key, field.value.trim(), true);
          else this.accept(key.key);
        },
        keydown: (event) => {
          if ((event as KeyboardEvent).key !== 'Escape') return;
          this.accept(key.key);
          const row = this.rows.find((r) => r.key === key);
          if (row) this.write(row);
        },
      });
    }
    field.title = meaning;
    element.append(field);
    const number = base[key.key] ?? values[key.key];
    if (key.number && typeof number === 'number') {
      range = rangeOf(key, number, this.typical[key.key] ?? 0);
      if (range) {
        const found = range;
        slider = html('input', {
          type: 'range',
          id: `${id}-slider`,
          min: 0,
          max: steps,
          step: 1,
          'aria-label': `${key.key}, slider`,
          title: meaning,
        });
        const moved = (final: boolean) => () => {
          const row = this.rows.find((r) => r.key === key);
          if (row) row.held = !final;
          this.events.change(key.key, exact(valueAt(found, Number(slider!.value), key.whole)), final);
        };
        slider.addEventListener('input', moved(false));
        slider.addEventListener('change', moved(true));
        bars = html('span', {class: 'bars', role: 'img', 'aria-label': 'sensitivities'});
        element.append(slider, bars);
      }
    }
    element.append(note, html('p', {class: 'meaning', id: `${id}-meaning`}, meaning));
    this.rows.push({key, element, slider, field, bars, note, range, shown: '', refused: false, held: false});
    return element;
  }

  private moveRow(row: Row, value: Values[string] | undefined, changed: boolean) {
    const text =
      typeof value === 'number'
        ? readable(value, row.key.unit ?? '', 5)
        : value === undefined || value === null
          ? ''
          : String(value);
    row.shown = text;
    row.element.classList.toggle('changed', changed);
    if (!row.refused) this.write(row);
    if (row.slider && row.range && typeof value === 'number' && !row.held) {
      const place = String(placeOf(row.range, value));
      setValue(row.slider, place);
    }
    if (row.slider?.getAttribute('aria-valuetext') !== text) row.slider?.setAttribute('aria-valuetext', text);
  }

  private write({field, shown}: Row) {
    setValue(field, shown);
  }
}

const layoutOf = (keys: Key[], values: Values) =>
  keys.map((k) => `${k.key}${values[k.key] === undefined ? '-' : '+'}`).join();

function valueAt(range: NonNullable<Row['range']>, place: number, whole: boolean): number {
  const share = place / steps;
  const value = range.log
    ? range.low * (range.high / range.low) ** share
    : range.low + share * (range.high - range.low);
  return whole ? Math.round(value) : Number(value.toPrecision(5));
}

function placeOf(range: NonNullable<Row['range']>, value: number): number {
  const share = range.log
    ? Math.log(value / range.low) / Math.log(range.high / range.low)
    : (value - range.low) / (range.high - range.low);
  return Math.round(steps * Math.min(1, Math.max(0, share)));
}

/** The interval a slider of the key covers, for trends and maps. */
export function sweepRange(key: Key, value: number, typical: number): [number, number] | null {
  const range = rangeOf(key, value, typical);
  if (!range) return null;
  return [
    range.low > 0 ? Math.max(range.low, value / 2) : range.low,
    Math.min(range.high, value > 0 ? value * 2 : range.high),
  ];
}

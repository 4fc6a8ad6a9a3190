// What the page shows: a vehicle with changed values, pinned ones to compare with, the conditions. A state is never
// changed; another one takes its place, and the history keeps them.
import type {RunOptions, Stated} from './core';

export interface Design extends Stated {
  readonly name: string;
}
export type Hold = 'voltage' | 'frequency' | 'lift';
export const conditions = ['air', 'vacuum', 'wingless'] as const;
export interface State {
  readonly design: Design;
  readonly pins: readonly Design[];
  readonly condition: (typeof conditions)[number];
  readonly hold: Hold;
  readonly held: number; // [Hz] or [N]
}
export const heldUnit = {frequency: 'Hz', lift: 'N'} as const;
export const maxPins = 4;

export const stateFor = (design: Design): State => ({design, pins: [], condition: 'air', hold: 'voltage', held: 0});

export function runOptions(state: State): RunOptions {
  const options: RunOptions = {condition: state.condition};
  if (state.hold === 'frequency') options.frequency = state.held;
  if (state.hold === 'lift') options.lift = state.held;
  return options;
}

/** Equal for designs that are computed alike under the same options. */
export const identityOf = (design: Design, options: RunOptions) =>
  JSON.stringify([design.text, Object.entries(design.changes).sort(), options]);

/** "friction2022, supply.voltage 2.5 V, vacuum": what a picture is of. */
export function describeDesign(design: Design, condition = 'air', without: readonly string[] = []): string {
  const changes = Object.entries(design.changes).filter(([key]) => !without.includes(key));
  return [
    design.name,
    ...changes.slice(0, 4).map(([key, value]) => `${key} ${value}`),
    ...(changes.length > 4 ? [`${changes.length - 4} more changes`] : []),
    ...(condition === 'air' ? [] : [condition]),
  ].join(', ');
}

/** States in the order in which they were left; those undone can be redone until another one is committed. */
export class History<S> {
  private entries: {state: S; tag: string; time: number}[];
  private index = 0;

  constructor(
    first: S,
    private readonly longest = 500,
    private readonly together = 1000, // [ms]
  ) {
    this.entries = [{state: first, tag: '', time: -Infinity}];
  }

  get present(): S {
    return this.entries[this.index]!.state;
  }
  get canUndo() {
    return this.index > 0;
  }
  get canRedo() {
    return this.index + 1 < this.entries.length;
  }

  /** True for a new step; changes with the same tag in quick succession, such as presses of an arrow key, are one. */
  commit(state: S, tag = '', time = Date.now()): boolean {
    const last = this.entries[this.index]!;
    if (state === last.state) return false;
    this.entries.length = this.index + 1;
    if (tag && tag === last.tag && time - last.time < this.together) {
      this.entries[this.index] = {state, tag, time};
      return false;
    }
    this.entries.push({state, tag, time});
    if (this.entries.length > this.longest) this.entries.shift();
    this.index = this.entries.length - 1;
    return true;
  }

  undo(): S {
    if (this.canUndo) --this.index;
    return this.present;
  }
  redo(): S {
    if (this.canRedo) ++this.index;
    return this.present;
  }

  /** Goes to the entry of the state, or commits it. */
  visit(state: S) {
    const found = this.entries.findIndex((entry) => entry.state === state);
    if (found >= 0) this.index = found;
    else this.commit(state);
  }

  /** Takes out a state that turned out to be impossible. */
  remove(state: S) {
    const found = this.entries.findIndex((entry) => entry.state === state);
    if (found < 0 || this.entries.length === 1) return;
    this.entries.splice(found, 1);
    if (this.index >= found) this.index = Math.max(0, this.index - 1);
  }
}

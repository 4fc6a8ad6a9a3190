// What the paper of 2022 reports, beside the model: values of the two vehicles at 3 V or at 22 Hz.
import type {Explorer} from './explorer';
import {numberOf} from './results';
import type {State} from './state';
import {isShipped, shipped} from './vehicles';

export interface Published {
  metric: string;
  design: string;
  /** The design that it is compared with, where it is a ratio or a change. */
  against: string | null;
  voltage: string | null;
  frequency: string | null;
  value: string;
  change: boolean;
  where: string;
  basis: string;
}
declare const __PUBLISHED__: Published[]; // vite.config.js
export const published = __PUBLISHED__;

/** True where the state holds what the value was published for. */
function sameCondition(value: Published, state: State, volts: number | undefined): boolean {
  if (state.condition !== 'air') return false;
  if (value.frequency !== null)
    return state.hold === 'frequency' && Math.abs(state.held - Number.parseFloat(value.frequency)) < 1e-9;
  return state.hold === 'voltage' && volts !== undefined && Math.abs(volts - Number.parseFloat(value.voltage!)) < 1e-9;
}

const unchanged = ({name, text, changes}: State['design']) =>
  isShipped(name) && shipped[name] === text && Object.keys(changes).length === 0;

/** Values of the paper for the state as it stands, with the model's: of the design itself, or against the first pin. */
export function beside({shown}: Explorer): {value: Published; model: number | null}[] {
  if (!shown || !unchanged(shown.state.design)) return [];
  const {state, solved, pins} = shown,
    volts = shown.values['supply.voltage'],
    other = state.pins[0];
  return published
    .filter((value) => value.design === state.design.name)
    .filter((value) => sameCondition(value, state, typeof volts === 'number' ? volts : undefined))
    .filter((value) => value.against === null || (other && other.name === value.against && unchanged(other)))
    .map((value) => {
      const here = numberOf(solved.report, value.metric),
        there = value.against === null ? null : numberOf(pins[0]?.solved.report, value.metric);
      if (here === null) return {value, model: null};
      if (value.against === null) return {value, model: here};
      return {value, model: there ? here / there - (value.change ? 1 : 0) : null};
    });
}

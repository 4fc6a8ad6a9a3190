// The 2022 paper in six steps: each sets the page to a state and says what to look at, with the numbers of the moment.
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {readable} from './quantities';
import {numberOf} from './results';
import {type Design, type State, stateFor} from './state';
import {shippedDesign} from './vehicles';

interface Step {
  title: string;
  design: () => Design;
  pinned?: () => Design;
  hold?: number;
  text: (e: Explorer) => string[];
}

const paper = () => shippedDesign('friction2022');
/** Without friction the formulation of the paper leaves the domain of validity. */
const conserving = {'transmission.formulation': 'virtual-work'};
const springs = () => shippedDesign('friction2022-springs');
const changed = (design: Design, changes: Record<string, string>): Design => ({...design, changes});

const number = (e: Explorer, key: string) => numberOf(e.shown?.solved.report, key) as number;
const pinned = (e: Explorer, key: string) => numberOf(e.shown?.pins[0]?.solved.report, key) as number;
const shown = (e: Explorer, key: string, unit: string, of = number) => readable(of(e, key), unit);
const percent = (x: number) => `${(100 * x).toPrecision(3)} %`;
const change = (e: Explorer, key: string) => {
  const share = number(e, key) / pinned(e, key) - 1;
  return `${percent(Math.abs(share))} ${share < 0 ? 'less' : 'more'}`;
};

const steps: Step[] = [
  {
    title: 'A motor flaps two wings',
    design: paper,
    text: (e) => [
      'A DC motor turns a crank; a rod moves a slider, and the slider swings both wings. This is the vehicle ' +
        'of the paper "Should friction losses be included in an electromechanical model of a bioinspired ' +
        'flapping-wing micro aerial vehicle to estimate the flight energetic requirements?" (2022), at 3 V.',
      `It flaps at ${shown(e, 'frequency_hz', 'Hz')} and lifts ${shown(e, 'lift_mean_n', 'N')} from ` +
        `${shown(e, 'power_electrical_w', 'W')}. Drag across a plot to move through the cycle.`,
    ],
  },
  {
    title: 'Friction follows the force',
    design: paper,
    text: (e) => [
      'Wings that are turned round at the ends of the stroke pull on the rod, and the friction of the ' +
        'transmission grows with that force. Watch rod and crank pin glow where the rod force peaks.',
      `The rod carries up to ${shown(e, 'rod_force_peak_n', 'N')}; friction takes ` +
        `${percent(number(e, 'power_friction_w') / number(e, 'power_electrical_w'))} of the input.`,
    ],
  },
  {
    title: 'Without friction',
    design: () => changed(paper(), {...conserving, 'friction.type': 'none'}),
    pinned: () => changed(paper(), conserving),
    text: (e) => [
      'The same vehicle with no friction in the transmission; the one with friction is pinned as A and drawn ' +
        'faintly. Both use the formulation virtual-work: with rod-force, that of the paper, the vehicle without ' +
        'friction is outside the domain of validity, because more than 5 % of its input power is not conserved.',
      `A model that leaves friction out promises ${change(e, 'lift_mean_n')} lift and ` +
        `${change(e, 'frequency_hz')} frequency at the same voltage: ${shown(e, 'lift_mean_n', 'N')} instead ` +
        `of ${shown(e, 'lift_mean_n', 'N', pinned)}.`,
    ],
  },
  {
    title: 'What springs do',
    design: springs,
    pinned: paper,
    text: (e) => [
      'Springs in the wing hinges turn the wings round in place of the rod. A is the vehicle without them, ' +
        'both at 3 V.',
      `The mean rod force is ${change(e, 'rod_force_mean_n')}, and so is friction's hold: ` +
        `${change(e, 'lift_mean_n')} lift at the same voltage.`,
    ],
  },
  {
    title: 'Springs at the same frequency',
    design: springs,
    pinned: paper,
    hold: 22,
    text: (e) => [
      'Both at 22 Hz, as in the paper; the voltage of each is the one at which it flaps at that frequency.',
      `With springs the motor draws ${change(e, 'power_electrical_w')} power in this model: ` +
        `${shown(e, 'power_electrical_w', 'W')} instead of ${shown(e, 'power_electrical_w', 'W', pinned)}. The ` +
        `paper reports about 18 % less. The difference is friction, which follows the rod force.`,
    ],
  },
  {
    title: 'Does it hover?',
    design: springs,
    text: (e) => [
      `Lift over weight is ${shown(e, 'lift_to_weight', '1')} here: below 1 the vehicle cannot hover. Move ` +
        `the supply voltage, and read from the bars which key matters most; a map of voltage and crank radius ` +
        `outlines where it would carry itself.`,
      'Every number on this page is the program\'s own; "The same elsewhere" says how to get it there.',
    ],
  },
];

/** No step leaves the domain of validity without a word. */
function outside(e: Explorer): string[] {
  const {domain, domain_detail} = e.shown!.solved.report;
  return domain && domain !== 'inside'
    ? [`This design is outside the model's domain of validity: ${domain_detail}.`]
    : [];
}

export class Tour {
  private step = 0;
  constructor(private readonly explorer: Explorer) {
    byId('tour').addEventListener('click', () => void this.show(0));
  }

  private async show(step: number) {
    this.step = step;
    const {explorer} = this,
      {design, pinned: other, hold, title, text} = steps[step]!;
    const state: State = {
      ...stateFor(design()),
      pins: other ? [other()] : [],
      ...(hold ? {hold: 'frequency', held: hold} : {}),
    };
    if (!(await explorer.go(state)) || this.step !== step) return;
    const panel = byId('tour-panel');
    const go = (label: string, to: number, disabled = false) =>
      html('button', {type: 'button', disabled, click: () => void this.show(to)}, label);
    panel.hidden = false;
    panel.replaceChildren(
      html('h2', {tabindex: -1}, `${step + 1} of ${steps.length}: ${title}`),
      ...[...text(explorer), ...outside(explorer)].map((t) => html('p', {}, t)),
      html(
        'div',
        {class: 'bar-row'},
        go('back', step - 1, step === 0),
        go('next', step + 1, step === steps.length - 1),
        html(
          'button',
          {
            type: 'button',
            click: () => {
              panel.hidden = true;
              byId('tour').focus();
            },
          },
          'leave the tour',
        ),
      ),
    );
    panel.querySelector('h2')?.focus();
    document.body.dataset.tour = String(this.step + 1);
  }
}

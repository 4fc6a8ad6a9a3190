// The 2022 paper in six steps: each sets the page to a state and says what to look at, with the numbers of the moment.
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {readable} from './quantities';
import {numberOf} from './results';
import {type Design, initialState, shippedDesign} from './state';

interface Step {
  title: string;
  design: () => Design;
  pinned?: () => Design;
  hold?: number;
  text: (e: Explorer) => string[];
}

const paper = () => shippedDesign('friction2022');
const springs = () => shippedDesign('friction2022-springs');
const changed = (design: Design, changes: Record<string, string>): Design => ({...design, changes});

const number = (e: Explorer, key: string) => numberOf(e.current.solved.report, key) as number;
const pinned = (e: Explorer, key: string) => numberOf(e.pinnedReport(), key) as number;
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
    design: () => changed(paper(), {'friction.type': 'none'}),
    pinned: paper,
    text: (e) => [
      'The same vehicle with no friction in the transmission; the one with friction is pinned as A and drawn faintly.',
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
      'Compared as the paper does, at 22 Hz: the voltage of both is now whatever holds that frequency.',
      `With springs the motor draws ${change(e, 'power_electrical_w')} power: ` +
        `${shown(e, 'power_electrical_w', 'W')} instead of ${shown(e, 'power_electrical_w', 'W', pinned)}. It ` +
        `is the friction, not the wings\' inertia itself, that costs the difference.`,
    ],
  },
  {
    title: 'Does it hover?',
    design: springs,
    text: (e) => [
      `Lift over weight is ${shown(e, 'lift_to_weight', '1')} here: below 1 the vehicle cannot hover. Move ` +
        `the supply voltage, and read from the bars which knob matters most; a map of voltage and crank radius ` +
        `outlines where it would carry itself.`,
      'Every number on this page is the program\'s own; "The same elsewhere" says how to get it there.',
    ],
  },
];

export class Tour {
  private step = 0;
  constructor(private readonly explorer: Explorer) {
    byId('tour').addEventListener('click', () => this.show(0));
  }

  private show(step: number) {
    this.step = step;
    const {design, pinned: other, hold, title, text} = steps[step];
    this.explorer.open({
      ...initialState(),
      design: design(),
      pinned: other?.() ?? null,
      ...(hold ? {hold: 'frequency' as const, held: hold} : {}),
    });
    this.explorer.refreshTools();
    const panel = byId('tour-panel');
    const go = (label: string, to: number, disabled = false) =>
      html('button', {type: 'button', disabled, click: () => this.show(to)}, label);
    panel.hidden = false;
    panel.replaceChildren(
      html('h2', {tabindex: -1}, `${step + 1} of ${steps.length}: ${title}`),
      ...text(this.explorer).map((t) => html('p', {}, t)),
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

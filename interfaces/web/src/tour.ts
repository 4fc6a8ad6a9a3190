// The 2022 paper in six questions: each shows a vehicle and asks; the answer changes it, with the numbers of the moment
// and those of the paper.
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {paperTable} from './paper_table';
import {readable} from './quantities';
import {numberOf} from './results';
import {type Design, type State, stateFor} from './state';
import {shippedDesign} from './vehicles';

interface Scene {
  design: () => Design;
  pinned?: () => Design;
  hold?: number; // [Hz]
}
interface Question {
  question: string;
  before: Scene;
  about: string;
  choices: string[];
  /** The right one by the numbers of the moment. */
  right: (e: Explorer) => number;
  after: Scene;
  answer: (e: Explorer) => string[];
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
const share = (e: Explorer, key: string) => number(e, key) / number(e, 'power_electrical_w');
/** Which of rising intervals a number is in. */
const interval = (x: number, ...ends: number[]) => ends.filter((end) => x > end).length;

const questions: Question[] = [
  {
    question: 'How much of the electrical power reaches the air?',
    before: {design: paper},
    about:
      'A DC motor turns a crank; a rod moves a slider, and the slider swings both wings. This is the vehicle of the ' +
      'paper "Should friction losses be included in an electromechanical model of a bioinspired flapping-wing micro ' +
      'aerial vehicle to estimate the flight energetic requirements?" (2022), at 3 V.',
    choices: ['less than a tenth', 'a tenth to a third', 'more than a third'],
    right: (e) => interval(number(e, 'efficiency_system'), 0.1, 1 / 3),
    after: {design: paper},
    answer: (e) => [
      `${percent(number(e, 'efficiency_system'))}: the system efficiency. It flaps at ` +
        `${shown(e, 'frequency_hz', 'Hz')} and lifts ${shown(e, 'lift_mean_n', 'N')} from ` +
        `${shown(e, 'power_electrical_w', 'W')}. "Where the power goes" shows the rest; its marks move with the ` +
        'power of each instant.',
    ],
  },
  {
    question: 'What does friction in the transmission take?',
    before: {design: paper},
    about:
      'Wings that are turned round at the ends of the stroke pull on the rod, and the friction of the transmission ' +
      'grows with that force. Watch rod and crank pin glow where the rod force peaks.',
    choices: ['less than a tenth of the input', 'a tenth to a third', 'more than a third'],
    right: (e) => interval(share(e, 'power_friction_w'), 0.1, 1 / 3),
    after: {design: paper},
    answer: (e) => [
      `The rod carries up to ${shown(e, 'rod_force_peak_n', 'N')}; friction takes ` +
        `${percent(share(e, 'power_friction_w'))} of the input.`,
    ],
  },
  {
    question: 'What would a model without friction promise?',
    before: {design: () => changed(paper(), conserving)},
    about:
      'The next step takes the friction out of the transmission. Both vehicles use the formulation virtual-work: ' +
      'with rod-force, that of the paper, the vehicle without friction is outside the domain of validity, because more ' +
      'than 5 % of its input power is not conserved.',
    choices: ['about the same lift', 'up to a third more lift', 'more than a third more lift'],
    right: (e) => interval(number(e, 'lift_mean_n') / pinned(e, 'lift_mean_n'), 1.05, 4 / 3),
    after: {
      design: () => changed(paper(), {...conserving, 'friction.type': 'none'}),
      pinned: () => changed(paper(), conserving),
    },
    answer: (e) => [
      `A model that leaves friction out promises ${change(e, 'lift_mean_n')} lift and ` +
        `${change(e, 'frequency_hz')} frequency at the same voltage: ${shown(e, 'lift_mean_n', 'N')} instead ` +
        `of ${shown(e, 'lift_mean_n', 'N', pinned)}. The vehicle with friction is pinned as A and drawn faintly.`,
    ],
  },
  {
    question: 'What do springs in the wing hinges do to the lift?',
    before: {design: paper},
    about:
      'Springs in the wing hinges turn the wings round in place of the rod. They neither add nor take mean power. ' +
      'The voltage stays 3 V.',
    choices: ['less lift', 'about the same', 'more lift'],
    right: (e) => interval(number(e, 'lift_mean_n') / pinned(e, 'lift_mean_n'), 0.97, 1.03),
    after: {design: springs, pinned: paper},
    answer: (e) => [
      `The mean rod force is ${change(e, 'rod_force_mean_n')}, and so is friction's hold: ` +
        `${change(e, 'lift_mean_n')} lift at the same voltage. A is the vehicle without springs.`,
    ],
  },
  {
    question: 'And at the same frequency: do springs save power?',
    before: {design: paper, hold: 22},
    about: 'Both vehicles flap at 22 Hz, as in the paper; the voltage of each is the one at which it does so.',
    choices: ['no', 'yes, up to a tenth', 'yes, more than a tenth'],
    right: (e) => interval(1 - number(e, 'power_electrical_w') / pinned(e, 'power_electrical_w'), 0, 0.1),
    after: {design: springs, pinned: paper, hold: 22},
    answer: (e) => [
      `With springs the motor draws ${change(e, 'power_electrical_w')} power in this model: ` +
        `${shown(e, 'power_electrical_w', 'W')} instead of ${shown(e, 'power_electrical_w', 'W', pinned)}. The ` +
        `paper reports about 18 % less. The difference is friction, which follows the rod force.`,
    ],
  },
  {
    question: 'Does it hover?',
    before: {design: springs},
    about: 'The vehicle with springs at 3 V weighs 3.34 g. "In flight" shows it in three dimensions.',
    choices: ['it falls', 'it hovers', 'it climbs'],
    right: (e) => interval(number(e, 'lift_to_weight'), 0.98, 1.02),
    after: {design: springs},
    answer: (e) => [
      `Lift over weight is ${shown(e, 'lift_to_weight', '1')} here: below 1 the vehicle cannot hover. Move ` +
        `the supply voltage, and read from the bars which key matters most; "Make it hover" finds the design that ` +
        `does with the least power.`,
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

const stateOf = ({design, pinned: other, hold}: Scene): State => ({
  ...stateFor(design()),
  pins: other ? [other()] : [],
  ...(hold ? {hold: 'frequency', held: hold} : {}),
});

export class Tour {
  private step = 0;
  private right = new Set<number>();

  constructor(private readonly explorer: Explorer) {
    byId('tour').addEventListener('click', () => {
      this.right.clear();
      void this.ask(0);
    });
  }

  private async ask(step: number) {
    this.step = step;
    const {question, before, about, choices} = questions[step]!;
    if (!(await this.explorer.go(stateOf(before))) || this.step !== step) return;
    const options = choices.map((choice, n) =>
      html('button', {type: 'button', class: 'choice', click: () => void this.answer(step, n)}, choice),
    );
    this.show(
      html('p', {}, about),
      html('div', {class: 'bar-row choices', role: 'group', 'aria-label': question}, ...options),
      html(
        'p',
        {class: 'legend'},
        html('button', {type: 'button', click: () => void this.answer(step, null)}, 'show the answer'),
      ),
    );
    document.body.dataset.tour = String(step + 1);
    delete document.body.dataset.answered;
  }

  /** `chosen` is null where the answer is only shown. */
  private async answer(step: number, chosen: number | null) {
    const {after, choices, right, answer} = questions[step]!,
      {explorer} = this;
    if (!(await explorer.go(stateOf(after))) || this.step !== step) return;
    const correct = right(explorer);
    if (chosen === correct) this.right.add(step);
    const said =
      chosen === null
        ? `${capital(choices[correct]!)}.`
        : chosen === correct
          ? `Right: ${choices[correct]}.`
          : `Not ${choices[chosen]}, but: ${choices[correct]}.`;
    const table = paperTable(explorer);
    const last = step === questions.length - 1;
    this.show(
      html('p', {class: 'said', role: 'status'}, html('strong', {}, said)),
      ...[...answer(explorer), ...outside(explorer)].map((text) => html('p', {}, text)),
      ...(table ? [table] : []),
      ...(last ? [html('p', {}, `${this.right.size} of ${questions.length} answered at once.`)] : []),
    );
    document.body.dataset.answered = String(step + 1);
  }

  private show(...content: Node[]) {
    const panel = byId('tour-panel'),
      {step} = this;
    const go = (label: string, to: number, disabled: boolean) =>
      html('button', {type: 'button', disabled, click: () => void this.ask(to)}, label);
    const leave = () => {
      panel.hidden = true;
      byId('tour').focus();
    };
    panel.hidden = false;
    panel.replaceChildren(
      html('h2', {tabindex: -1}, `${step + 1} of ${questions.length}: ${questions[step]!.question}`),
      ...content,
      html(
        'div',
        {class: 'bar-row'},
        go('back', step - 1, step === 0),
        go('next', step + 1, step === questions.length - 1),
        html('button', {type: 'button', click: leave}, 'leave the tour'),
      ),
    );
    panel.querySelector('h2')?.focus();
  }
}

const capital = (text: string) => text[0]!.toUpperCase() + text.slice(1);

// Words of the page: a list to search, and the meaning of each name where it is tapped.
import type {Tables} from './core';
import {byId, html} from './dom';
import {shownUnit} from './quantities';

interface Term {
  name: string;
  meaning: string;
}

/** Words that are neither a key nor a result. */
const words: Record<string, string> = {
  'added mass': 'air that is accelerated with the wings. It takes no mean power.',
  'angle of attack': 'between the chord of the wing and its velocity through the air; at 90° the wing is square to it.',
  'angle of attack law': 'the angle of attack falls in proportion to the flapping velocity, by the pitch coefficient.',
  'coupler force': 'force in the coupler of a four-bar, as the rod force in a slider-crank.',
  crank: 'arm on the motor shaft or behind its gearbox, whose pin drives rod or coupler.',
  'copper loss': 'heat that the current makes in the winding of the motor.',
  cycle: 'one revolution of the crank, or one period of the supply of a direct drive; one flap forth and back.',
  'direct drive': 'the shaft of the motor is the hinge of the wing; a sine voltage swings it.',
  'domain of validity':
    'limits within which the model describes a real vehicle, such as those of angle of attack, stroke and Reynolds ' +
    'number. Nothing outside is reported as an optimum.',
  'energy-balance error': 'electrical input minus all losses and the power into the air: what the numerics leave.',
  formulation:
    'how the rod’s force acts on crank and wing: rod-force, that of the paper, or virtual-work, which conserves power.',
  'formulation residual': 'mean power that the formulation rod-force does not conserve; 0 for virtual-work.',
  'four-bar': 'mechanism of crank, coupler, rocker and ground; the rocker turns the wing.',
  hinge: 'joint about which a wing flaps; a pitch hinge is the one about which it pitches.',
  hovering: 'the mean lift equals the weight.',
  jammed: 'friction holds the mechanism whatever the torque, because it grows with the force.',
  'lift over weight': 'mean lift of all wings over the weight of the vehicle: 1 hovers.',
  locked: 'the crank stops where the torque of the motor is below what friction can hold.',
  'load-proportional friction': 'friction of the transmission that grows with the rod force; radius is its lever.',
  orbit: 'the steady motion, which repeats itself cycle by cycle.',
  'pitch hinge': 'hinge with a spring about which a wing pitches under air and inertia.',
  planform: 'outline of the wing. Its chord moments S₂ and S₃ carry lift and aerodynamic moment.',
  'reactive power': 'power that swings between motor, wings and springs without being lost.',
  residual: 'what is measured minus what the model has there.',
  resonance: 'frequency at which wings and hinge springs swing by themselves.',
  'rod force': 'force along the rod between crank pin and slider (the paper’s crank reaction force).',
  sensitivity: 'by how many per cent a result changes for one per cent of a key.',
  'slider-crank': 'mechanism of crank, rod and a slider, which swings both wings about their hinges.',
  spring: 'in the hinges of the wings; it turns the wings round in place of the rod.',
  stalled: 'the motor does not turn the crank from rest.',
  'stroke angle': 'angle of the wing about its hinge, 0 in the middle.',
  'stroke amplitude': 'half of the stroke from end to end.',
};

export function termsOf(tables: Tables): Term[] {
  const unit = (u: string | null) => (u && u !== '1' ? ` [${shownUnit(u)}]` : '');
  const all = [
    ...Object.entries(words).map(([name, meaning]) => ({name, meaning})),
    ...tables.metrics.map((m) => ({name: m.key, meaning: `${m.meaning}${unit(m.unit)}`})),
    ...tables.keys.map((k) => ({name: k.key, meaning: `${k.meaning}${unit(k.unit)}, ${k.range}`})),
  ];
  return all.sort((a, b) => a.name.localeCompare(b.name, 'en'));
}

/** Names of the page that are words of the list. */
const asWord: Record<string, string> = {
  'lift / weight': 'lift over weight',
  friction: 'load-proportional friction',
  'rod force': 'rod force',
  'coupler force': 'coupler force',
};

export class Glossary {
  private readonly terms: Term[];
  private readonly dialog = byId<HTMLDialogElement>('glossary-dialog');
  private readonly meaning = byId('meaning');

  constructor(tables: Tables) {
    this.terms = termsOf(tables);
    const search = byId<HTMLInputElement>('glossary-search');
    search.addEventListener('input', () => this.list(search.value));
    byId('glossary').addEventListener('click', () => {
      search.value = '';
      this.list('');
      this.dialog.showModal();
      search.focus();
    });
    for (const button of document.querySelectorAll('dialog [data-close]')) {
      button.addEventListener('click', () => button.closest('dialog')!.close());
    }
    document.addEventListener('click', (event) => this.tapped(event));
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') this.meaning.hidden = true;
    });
    document.addEventListener('scroll', () => (this.meaning.hidden = true), {passive: true});
  }

  private list(wanted: string) {
    const found = this.terms.filter(({name, meaning}) =>
      `${name} ${meaning}`.toLowerCase().includes(wanted.trim().toLowerCase()),
    );
    byId('glossary-terms').replaceChildren(
      ...(found.length
        ? found.flatMap(({name, meaning}) => [html('dt', {}, name), html('dd', {}, meaning)])
        : [html('dd', {}, `Nothing here has "${wanted}" in it.`)]),
    );
  }

  /** The meaning of a name that was tapped: of a key, of a result, or of a word of the list. */
  meaningOf(element: Element): Term | null {
    const key = element.closest('label[for^="key-"]')?.closest<HTMLElement>('[data-key]')?.dataset.key;
    const metric =
      element.closest('#metrics th[title]')?.getAttribute('title') ??
      element.closest('#headline dl > div')?.querySelector('dd[id^="value-"]')?.id.slice('value-'.length);
    const text = element.closest('th, b, dt, summary, strong')?.textContent?.trim().toLowerCase() ?? '';
    const name = key ?? metric ?? asWord[text] ?? text;
    return name ? (this.terms.find((term) => term.name === name) ?? null) : null;
  }

  /** The field that a label just tapped hands the click on to. */
  private handedOn: Element | null = null;

  private tapped(event: MouseEvent) {
    const {meaning} = this,
      target = event.target as Element;
    const isHandedOn = target === this.handedOn;
    this.handedOn = target.closest('label')?.control ?? null;
    if (isHandedOn) return;
    if (target.closest('dialog, button, input, select, textarea, svg')) {
      meaning.hidden = true;
      return;
    }
    const term = this.meaningOf(target);
    meaning.hidden = term === null;
    if (!term) return;
    meaning.replaceChildren(html('strong', {}, term.name), ` ${term.meaning}`);
    const box = target.getBoundingClientRect(),
      {offsetWidth, offsetHeight} = meaning;
    const below = box.bottom + 6 + offsetHeight < innerHeight;
    meaning.style.left = `${Math.max(8, Math.min(box.left, innerWidth - offsetWidth - 8))}px`;
    meaning.style.top = `${Math.max(8, below ? box.bottom + 6 : box.top - offsetHeight - 6)}px`;
  }
}

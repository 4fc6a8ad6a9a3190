// A state as a link, as text and as a card. A page that was opened from disk has no address that others could open:
// there the text alone is copied, which opens in any explorer, pasted into the page.
import {byId} from './dom';
import {drawCard} from './card';
import type {Explorer} from './explorer';
import {savePng, saveSvg} from './export';
import {linkOf, stateOf} from './link';
import {shipped} from './vehicles';

const hosted = () => /^https?:$/.test(location.protocol);

/** A text with a state in it: a whole link, its fragment, or the fragment without its mark. */
export function fragmentIn(text: string): string | null {
  const found = text.trim().match(/(?:#|^)((?:v=\d|vehicle=)[^\s#]*)$/);
  return found ? `#${found[1]}` : null;
}

/** Whether the text has been put on the clipboard. */
export async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false; // not allowed, or no such thing in this browser
  }
}

export class Share {
  private readonly dialog = byId<HTMLDialogElement>('share-dialog');

  constructor(private readonly explorer: Explorer) {
    byId('link').addEventListener('click', () => void this.copyLink());
    byId('share').addEventListener('click', () => void this.show());
    byId('share-copy').addEventListener('click', () => void this.copyText());
    byId('share-take').addEventListener('click', () => {
      void this.take(byId<HTMLTextAreaElement>('share-open').value);
    });
    const card = document.querySelector<SVGSVGElement>('#card')!;
    const name = () => `${explorer.state.design.name}-card`;
    byId('card-svg').addEventListener('click', () => saveSvg(name(), card));
    byId('card-png').addEventListener('click', () => void savePng(name(), card));
    document.addEventListener('paste', (event) => {
      const {target} = event;
      if (target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement) return;
      const text = event.clipboardData?.getData('text/plain') ?? '';
      if (fragmentIn(text) === null) return;
      event.preventDefault();
      void this.take(text);
    });
  }

  /** The address of the state, or the state as text where the page has no address of use to others. */
  private async text(): Promise<string> {
    const link = await linkOf(this.explorer.state, shipped);
    return hosted() ? location.href.replace(/#.*|$/, link) : link.slice(1);
  }

  private async copyLink() {
    const button = byId('link'),
      label = 'copy link';
    if (!(await copied(await this.text()))) return this.show();
    button.textContent = hosted() ? 'copied' : 'copied as text';
    setTimeout(() => (button.textContent = label), 1500);
  }

  private async show() {
    const field = byId<HTMLTextAreaElement>('share-text');
    field.value = await this.text();
    byId('share-hint').textContent = hosted()
      ? 'The address of this state. Whoever opens it sees what you see.'
      : 'This page was opened from disk. The text is its whole state: paste it into any explorer, hosted or from disk.';
    byId('share-note').textContent = '';
    byId<HTMLTextAreaElement>('share-open').value = '';
    drawCard(document.querySelector<SVGSVGElement>('#card')!, this.explorer);
    if (!this.dialog.open) this.dialog.showModal();
    field.focus();
    field.select();
  }

  private async copyText() {
    const field = byId<HTMLTextAreaElement>('share-text'),
      button = byId('share-copy');
    const done = await copied(field.value);
    if (!done) {
      field.focus();
      field.select();
    }
    button.textContent = done ? 'copied' : 'marked: press Ctrl+C';
    setTimeout(() => (button.textContent = 'copy the text'), 2500);
  }

  /** Opens a state that was pasted; what cannot be used is refused with the reason. */
  private async take(text: string) {
    const {explorer} = this,
      fragment = fragmentIn(text);
    const say = (why: string) => {
      if (this.dialog.open) byId('share-note').textContent = why;
      else explorer.say(why);
    };
    if (fragment === null) return say('There is no state in this text.');
    const {state, problems} = await stateOf(fragment, shipped);
    const why = [...problems, ...(state ? explorer.problemsOf(state) : [])];
    if (!state || why.length > 0) return say(`The text cannot be used: ${why.join('; ')}`);
    const {name, text: file} = state.design;
    if (shipped[name] !== file) explorer.files.add(name, file);
    this.dialog.close();
    await explorer.go(state);
  }
}

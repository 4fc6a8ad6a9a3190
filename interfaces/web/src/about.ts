// Version and copyright notices at the foot of the page.
import noticesUrl from '#packed/notices.txt?url';
import {byId, html} from './dom';
import {unpackedText} from './embedded';

declare const __VERSION__: string; // vite.config.js
declare const __DOI__: string | null;
export const version = __VERSION__;
/** Of the software, as CITATION.cff has it. */
export const doi = __DOI__;
export const identity = `wingbeat ${version}, ${doi ? `doi:${doi}` : 'no DOI registered'}`;

export class About {
  constructor() {
    const text = html('pre', {id: 'notices', tabindex: 0});
    const notices = html('details', {}, html('summary', {}, 'copyright notices'), text);
    notices.addEventListener('toggle', () => void this.show(text));
    byId('about').append(html('p', {}, `wingbeat ${version}, BSD 3-Clause License.`), notices);
  }

  /** Loaded when they are asked for. */
  private async show(text: HTMLElement) {
    if (text.textContent) return;
    try {
      text.textContent = (await unpackedText('wingbeat-notices')) ?? (await (await fetch(noticesUrl)).text());
    } catch (error) {
      text.textContent = `The notices could not be loaded: ${String(error)}`;
    }
  }
}

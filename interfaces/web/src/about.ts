// Version and copyright notices at the foot of the page.
import {byId, html} from './dom';

declare const __VERSION__: string; // vite.config.js
declare const __NOTICES__: string;
export const version = __VERSION__;

export class About {
  constructor() {
    const text = html('pre', {id: 'notices', tabindex: 0});
    const notices = html('details', {}, html('summary', {}, 'copyright notices'), text);
    notices.addEventListener('toggle', () => {
      text.textContent ||= __NOTICES__;
    });
    byId('about').append(html('p', {}, `wingbeat ${version}, BSD 3-Clause License.`), notices);
  }
}

// Pinned designs beside the present one: several of them, each to be swapped with it or forgotten.
import {byId, html} from './dom';
import type {Explorer, Shown} from './explorer';
import {paperTable} from './paper_table';
import {showMetrics} from './results';
import {describeDesign, maxPins} from './state';

export const pinName = (n: number) => String.fromCharCode(65 + n);

export class Compare {
  private listed = '';
  private tabled: Shown | null = null;

  constructor(private readonly explorer: Explorer) {
    byId('pin').addEventListener('click', () => {
      if (explorer.state.pins.length < maxPins) void explorer.pin();
    });
    byId('unpin').addEventListener('click', () => {
      void explorer.go({...explorer.state, pins: []});
      byId('pin').focus();
    });
    explorer.watch(() => this.refresh());
  }

  private refresh() {
    const {explorer} = this,
      {state, shown} = explorer;
    const full = state.pins.length >= maxPins;
    byId('pin').setAttribute('aria-disabled', String(full));
    const label = full ? `no more than ${maxPins} designs` : `pin this design as ${pinName(state.pins.length)}`;
    if (byId('pin').textContent !== label) byId('pin').textContent = label;
    byId('unpin').hidden = state.pins.length < 2;
    this.list();
    if (shown && shown !== this.tabled) {
      this.tabled = shown;
      explorer.inView.draw(byId('metrics'), () => this.tables(shown));
    }
  }

  private tables(shown: Shown) {
    const {explorer} = this;
    const pins = shown.pins.map((pin, n) => ({name: pinName(n), report: pin.solved.report}));
    const paper = paperTable(explorer);
    byId('paper-values').replaceChildren(...(paper ? [paper] : []));
    showMetrics(byId('metrics'), explorer.core.tables.metrics, shown.solved.report, pins);
  }

  private list() {
    const {pins} = this.explorer.state;
    const names = pins.map((pin) => describeDesign(pin));
    if (names.join('\n') === this.listed) return;
    this.listed = names.join('\n');
    byId('pins').replaceChildren(
      ...names.map((name, n) =>
        html(
          'li',
          {},
          html('strong', {}, pinName(n)),
          ` ${name} `,
          this.button(`swap ${pinName(n)} with the present design`, 'swap', () => this.swap(n)),
          this.button(`forget ${pinName(n)}`, 'forget', () => this.forget(n)),
        ),
      ),
    );
  }

  private button = (name: string, label: string, click: () => void) =>
    html('button', {type: 'button', 'aria-label': name, click}, label);

  private swap(n: number) {
    const {state} = this.explorer,
      pin = state.pins[n];
    if (!pin) return;
    void this.explorer.go({...state, design: pin, pins: state.pins.with(n, state.design)});
    byId('pins').querySelectorAll('button')[2 * n]?.focus();
  }

  private forget(n: number) {
    const {state} = this.explorer;
    void this.explorer.go({...state, pins: state.pins.filter((_, i) => i !== n)});
    byId('pin').focus();
  }
}

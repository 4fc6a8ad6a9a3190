// Choosing, opening, saving and sharing vehicles, and the conditions of a run.
import {Refused} from './core';
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {cycleCsv, download, savePng, saveSvg} from './export';
import {powerSeries} from './pictures/cycle_plots';
import {exact} from './quantities';
import {type State, shippedDesign} from './state';
import {motorCatalogue, shipped} from './vehicles';

const si = {frequency: 'Hz', lift: 'N'} as const;

export class Toolbar {
  constructor(private readonly explorer: Explorer) {
    this.vehicles();
    this.conditions();
    this.files();
    this.pictures();
    this.playback();
    byId('pin').addEventListener('click', () => explorer.pin());
    byId('unpin').addEventListener('click', () => explorer.unpin());
    byId('restore').addEventListener('click', () =>
      explorer.open({...explorer.state, design: {...explorer.state.design, changes: {}}}),
    );
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-copy]')) {
      button.addEventListener('click', () => this.copy(byId(button.dataset.copy!).textContent ?? '', button));
    }
    byId('link').addEventListener('click', (e) => this.copy(location.href, e.currentTarget as HTMLElement));
    byId('theme').addEventListener('click', () => {
      const chosen = document.documentElement.dataset.theme;
      const dark = chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
      document.documentElement.dataset.theme = dark ? 'light' : 'dark';
    });
    explorer.refreshTools = () => this.refresh();
    this.refresh();
  }

  /** Tools as the state has them. */
  refresh() {
    const {state} = this.explorer;
    const vehicle = byId<HTMLSelectElement>('vehicle');
    if (!Array.from(vehicle.options).some((o) => o.value === state.design.name))
      vehicle.append(html('option', {}, state.design.name));
    vehicle.value = state.design.name;
    byId<HTMLSelectElement>('condition').value = state.condition;
    byId<HTMLSelectElement>('hold').value = state.hold;
    const held = byId<HTMLInputElement>('held');
    held.hidden = state.hold === 'voltage';
    held.value = state.hold === 'voltage' ? '' : `${exact(state.held)} ${si[state.hold]}`;
    this.explorer.showPins();
    this.motors();
  }

  private open(state: State) {
    this.explorer.open(state);
    this.refresh();
  }

  private vehicles() {
    const select = byId<HTMLSelectElement>('vehicle');
    select.append(...Object.keys(shipped).map((name) => html('option', {value: name}, name)));
    select.addEventListener('change', () => {
      this.open({
        ...this.explorer.state,
        design: select.value in shipped ? shippedDesign(select.value) : this.explorer.state.design,
      });
    });
  }

  /** The catalogue in this vehicle, at its gear ratio. */
  private motors() {
    const select = byId<HTMLSelectElement>('motor'),
      {explorer} = this;
    const gear = explorer.current.values['motor.gear_ratio'];
    let found: {model: string; refused: string | null; values: Record<string, number>}[] = [];
    try {
      found = explorer.core.motors(explorer.stated, motorCatalogue, typeof gear === 'number' ? gear : 1);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
    }
    select.replaceChildren(
      html('option', {value: ''}, 'as stated'),
      ...found.map((m) =>
        html('option', {value: m.model, disabled: m.refused !== null, title: m.refused ?? ''}, m.model),
      ),
    );
    select.onchange = () => {
      const motor = found.find((m) => m.model === select.value);
      if (motor)
        explorer.change(Object.fromEntries(Object.entries(motor.values).map(([key, value]) => [key, exact(value)])));
    };
  }

  private conditions() {
    const {explorer} = this;
    const condition = byId<HTMLSelectElement>('condition'),
      hold = byId<HTMLSelectElement>('hold'),
      held = byId<HTMLInputElement>('held');
    condition.addEventListener('change', () => this.open({...explorer.state, condition: condition.value}));
    hold.addEventListener('change', () => {
      const chosen = hold.value as State['hold'],
        report = explorer.current.solved.report;
      const value = chosen === 'frequency' ? report.frequency_hz : report.lift_mean_n;
      this.open({
        ...explorer.state,
        hold: chosen,
        held: typeof value === 'number' ? Number(value.toPrecision(4)) : chosen === 'frequency' ? 20 : 0.01,
      });
    });
    held.addEventListener('change', () => {
      const unit = si[explorer.state.hold as keyof typeof si],
        text = held.value.trim();
      const found = text.match(/^([\d.eE+-]+)\s*(\S*)$/);
      const factors: Record<string, number> = {'': 1, [unit]: 1, mN: 1e-3, kHz: 1e3};
      const factor = found && factors[found[2]];
      if (found && factor && Number(found[1]) > 0) this.open({...explorer.state, held: Number(found[1]) * factor});
      else this.refresh();
    });
  }

  private files() {
    const {explorer} = this,
      input = byId<HTMLInputElement>('file');
    byId('open').addEventListener('click', () => input.click());
    input.addEventListener('change', () => this.read(input.files));
    document.addEventListener('dragover', (e) => {
      e.preventDefault();
      document.body.classList.add('dropping');
    });
    document.addEventListener('dragleave', () => document.body.classList.remove('dropping'));
    document.addEventListener('drop', (e) => {
      e.preventDefault();
      document.body.classList.remove('dropping');
      this.read(e.dataTransfer?.files ?? null);
    });
    byId('save').addEventListener('click', () => {
      download(`${explorer.state.design.name}.toml`, explorer.core.edited(explorer.stated), 'application/toml');
    });
    byId('csv').addEventListener('click', () => {
      if (explorer.hasCycle()) download('cycle.csv', cycleCsv(explorer.current.solved.columns), 'text/csv');
    });
  }

  /** A vehicle file, with the tables that it names beside it. */
  private async read(files: FileList | null) {
    const all = Array.from(files ?? []),
      vehicle = all.find((f) => f.name.endsWith('.toml'));
    if (!vehicle) return;
    const tables: Record<string, string> = {};
    for (const file of all) if (file !== vehicle) tables[file.name] = await file.text();
    try {
      const {toml} = this.explorer.core.read(await vehicle.text(), vehicle.name, tables);
      this.open({...this.explorer.state, design: {name: vehicle.name.replace(/\.toml$/, ''), text: toml, changes: {}}});
    } catch (error) {
      this.explorer.complain(error, true);
    }
  }

  private pictures() {
    for (const figure of document.querySelectorAll<HTMLElement>('[data-picture]')) {
      const name = figure.dataset.picture!,
        picture = figure.querySelector('svg')!;
      figure.append(
        html(
          'div',
          {class: 'save'},
          html('button', {type: 'button', 'aria-label': `${name} as SVG`, click: () => saveSvg(name, picture)}, 'SVG'),
          html(
            'button',
            {
              type: 'button',
              'aria-label': `${name} as PNG`,
              click: () => {
                savePng(name, picture);
              },
            },
            'PNG',
          ),
        ),
      );
    }
    byId('power-legend').append(...powerSeries.map((name, n) => html('b', {class: `label-${n}`}, name)));
    const abscissa = byId<HTMLSelectElement>('abscissa');
    abscissa.addEventListener('change', () => {
      this.explorer.abscissa = abscissa.value as 'time' | 'crank angle';
      this.explorer.drawCycle();
    });
  }

  private playback() {
    const {explorer} = this,
      {playback} = explorer;
    const scrub = byId<HTMLInputElement>('scrub'),
      rate = byId<HTMLInputElement>('rate');
    byId('play').addEventListener('click', () => explorer.play(!playback.playing));
    scrub.addEventListener('input', () => {
      explorer.pause();
      playback.show(Number(scrub.value) / 1000);
    });
    const slow = () => {
      playback.slowdown = 10 ** Number(rate.value);
      byId('rate-shown').textContent = `${Number(playback.slowdown.toPrecision(2))} ×`;
    };
    rate.addEventListener('input', slow);
    slow();
    explorer.play(playback.playing);
  }

  private async copy(text: string, button: HTMLElement) {
    const label = button.textContent;
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = 'copied';
    } catch {
      button.textContent = 'not allowed here';
    }
    setTimeout(() => {
      button.textContent = label;
    }, 1500);
  }
}

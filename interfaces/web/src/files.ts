// Vehicle files that are opened and saved, pictures and the cycle as files.
import {byId, html} from './dom';
import {Refused} from './core';
import type {Explorer} from './explorer';
import {readMeasured} from './measured';
import {cycleCsv, download, savePng, saveSvg} from './export';

export class Files {
  constructor(private readonly explorer: Explorer) {
    const input = byId<HTMLInputElement>('file');
    byId('open').addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      const files = Array.from(input.files ?? []);
      input.value = ''; // the same file can be chosen again
      void this.read(files);
    });
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      document.body.classList.add('dropping');
    });
    document.addEventListener('dragleave', () => document.body.classList.remove('dropping'));
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      document.body.classList.remove('dropping');
      void this.read(Array.from(event.dataTransfer?.files ?? []));
    });
    byId('save').addEventListener('click', () => this.save());
    byId('csv').addEventListener('click', () => {
      const columns = explorer.shown?.solved.columns;
      if (columns?.time_s) download('cycle.csv', cycleCsv(columns), 'text/csv');
    });
    this.pictures();
  }

  private save() {
    const {core, state} = this.explorer;
    try {
      download(`${state.design.name}.toml`, core.edited(state.design), 'application/toml');
    } catch (error) {
      this.explorer.refuse(error);
    }
  }

  /** A vehicle file, with the tables that it names beside it. */
  private async read(files: File[]) {
    if (files.length === 0) return;
    const {explorer} = this;
    const vehicle = files.find((f) => /\.toml$/i.test(f.name)) ?? files.find((f) => /\.txt$/i.test(f.name));
    const csv = files.find((f) => /\.csv$/i.test(f.name));
    if (!vehicle && csv) return this.measure(csv);
    if (!vehicle) {
      const names = files.map((f) => f.name).join(', ');
      return explorer.say(`${names}: no vehicle file (.toml, .txt) and no measured cycle (.csv) is among them`);
    }
    const tables: Record<string, string> = {};
    for (const file of files) if (file !== vehicle) tables[file.name] = await file.text();
    try {
      const {toml} = explorer.core.read(await vehicle.text(), vehicle.name, tables);
      const design = explorer.files.add(vehicle.name.replace(/\.(toml|txt)$/i, ''), toml);
      await explorer.go({...explorer.state, design});
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      explorer.refuse(error);
    }
  }

  /** A table without a vehicle file is a measured cycle. */
  private async measure(csv: File) {
    const {explorer} = this;
    try {
      const known = explorer.core.tables.waveforms.map((w) => w.key);
      explorer.views.measure(readMeasured(csv.name, await csv.text(), known));
      explorer.say('');
    } catch (error) {
      explorer.say((error as Error).message);
    }
  }

  private pictures() {
    for (const figure of document.querySelectorAll<HTMLElement>('[data-picture]')) {
      const name = figure.dataset.picture!,
        picture = figure.querySelector('svg')!;
      const button = (kind: string, save: () => void) =>
        html('button', {type: 'button', 'aria-label': `${name} as ${kind}`, click: save}, kind);
      figure.append(
        html(
          'div',
          {class: 'save'},
          button('SVG', () => saveSvg(name, picture)),
          button('PNG', () => void savePng(name, picture)),
        ),
      );
    }
  }
}

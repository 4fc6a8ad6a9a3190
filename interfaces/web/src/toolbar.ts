// Choosing vehicles, motors and the conditions of a run; undo and redo; playback; what is copied.
import {identity} from './about';
import {Refused, type Motor} from './core';
import {byId, html, setValue} from './dom';
import {pythonProgram, shellCommand} from './elsewhere';
import type {Explorer} from './explorer';
import {powerSeries} from './pictures/cycle_plots';
import {exact, readable} from './quantities';
import {copied} from './share';
import {describeDesign, type Design, heldUnit, type Hold, type State} from './state';
import {isShipped, motorCatalogue, shipped, shippedDesign} from './vehicles';

/** Equal up to the rounding of texts. */
const alike = (a: unknown, b: number) => typeof a === 'number' && Math.abs(a - b) <= 1e-12 * Math.abs(b);

export class Toolbar {
  private seen: State | null = null;
  private heldRefused = false;
  private motorsOf = '';
  private motors: Motor[] = [];
  private motorClock = 0;

  constructor(private readonly explorer: Explorer) {
    this.vehicle();
    this.motor();
    this.conditions();
    this.steps();
    this.playback();
    this.copying();
    this.theme();
    const abscissa = byId<HTMLSelectElement>('abscissa');
    abscissa.addEventListener('change', () => {
      explorer.views.abscissa = abscissa.value as 'time' | 'crank angle';
      explorer.views.drawCycle();
    });
    const zoom = byId<HTMLSelectElement>('zoom');
    zoom.addEventListener('change', () => {
      explorer.views.plots.zoom(Number(zoom.value));
      explorer.views.drawCycle();
    });
    byId('power-legend').append(...powerSeries.map((name, n) => html('b', {class: `label-${n}`}, name)));
    explorer.watch(() => this.refresh());
    this.refresh();
  }

  /** Tools as the state has them. */
  private refresh() {
    const {explorer} = this,
      {state} = explorer;
    if (state === this.seen) return;
    this.seen = state;
    const vehicle = byId<HTMLSelectElement>('vehicle');
    const names = [...Object.keys(shipped), ...explorer.files.names];
    if (!names.includes(state.design.name)) names.push(state.design.name);
    if (names.length !== vehicle.options.length) {
      vehicle.replaceChildren(...names.map((name) => html('option', {value: name}, name)));
    }
    setValue(vehicle, state.design.name);
    setValue(byId<HTMLSelectElement>('condition'), state.condition);
    setValue(byId<HTMLSelectElement>('hold'), state.hold);
    byId('held').hidden = state.hold === 'voltage';
    if (!this.heldRefused || state.hold === 'voltage') this.acceptHeld();
    // A disabled button would lose the focus of who has just pressed it.
    const enable = (id: string, on: boolean) => byId(id).setAttribute('aria-disabled', String(!on));
    enable('undo', explorer.history.canUndo);
    enable('redo', explorer.history.canRedo);
    enable('restore', Object.keys(state.design.changes).length > 0);
    byId('print-state').textContent = `${describeDesign(state.design, state.condition)}; ${identity}`;
    explorer.inView.draw(byId('shell'), () => {
      byId('shell').textContent = shellCommand(state, isOwn(state.design));
      byId('python').textContent = pythonProgram(state, isOwn(state.design));
    });
    clearTimeout(this.motorClock);
    this.motorClock = window.setTimeout(() => this.showMotors(), this.motorsOf ? 150 : 0);
  }

  private vehicle() {
    const select = byId<HTMLSelectElement>('vehicle'),
      {explorer} = this;
    select.addEventListener('change', () => {
      const design = isShipped(select.value) ? shippedDesign(select.value) : explorer.files.design(select.value);
      if (design) void explorer.go({...explorer.state, design});
    });
  }

  // ---- motors of the catalogue in this vehicle, at its gear ratio

  private motor() {
    const select = byId<HTMLSelectElement>('motor'),
      {explorer} = this;
    select.addEventListener('change', () => {
      const motor = this.motors.find((m) => m.model === select.value);
      if (motor) {
        const values = Object.entries(motor.values).map(([key, value]) => [key, exact(value)]);
        void explorer.change(Object.fromEntries(values) as Record<string, string>);
      } else if (select.value === '') {
        const keys = Object.keys(explorer.state.design.changes).filter((key) => key.startsWith('motor.'));
        void explorer.change(Object.fromEntries(keys.map((key) => [key, ''])));
      }
    });
  }

  private showMotors() {
    const select = byId<HTMLSelectElement>('motor'),
      {explorer} = this,
      {values, state} = explorer;
    const of = JSON.stringify([state.design.text, Object.entries(values).filter(([key]) => key.startsWith('motor.'))]);
    if (of === this.motorsOf) return;
    this.motorsOf = of;
    const gear = values['motor.gear_ratio'];
    this.motors = [];
    try {
      this.motors = explorer.core.motors(state.design, motorCatalogue, typeof gear === 'number' ? gear : 1);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
    }
    const changed = Object.keys(state.design.changes).some((key) => key.startsWith('motor.'));
    const present = changed
      ? this.motors.find(
          (m) => !m.refused && Object.entries(m.values).every(([key, value]) => alike(values[key], value)),
        )
      : undefined;
    select.replaceChildren(
      html('option', {value: ''}, 'as in the file'),
      ...(changed && !present ? [html('option', {value: '-', disabled: true}, 'changed')] : []),
      ...this.motors.map((m) =>
        html('option', {value: m.model, disabled: m.refused !== null, title: m.refused ?? ''}, m.model),
      ),
    );
    setValue(select, present?.model ?? (changed ? '-' : ''));
  }

  // ---- conditions, and what is held

  private conditions() {
    const {explorer} = this;
    const condition = byId<HTMLSelectElement>('condition'),
      hold = byId<HTMLSelectElement>('hold'),
      held = byId<HTMLInputElement>('held');
    condition.addEventListener('change', () => {
      void explorer.go({...explorer.state, condition: condition.value as State['condition']});
    });
    hold.addEventListener('change', () => {
      const chosen = hold.value as Hold,
        report = explorer.shown?.solved.report;
      const value = chosen === 'frequency' ? report?.frequency_hz : report?.lift_mean_n;
      const start = chosen === 'frequency' ? 20 : 0.01;
      const number = typeof value === 'number' && value > 0 ? Number(value.toPrecision(4)) : start;
      this.acceptHeld();
      void explorer.go({...explorer.state, hold: chosen, held: number}, {origin: 'held'});
    });
    held.addEventListener('change', () => this.hold(held.value.trim()));
    held.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') this.acceptHeld();
    });
    explorer.fields.set('held', {
      complain: (text) => this.refuseHeld(text),
      accept: () => this.acceptHeld(),
    });
  }

  /** A frequency or lift in any unit, as --frequency and --lift take it. */
  private hold(text: string) {
    const {explorer} = this,
      {hold} = explorer.state;
    if (hold === 'voltage') return;
    try {
      const value = explorer.core.quantity(text, heldUnit[hold]);
      if (!(value > 0 && Number.isFinite(value))) return this.refuseHeld(`expected a ${hold} above 0, got "${text}"`);
      void explorer.go({...explorer.state, held: value}, {origin: 'held'});
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.refuseHeld(error.message);
    }
  }

  private refuseHeld(text: string) {
    const held = byId<HTMLInputElement>('held'),
      {hold, held: value} = this.explorer.state;
    this.heldRefused = true;
    byId('held-note').textContent =
      hold === 'voltage' ? text : `${text}. In use: ${readable(value, heldUnit[hold], 6)}`;
    held.setAttribute('aria-invalid', 'true');
  }

  private acceptHeld() {
    const held = byId<HTMLInputElement>('held'),
      {hold, held: value} = this.explorer.state;
    this.heldRefused = false;
    byId('held-note').textContent = '';
    held.removeAttribute('aria-invalid');
    setValue(held, hold === 'voltage' ? '' : readable(value, heldUnit[hold], 6));
  }

  // ---- undo and redo

  private steps() {
    const {explorer} = this;
    byId('undo').addEventListener('click', () => void explorer.undo());
    byId('redo').addEventListener('click', () => void explorer.redo());
    byId('restore').addEventListener('click', () => {
      const {design} = explorer.state;
      if (Object.keys(design.changes).length) void explorer.go({...explorer.state, design: {...design, changes: {}}});
    });
    document.addEventListener('keydown', (event) => {
      const typing = event.target instanceof HTMLInputElement && event.target.type === 'text';
      if (typing || !(event.ctrlKey || event.metaKey) || event.altKey) return;
      const key = event.key.toLowerCase();
      if (key !== 'z' && key !== 'y') return;
      event.preventDefault();
      void (key === 'y' || event.shiftKey ? explorer.redo() : explorer.undo());
    });
  }

  private playback() {
    const {views} = this.explorer,
      {playback} = views;
    const scrub = byId<HTMLInputElement>('scrub'),
      rate = byId<HTMLInputElement>('rate');
    byId('play').addEventListener('click', () => views.play(!playback.playing));
    scrub.addEventListener('input', () => {
      views.pause();
      playback.show(Number(scrub.value) / 1000);
    });
    const slow = () => {
      playback.slowdown = 10 ** Number(rate.value);
      byId('rate-shown').textContent = `${Number(playback.slowdown.toPrecision(2))} ×`;
    };
    rate.addEventListener('input', slow);
    slow();
    views.play(playback.playing);
  }

  private copying() {
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-copy]')) {
      button.addEventListener('click', () => void copy(byId(button.dataset.copy!).textContent ?? '', button));
    }
  }

  private theme() {
    const root = document.documentElement,
      storage = 'wingbeat-theme';
    try {
      const kept = localStorage.getItem(storage);
      if (kept === 'light' || kept === 'dark') root.dataset.theme = kept;
    } catch {
      // Without storage the theme is the browser's.
    }
    byId('theme').addEventListener('click', () => {
      const dark = root.dataset.theme
        ? root.dataset.theme === 'dark'
        : matchMedia('(prefers-color-scheme: dark)').matches;
      root.dataset.theme = dark ? 'light' : 'dark';
      try {
        localStorage.setItem(storage, root.dataset.theme);
      } catch {
        // It lasts until the page is left.
      }
    });
  }
}

/** A file of the user's own, which a command names by its file. */
const isOwn = (design: Design) => shipped[design.name] !== design.text;

async function copy(text: string, button: HTMLElement) {
  const label = button.textContent;
  button.textContent = (await copied(text)) ? 'copied' : 'not allowed here';
  setTimeout(() => {
    button.textContent = label;
  }, 1500);
}

// Trends over one key and maps over two, computed beside the page. A picture belongs to the state in which it was asked
// for; a click takes a design of that state.
import {sweepRange} from './controls';
import {type Columns, Refused, type Values} from './core';
import {byId, html} from './dom';
import {Channel} from './engine';
import type {Explorer} from './explorer';
import {type Axis, drawMap, drawTrend, type Outcome} from './pictures/study_plots';
import {exact, readable} from './quantities';
import {describeDesign, identityOf, type State} from './state';

const trendDesigns = 200,
  mapSide = 40,
  deadline = 60_000; // without progress [ms]
/** Metrics of which less is better. */
const wantedLow = /^power_|^current_|loss|temperature|rod_force/;

interface Study {
  of: State;
  values: Values;
  across: Axis;
  up: Axis | null;
  statuses: string[];
  columns: Columns;
  took: number;
}

export class Studies {
  private readonly channel: Channel;
  private study: Study | null = null;
  private offered = '';
  /** Keys that were chosen last, whether the present vehicle has them or not. */
  private readonly wanted = {across: 'supply.voltage', up: ''};
  private marked = '';

  constructor(private readonly explorer: Explorer) {
    this.channel = new Channel(explorer.compiled, deadline, 0);
    byId('study').addEventListener('click', () => {
      if (this.channel.busy) this.channel.stop('stopped');
      else void this.compute();
    });
    byId<HTMLSelectElement>('metric').append(
      ...explorer.core.tables.metrics.map((m) =>
        html('option', {value: m.key, ...(m.key === 'lift_mean_n' ? {selected: true} : {})}, m.meaning),
      ),
    );
    byId('metric').addEventListener('change', () => this.draw());
    for (const id of ['across', 'up'] as const) {
      byId(id).addEventListener('change', () => {
        this.wanted[id] = byId<HTMLSelectElement>(id).value;
        this.showWhose();
      });
    }
    byId('take-best').addEventListener('click', () => {
      const best = this.study && bestOf(this.outcome(this.study), this.isLow());
      if (this.study && best !== null) this.pick(this.study, best);
    });
    explorer.watch(() => this.follow());
    this.follow();
  }

  private follow() {
    this.offerKeys();
    if (!this.study) return;
    // Only the mark of the present design moves while a slider does.
    const mark = JSON.stringify(this.present(this.study));
    if (mark !== this.marked) this.draw();
    else this.showWhose();
  }

  /** The numbers that the vehicle has. */
  private offerKeys() {
    const {values, core} = this.explorer;
    const names = core.tables.keys.filter((k) => k.number && typeof values[k.key] === 'number').map((k) => k.key);
    if (names.join() === this.offered) return;
    this.offered = names.join();
    for (const id of ['across', 'up'] as const) {
      const select = byId<HTMLSelectElement>(id);
      select.replaceChildren(
        ...(id === 'up' ? [html('option', {value: ''}, 'nothing else: a trend')] : []),
        ...names.map((name) => html('option', {value: name}, name)),
      );
      const first = id === 'up' ? [''] : ['supply.amplitude', ...names];
      select.value = [this.wanted[id], ...first].find((name) => name === '' || names.includes(name)) ?? '';
    }
  }

  private axis(name: string, count: number): Axis | null {
    const {core, values, typical} = this.explorer;
    const key = core.tables.keys.find((k) => k.key === name);
    const value = values[name];
    const range = key && typeof value === 'number' ? sweepRange(key, value, typical[name] ?? 0) : null;
    if (!key || !range) return null;
    const numbers = Array.from({length: count}, (_, n) => range[0] + ((range[1] - range[0]) * n) / (count - 1));
    return {name, unit: key.unit ?? '1', values: key.whole ? [...new Set(numbers.map(Math.round))] : numbers};
  }

  // ---- computing

  private async compute() {
    const {explorer} = this,
      {state, values} = explorer;
    const first = byId<HTMLSelectElement>('across').value,
      second = byId<HTMLSelectElement>('up').value;
    const note = byId('study-note'),
      progress = byId<HTMLProgressElement>('progress'),
      button = byId('study');
    if (first === second) return (note.textContent = 'choose two different keys');
    const across = this.axis(first, second ? mapSide : trendDesigns),
      up = second ? this.axis(second, mapSide) : null;
    if (!across || (second && !up)) {
      return (note.textContent = 'this key is 0 here, and so in every vehicle that comes along: give it a value first');
    }
    const designs = up ? up.values.flatMap((y) => across.values.flatMap((x) => [x, y])) : across.values;
    progress.hidden = false;
    progress.value = 0;
    button.textContent = 'stop';
    const outcome = await this.channel.ask(
      'ensemble',
      {
        stated: {text: state.design.text, changes: state.design.changes},
        keys: up ? [first, second] : [first],
        values: Float64Array.from(designs),
        options: {condition: state.condition},
        chunk: up ? 80 : 50,
      },
      (share: number) => {
        progress.value = share;
      },
    );
    progress.hidden = true;
    button.textContent = 'compute';
    if (outcome.kind === 'done') {
      this.study = {of: state, values, across, up, ...outcome.answer, took: outcome.took};
      this.draw();
      document.body.dataset.study = `${designs.length / (up ? 2 : 1)} ${Math.round(outcome.took)}`;
    } else if (outcome.kind === 'refused') note.textContent = new Refused(outcome.problems).message;
    else if (outcome.kind === 'failed') note.textContent = `Not computed: ${outcome.why}.`;
  }

  // ---- whose picture it is

  private axesOf = ({across, up}: Study) => (up ? [across.name, up.name] : [across.name]);

  /** The design of the page on the axes of the study, where it differs from the study's in nothing else. */
  private present(study: Study): number[] | null {
    const {state, values} = this.explorer,
      axes = this.axesOf(study);
    const rest = (s: State) => {
      const changes = Object.fromEntries(Object.entries(s.design.changes).filter(([key]) => !axes.includes(key)));
      return s.design.name + identityOf({...s.design, changes}, {condition: s.condition});
    };
    return rest(state) === rest(study.of) ? axes.map((key) => Number(values[key])) : null;
  }

  private showWhose() {
    const {study} = this;
    if (!study) return;
    const present = this.present(study),
      stale = byId('study-stale');
    const chosen = [byId<HTMLSelectElement>('across').value, byId<HTMLSelectElement>('up').value].filter(Boolean);
    const other = chosen.join() !== this.axesOf(study).join();
    const of = describeDesign(study.of.design, study.of.condition, this.axesOf(study));
    stale.hidden = present !== null && !other;
    stale.textContent =
      present === null
        ? `Computed for ${of}, not for the design shown above. A click takes a design of this picture, all of it.`
        : `Computed over ${this.axesOf(study).join(' and ')}; compute again for the keys chosen.`;
    byId('study-picture')
      .closest('figure')!
      .classList.toggle('stale', present === null);
  }

  // ---- drawing

  private isLow = () => wantedLow.test(byId<HTMLSelectElement>('metric').value);

  private outcome({statuses, columns}: Study): Outcome {
    const status = columns.status!,
      domain = columns.domain!,
      hover = columns.lift_to_weight!;
    const weighed = hover.some((x) => Number.isFinite(x));
    const feasible = Array.from(
      status,
      (s, i) => statuses[s] === 'flapping' && domain[i] === 0 && (!weighed || hover[i]! >= 1),
    );
    return {
      statuses,
      status,
      domain,
      metric: columns[byId<HTMLSelectElement>('metric').value]!,
      feasible,
      weighed,
    };
  }

  private draw() {
    const {study, explorer} = this;
    if (!study) return;
    const {across, up} = study;
    const metric = explorer.core.tables.metrics.find((m) => m.key === byId<HTMLSelectElement>('metric').value)!;
    const outcome = this.outcome(study),
      best = bestOf(outcome, this.isLow()),
      present = this.present(study);
    this.marked = JSON.stringify(present);
    const picture = document.querySelector<SVGSVGElement>('#study-picture')!;
    picture.removeAttribute('hidden');
    const title = describeDesign(study.of.design, study.of.condition, this.axesOf(study));
    const shown = {title, metric: {name: metric.meaning, unit: metric.unit}, outcome, best, present};
    const pick = (index: number) => this.pick(study, index);
    if (up) drawMap(picture, across, up, shown, pick);
    else drawTrend(picture, across, shown, pick);
    byId('study-note').textContent = this.inWords(study, outcome, best, metric.unit);
    byId('take-best').hidden = best === null;
    this.showWhose();
  }

  private inWords(study: Study, outcome: Outcome, best: number | null, unit: string): string {
    const {across, up, statuses} = study,
      {status} = outcome;
    const count = (want: string) => status.reduce((n, s) => n + Number(statuses[s] === want), 0);
    const failing = statuses.filter((s) => s !== 'flapping' && count(s) > 0).map((s) => `${count(s)} ${s}`);
    const counts = [`${count('flapping')} flapping`, ...failing].join(', ');
    const said = [`${status.length} designs in ${Math.round(study.took)} ms at constant voltage: ${counts}.`];
    if (up) said.push(`Outlined: inside the model's domain${outcome.weighed ? ' and lifting the weight' : ''}.`);
    else said.push("Marks at the foot: no flapping. Dashed: outside the model's domain.");
    said.push('Click to take a design.');
    if (best === null) return [...said, 'No design here is feasible.'].join(' ');
    const column = up ? best % across.values.length : best;
    const values = [`${across.name} ${readable(across.values[column], across.unit)}`];
    if (up) values.push(`${up.name} ${readable(up.values[Math.floor(best / across.values.length)], up.unit)}`);
    const aim = this.isLow() ? 'least' : 'most';
    said.push(`Best feasible (${aim}): ${readable(outcome.metric[best], unit)} at ${values.join(', ')}.`);
    return said.join(' ');
  }

  /** Takes a design of the study: its vehicle, values, condition and voltage, whatever the page shows now. */
  private pick({of, across, up}: Study, index: number) {
    const {explorer} = this;
    const width = across.values.length;
    const changes = {[across.name]: exact(across.values[up ? index % width : index]!)};
    if (up) changes[up.name] = exact(up.values[Math.floor(index / width)]!);
    void explorer.go({
      ...explorer.state,
      design: explorer.changed(of.design, changes),
      condition: of.condition,
      hold: 'voltage',
      held: 0,
    });
  }
}

function bestOf(outcome: Outcome, low: boolean): number | null {
  let best: number | null = null;
  outcome.metric.forEach((x, i) => {
    if (!outcome.feasible[i] || !Number.isFinite(x)) return;
    if (best === null || (low ? x < outcome.metric[best]! : x > outcome.metric[best]!)) best = i;
  });
  return best;
}

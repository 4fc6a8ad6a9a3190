// Trends over one key and maps over two, computed beside the page; a click takes the design.
import type {Background} from './background';
import {sweepRange} from './controls';
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {type Axis, drawMap, drawTrend, type Outcome} from './pictures/study_plots';
import {exact, readable} from './quantities';

const trendDesigns = 200,
  mapSide = 40;
/** Metrics of which less is better. */
const wantedLow = /^power_|^current_|loss|temperature|rod_force/;

export class Studies {
  private running = false;

  constructor(
    private readonly explorer: Explorer,
    private readonly background: Background,
  ) {
    byId('study').addEventListener('click', () => {
      this.compute();
    });
    byId<HTMLSelectElement>('metric').append(
      ...explorer.core.tables.metrics.map((m) =>
        html('option', {value: m.key, ...(m.key === 'lift_mean_n' ? {selected: true} : {})}, m.meaning),
      ),
    );
    this.offerKeys();
  }

  /** The numbers that the vehicle has. */
  offerKeys() {
    const values = this.explorer.current.values;
    const names = this.explorer.core.tables.keys
      .filter((k) => k.number && typeof values[k.key] === 'number')
      .map((k) => k.key);
    for (const [id, first] of [
      ['across', 'supply.voltage'],
      ['up', ''],
    ] as const) {
      const select = byId<HTMLSelectElement>(id),
        chosen = select.value || first;
      select.replaceChildren(
        ...(id === 'up' ? [html('option', {value: ''}, 'nothing else: a trend')] : []),
        ...names.map((name) => html('option', {value: name}, name)),
      );
      select.value = names.includes(chosen) ? chosen : id === 'up' ? '' : names[0];
    }
  }

  private axis(name: string, count: number): Axis | null {
    const key = this.explorer.core.tables.keys.find((k) => k.key === name);
    const value = this.explorer.current.values[name];
    const range = key && typeof value === 'number' ? sweepRange(key, value, this.explorer.typicalOf(name)) : null;
    if (!key || !range) return null;
    const numbers = Array.from({length: count}, (_, n) => range[0] + ((range[1] - range[0]) * n) / (count - 1));
    return {name, unit: key.unit ?? '1', values: key.whole ? [...new Set(numbers.map(Math.round))] : numbers};
  }

  async compute() {
    if (this.running) return;
    const {explorer} = this;
    const across = byId<HTMLSelectElement>('across').value,
      up = byId<HTMLSelectElement>('up').value;
    const note = byId('study-note'),
      progress = byId<HTMLProgressElement>('progress');
    const a = this.axis(across, up ? mapSide : trendDesigns),
      u = up ? this.axis(up, mapSide) : null;
    if (!a || (up && !u) || across === up) {
      note.textContent =
        across === up
          ? 'choose two different keys'
          : 'this key is 0 here, and so in every vehicle that comes along: give it a value first';
      return;
    }
    const designs = u ? u.values.flatMap((y) => a.values.flatMap((x) => [x, y])) : a.values;
    const stated = {text: explorer.state.design.text, changes: {...explorer.state.design.changes}};
    this.running = true;
    progress.hidden = false;
    const begun = performance.now();
    try {
      const found = await this.background.ensemble(
        stated,
        u ? [across, up] : [across],
        Float64Array.from(designs),
        {condition: explorer.state.condition},
        u ? 80 : 50,
        (share) => {
          progress.value = share;
        },
      );
      this.show(a, u, found.statuses, found.columns, stated, performance.now() - begun);
    } catch (error) {
      note.textContent = String(error);
    } finally {
      this.running = false;
      progress.hidden = true;
    }
  }

  private show(
    a: Axis,
    u: Axis | null,
    statuses: string[],
    columns: Record<string, Float64Array>,
    stated: {text: string; changes: Record<string, string>},
    took: number,
  ) {
    const {explorer} = this;
    const name = byId<HTMLSelectElement>('metric').value;
    const metric = explorer.core.tables.metrics.find((m) => m.key === name)!;
    const {status, domain} = columns,
      hover = columns.lift_to_weight;
    const weighed = hover.some((x) => Number.isFinite(x));
    const feasible = Array.from(
      status,
      (s, i) => statuses[s] === 'flapping' && domain[i] === 0 && (!weighed || hover[i] >= 1),
    );
    const outcome: Outcome = {statuses, status, domain, metric: columns[name], feasible};
    const value = (key: string) => explorer.current.values[key] as number;
    const pick = (index: number) => {
      const across = a.values[u ? index % a.values.length : index];
      const changes: Record<string, string> = {[a.name]: exact(across)};
      if (u) changes[u.name] = exact(u.values[Math.floor(index / a.values.length)]);
      explorer.open({
        ...explorer.state,
        design: {...explorer.state.design, text: stated.text, changes: {...stated.changes, ...changes}},
      });
    };
    const picture = document.querySelector<SVGSVGElement>('#study-picture')!;
    picture.removeAttribute('hidden');
    const count = (want: string) => status.reduce((n, s) => n + Number(statuses[s] === want), 0);
    const failing = statuses.filter((s) => s !== 'flapping' && count(s) > 0).map((s) => `${count(s)} ${s}`);
    const counts = [`${count('flapping')} flapping`, ...failing].join(', ');
    let said = `${status.length} designs in ${Math.round(took)} ms at constant voltage: ${counts}.`;
    if (!u) {
      drawTrend(picture, {...a}, {name: metric.meaning, unit: metric.unit}, outcome, value(a.name), pick);
      said += " Marks at the foot: no flapping. Dashed: outside the model's domain. Click to take a design.";
    } else {
      const best = bestOf(outcome, wantedLow.test(name));
      drawMap(
        picture,
        a,
        u,
        {name: metric.meaning, unit: metric.unit},
        outcome,
        best,
        [value(a.name), value(u.name)],
        pick,
      );
      said += ` Outlined: inside the model's domain${weighed ? ' and lifting the weight' : ''}.`;
      if (best === null) {
        said += ' No design here is feasible.';
      } else {
        const place = [
          `${a.name} ${readable(a.values[best % a.values.length], a.unit)}`,
          `${u.name} ${readable(u.values[Math.floor(best / a.values.length)], u.unit)}`,
        ].join(', ');
        const aim = wantedLow.test(name) ? 'least' : 'most';
        said += ` Best feasible (${aim}): ${readable(columns[name][best], metric.unit)} at ${place}.`;
      }
    }
    byId('study-note').textContent = said;
    document.body.dataset.study = `${status.length} ${Math.round(took)}`;
  }
}

function bestOf(outcome: Outcome, low: boolean): number | null {
  let best: number | null = null;
  outcome.metric.forEach((x, i) => {
    if (!outcome.feasible[i] || !Number.isFinite(x)) return;
    if (best === null || (low ? x < outcome.metric[best] : x > outcome.metric[best])) best = i;
  });
  return best;
}

// The library in a worker: one task after the other, each answered once. The page ends the worker to end a task.
import {type Columns, type Core, type Report, Refused, type RunOptions, startCore} from './core';
import {type Compared, fit, type FitLimits, type FitResult} from './fit';
import {type Found, type Limits, makeHover, type Tried} from './hover';
import {match, type Measured, residualsOf, sizesOf} from './measured';
import {type Reply, serve} from './worker_loop';
import type {Mechanism, Solved, StartUp, Stated, Values} from './core';

/** What is known of one design. */
export interface Computed {
  values: Values;
  solved: Solved;
  mechanism: Mechanism;
  startUp: StartUp | null;
}
export interface Tasks {
  /** `rows` of a cycle. */
  designs: {ask: {designs: Stated[]; options: RunOptions; rows: number}; answer: Computed[]};
  gradients: {
    ask: {stated: Stated; keys: string[]; options: RunOptions};
    answer: Record<string, (number | null)[]>;
  };
  report: {ask: {stated: Stated; options: RunOptions}; answer: Report};
  ensemble: {
    ask: {stated: Stated; keys: string[]; values: Float64Array; options: RunOptions; chunk: number};
    answer: {statuses: string[]; columns: Columns};
  };
  /** Progress is each design on the path. */
  hover: {ask: {stated: Stated; keys: string[]; limits: Limits; options: RunOptions}; answer: Found};
  /** Progress is each design on the path. */
  fit: {
    ask: {stated: Stated; keys: string[]; limits: FitLimits; options: RunOptions; measured: Measured};
    answer: FitResult;
  };
}
export type Kind = keyof Tasks;
export type Request = {[K in Kind]: {id: number; kind: K; ask: Tasks[K]['ask']}}[Kind];

/** Of a cycle that is compared with a measured one. */
const rows = 361;
const fullTurn = Float64Array.from({length: 181}, (_, n) => (2 * Math.PI * n) / 180);

function computed(library: Core, stated: Stated, options: RunOptions): Computed {
  const values = library.values(stated);
  const solved = library.solve(stated, options);
  const mechanism = library.mechanism(stated, fullTurn);
  const moves = solved.columns.time_s || solved.report.status === null || !solved.reached;
  return {values, solved, mechanism, startUp: moves ? null : library.startUp(stated, options)};
}

/** Chunk by chunk, so that the page sees progress. */
function ensemble(library: Core, id: number, task: Tasks['ensemble']['ask']): Tasks['ensemble']['answer'] {
  const width = task.keys.length,
    count = task.values.length / width;
  const columns: Columns = {};
  let statuses: string[] = [];
  for (let begin = 0; begin < count; begin += task.chunk) {
    const part = library.ensemble(
      task.stated,
      task.keys,
      task.values.subarray(begin * width, (begin + task.chunk) * width),
      task.options,
    );
    statuses = part.statuses;
    for (const [name, numbers] of Object.entries(part.columns)) {
      (columns[name] ??= new Float64Array(count)).set(numbers, begin);
    }
    self.postMessage({id, progress: Math.min(1, (begin + task.chunk) / count)} satisfies Reply);
  }
  return {statuses, columns};
}

/** Solved closely, so that differences of designs are those of their keys. */
const fine = 1e-9;

function fitted(library: Core, id: number, task: Tasks['fit']['ask']): FitResult {
  const {stated, keys, limits, options, measured} = task;
  const cycleOf = (values: number[]): Columns | null => {
    const changes = {...stated.changes, ...Object.fromEntries(keys.map((key, i) => [key, String(values[i])]))};
    try {
      const {columns} = library.solve({text: stated.text, changes}, {...options, rows, tolerance: fine});
      return columns.time_s ? columns : null;
    } catch (error) {
      if (error instanceof Refused) return null; // a mechanism that cannot be built
      throw error;
    }
  };
  const present = library.values(stated);
  const start = keys.map((key, i) => Math.min(limits.upper[i]!, Math.max(limits.lower[i]!, Number(present[key]))));
  const first = cycleOf(start);
  if (!first)
    throw new Refused([
      {message: 'The design has no steady cycle, or cannot be built with its keys within these limits.'},
    ]);
  const sizes = sizesOf(measured, first),
    {shift} = match(measured, first);
  if (sizes.size === 0) throw new Refused([{message: 'The design has none of the quantities measured.'}]);
  const compare = (values: number[], at: number): Compared | null => {
    const cycle = cycleOf(values);
    return cycle && residualsOf(measured, cycle, sizes, at);
  };
  const period = first.time_s![first.time_s!.length - 1]!;
  const found = fit(start, (shift ?? 0) / period, limits, compare, (progress) =>
    self.postMessage({id, progress} satisfies Reply),
  );
  if (!found) throw new Refused([{message: 'The design has no steady cycle.'}]);
  return found;
}

function hover(library: Core, id: number, {stated, keys, limits, options}: Tasks['hover']['ask']): Found {
  const column = (key: string) => library.tables.metrics.findIndex((m) => m.key === key);
  const lift = column('lift_to_weight'),
    power = column('power_electrical_w');
  const evaluate = (values: number[]): Tried | null => {
    const changes = {...stated.changes, ...Object.fromEntries(keys.map((key, i) => [key, String(values[i])]))};
    const design = {text: stated.text, changes};
    let report: Report;
    try {
      report = library.solve(design, options).report;
    } catch (error) {
      if (error instanceof Refused) return null; // a mechanism that cannot be built
      throw error;
    }
    if (report.status !== 'flapping' || report.lift_to_weight === null || report.power_electrical_w === null)
      return null;
    const slopes = library.gradients(design, keys, options);
    const by = (metric: number) => keys.map((key, i) => (slopes[key]?.[metric] ?? 0) * values[i]!);
    return {
      values,
      lift: report.lift_to_weight,
      power: report.power_electrical_w,
      liftSlopes: by(lift),
      powerSlopes: by(power),
      inside: report.domain === 'inside',
    };
  };
  const present = library.values(stated);
  const first = keys.map((key, i) => Math.min(limits.upper[i]!, Math.max(limits.lower[i]!, Number(present[key]))));
  const start = evaluate(first);
  if (!start)
    throw new Refused([{message: 'The design does not flap, or cannot be built with its keys within these limits.'}]);
  return makeHover(start, limits, evaluate, (progress) => self.postMessage({id, progress} satisfies Reply));
}

function answer(library: Core, request: Request): Tasks[Kind]['answer'] {
  const {kind, ask} = request;
  switch (kind) {
    case 'designs':
      return ask.designs.map((stated) => computed(library, stated, {...ask.options, rows: ask.rows}));
    case 'gradients':
      return library.gradients(ask.stated, ask.keys, ask.options);
    case 'report':
      return library.solve(ask.stated, ask.options).report;
    case 'ensemble':
      return ensemble(library, request.id, ask);
    case 'hover':
      return hover(library, request.id, ask);
    case 'fit':
      return fitted(library, request.id, ask);
  }
}

serve<Core, Request>(startCore, answer);

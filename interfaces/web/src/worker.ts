// The library in a worker: one task after the other, each answered once. The page ends the worker to end a task.
import {type Columns, type Core, type Report, Refused, type RunOptions, startCore} from './core';
import {type Found, type Limits, makeHover, type Tried} from './hover';
import type {Mechanism, Problem, Solved, StartUp, Stated, Values} from './core';

/** What is known of one design. */
export interface Computed {
  values: Values;
  solved: Solved;
  mechanism: Mechanism;
  startUp: StartUp | null;
}
export interface Tasks {
  designs: {ask: {designs: Stated[]; options: RunOptions}; answer: Computed[]};
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
}
export type Kind = keyof Tasks;
export type Request = {[K in Kind]: {id: number; kind: K; ask: Tasks[K]['ask']}}[Kind];
export type Reply =
  | {id: number; begun: true}
  | {id: number; progress: unknown}
  | {id: number; answer: Tasks[Kind]['answer']}
  | {id: number; refused: Problem[]}
  | {id: number; broken: string};

const rows = 361;
const fullTurn = Float64Array.from({length: 181}, (_, n) => (2 * Math.PI * n) / 180);

function computed(library: Core, stated: Stated, options: RunOptions): Computed {
  const values = library.values(stated);
  const solved = library.solve(stated, {...options, rows});
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
      return ask.designs.map((stated) => computed(library, stated, ask.options));
    case 'gradients':
      return library.gradients(ask.stated, ask.keys, ask.options);
    case 'report':
      return library.solve(ask.stated, ask.options).report;
    case 'ensemble':
      return ensemble(library, request.id, ask);
    case 'hover':
      return hover(library, request.id, ask);
  }
}

/** The buffers of all arrays in an answer, which are handed over without a copy. */
function buffersOf(value: unknown, found: ArrayBufferLike[] = []): ArrayBufferLike[] {
  if (value instanceof Float64Array) found.push(value.buffer);
  else if (value && typeof value === 'object') for (const part of Object.values(value)) buffersOf(part, found);
  return found;
}

let core: Promise<Core> | null = null;
self.onmessage = async (event: MessageEvent<Request | {compiled: WebAssembly.Module}>) => {
  if ('compiled' in event.data) {
    core = startCore(event.data.compiled);
    return;
  }
  const {id} = event.data;
  let reply: Reply;
  try {
    const library = await core!;
    self.postMessage({id, begun: true} satisfies Reply);
    reply = {id, answer: answer(library, event.data)};
  } catch (error) {
    reply = error instanceof Refused ? {id, refused: error.problems} : {id, broken: String(error)};
  }
  self.postMessage(reply, {transfer: 'answer' in reply ? (buffersOf(reply.answer) as Transferable[]) : []});
};

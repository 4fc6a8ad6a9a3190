// Derivatives, trends and maps beside the page, by a second instance of the library.
import {type Columns, type Core, type RunOptions, startCore, type Stated} from './core';

export type Task =
  | {kind: 'gradients'; stated: Stated; keys: string[]; options: RunOptions}
  | {kind: 'ensemble'; stated: Stated; keys: string[]; values: Float64Array; options: RunOptions; chunk: number};
export interface Request {
  id: number;
  task: Task;
}
export type Reply = {id: number} & (
  | {kind: 'progress'; done: number}
  | {kind: 'gradients'; gradients: Record<string, (number | null)[]>}
  | {kind: 'ensemble'; statuses: string[]; columns: Columns}
  | {kind: 'refused'; message: string}
);

const reply = (message: Reply) => self.postMessage(message);
let core: Promise<Core>;
let latest = 0; // a request for derivatives that is overtaken is not computed

async function gradients(id: number, task: Extract<Task, {kind: 'gradients'}>) {
  const library = await core;
  await new Promise((resume) => setTimeout(resume)); // later requests arrive first
  if (id < latest) return reply({id, kind: 'refused', message: 'overtaken'});
  reply({id, kind: 'gradients', gradients: library.gradients(task.stated, task.keys, task.options)});
}

async function ensemble(id: number, task: Extract<Task, {kind: 'ensemble'}>) {
  const library = await core;
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
      columns[name] ??= new Float64Array(count);
      columns[name].set(numbers, begin);
    }
    reply({id, kind: 'progress', done: Math.min(1, (begin + task.chunk) / count)});
    await new Promise((resume) => setTimeout(resume));
  }
  reply({id, kind: 'ensemble', statuses, columns});
}

self.onmessage = (event: MessageEvent<Request | {compiled: WebAssembly.Module}>) => {
  if ('compiled' in event.data) {
    core = startCore(event.data.compiled);
    return;
  }
  const {id, task} = event.data;
  if (task.kind === 'gradients') latest = id;
  (task.kind === 'gradients' ? gradients(id, task) : ensemble(id, task)).catch((error: Error) =>
    reply({id, kind: 'refused', message: error.message}),
  );
};

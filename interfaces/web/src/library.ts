// What both libraries, compiled to WebAssembly, have in common for the page and its workers.
import type {Problem} from './answers';

export type Columns = Record<string, Float64Array>;
/** A vehicle file and values of keys on top of it, as `--set` takes them. */
export interface Stated {
  readonly text: string;
  readonly changes: Readonly<Record<string, string>>;
}

/** What the library refuses, in its own sentences. */
export class Refused extends Error {
  constructor(readonly problems: Problem[]) {
    super(problems.map((p) => p.message).join('\n'));
  }
}

export interface Answer {
  json: string;
  columns?: Columns;
}
/** `--set` assignments. */
export const assignments = (changes: Stated['changes']) => Object.entries(changes).map(([k, v]) => `${k}=${v}`);
export const list = (s: Stated) => JSON.stringify(assignments(s.changes));

export function resultOf<T>(answer: Answer): T {
  const found = JSON.parse(answer.json) as {errors?: Problem[]; columns?: Columns};
  if (found.errors) throw new Refused(found.errors);
  if (answer.columns) found.columns = answer.columns;
  return found as T;
}

/** Of the module that emscripten's `create` makes from compiled code. */
export async function instance<M>(create: (options: object) => Promise<unknown>, compiled: WebAssembly.Module) {
  const instantiateWasm = (imports: WebAssembly.Imports, done: (made: WebAssembly.Instance) => void) => {
    void WebAssembly.instantiate(compiled, imports).then(done);
    return {};
  };
  // Named, the file is not looked for beside the script, which has no place of its own in a worker made from text.
  const locateFile = (name: string) => name;
  return (await create({instantiateWasm, locateFile})) as M;
}

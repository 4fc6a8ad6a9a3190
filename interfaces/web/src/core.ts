// The library, compiled to WebAssembly, with types. All numbers are SI.
import createCore from '#core/wingbeat-core.mjs';
import wasmUrl from '#core/wingbeat-core.wasm?url';
import type * as answers from './answers';
import type {Gradients, Motor, Problem, Tables} from './answers';

export type {Balance, Evidence, Key, Motor, Problem, Quantity, Report, Tables} from './answers';

export type Columns = Record<string, Float64Array>;
export type Values = Record<string, number | string | boolean | null>;
export type Solved = answers.Solved & {columns: Columns};
export type StartUp = answers.StartUp & {columns: Columns};
export type Mechanism = answers.Mechanism & {columns: Columns};
export interface RunOptions {
  condition?: string;
  tolerance?: number;
  frequency?: number;
  lift?: number;
  allow_extrapolation?: boolean;
  endurance?: boolean;
  rows?: number;
}
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

interface Answer {
  json: string;
  columns?: Columns;
}
interface Module {
  tables(): string;
  read(text: string, name: string, tables: string): Answer;
  values(text: string, changes: string): Answer;
  edited(text: string, changes: string): Answer;
  solve(text: string, changes: string, options: string): Answer;
  startUp(text: string, changes: string, options: string): Answer;
  gradients(text: string, changes: string, keys: string, options: string): Answer;
  mechanism(text: string, changes: string, angles: Float64Array): Answer;
  ensemble(text: string, changes: string, keys: string, values: Float64Array, options: string): Answer;
  motors(text: string, changes: string, catalogue: string, gear: number): Answer;
  quantity(text: string, unit: string): Answer;
}

/** `--set` assignments. */
export const assignments = (changes: Stated['changes']) => Object.entries(changes).map(([k, v]) => `${k}=${v}`);

export class Core {
  readonly tables: Tables;
  constructor(private readonly module: Module) {
    this.tables = JSON.parse(module.tables()) as Tables;
  }

  read(text: string, name: string, tables: Record<string, string> = {}): {toml: string; name: string} {
    return unpacked(this.module.read(text, name, JSON.stringify(tables)));
  }
  values(s: Stated): Values {
    return unpacked(this.module.values(s.text, list(s)));
  }
  /** The vehicle file with the changes in it, comments kept. */
  edited(s: Stated): string {
    return unpacked<{toml: string}>(this.module.edited(s.text, list(s))).toml;
  }
  solve(s: Stated, options: RunOptions): Solved {
    return unpacked(this.module.solve(s.text, list(s), pack(options)));
  }
  startUp(s: Stated, options: RunOptions): StartUp {
    return unpacked(this.module.startUp(s.text, list(s), pack(options)));
  }
  gradients(s: Stated, keys: string[], options: RunOptions): Gradients['gradients'] {
    return unpacked<Gradients>(this.module.gradients(s.text, list(s), JSON.stringify(keys), pack(options))).gradients;
  }
  mechanism(s: Stated, angles: Float64Array): Mechanism {
    return unpacked(this.module.mechanism(s.text, list(s), angles));
  }
  ensemble(
    s: Stated,
    keys: string[],
    values: Float64Array,
    options: RunOptions,
  ): {statuses: string[]; columns: Columns} {
    return unpacked(this.module.ensemble(s.text, list(s), JSON.stringify(keys), values, pack(options)));
  }
  /** The SI value of "1200 rpm" for "Hz", as the options of the program read it. */
  quantity(text: string, unit: string): number {
    return unpacked<{value: number}>(this.module.quantity(text, unit)).value;
  }
  motors(s: Stated, catalogue: string, gear: number): Motor[] {
    return unpacked<{motors: Motor[]}>(this.module.motors(s.text, list(s), catalogue, gear)).motors;
  }
}

const list = (s: Stated) => JSON.stringify(assignments(s.changes));
const pack = (options: RunOptions) => JSON.stringify(options);

function unpacked<T>(answer: Answer): T {
  const found = JSON.parse(answer.json) as {errors?: Problem[]; columns?: Columns};
  if (found.errors) throw new Refused(found.errors);
  if (answer.columns) found.columns = answer.columns;
  return found as T;
}

/** The compiled code, from the page itself where it stands in it, else from beside it. */
export async function compiledCore(): Promise<WebAssembly.Module> {
  const embedded = document.getElementById('wingbeat-core')?.textContent;
  if (!embedded) return WebAssembly.compileStreaming(fetch(wasmUrl));
  const packed = Uint8Array.from(atob(embedded), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

export async function startCore(compiled: WebAssembly.Module): Promise<Core> {
  const instantiateWasm = (imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void) => {
    void WebAssembly.instantiate(compiled, imports).then(done);
    return {};
  };
  // Named, the file is not looked for beside the script, which has no place of its own in a worker made from text.
  const locateFile = (name: string) => name;
  return new Core((await createCore({instantiateWasm, locateFile})) as Module);
}

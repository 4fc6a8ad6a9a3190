// The library, compiled to WebAssembly, with types. All numbers are SI.
import createCore from '#core/wingbeat-core.mjs';
import packedUrl from '#packed/wingbeat-core.wasm.xz?url';
import packedFlightUrl from '#packed/wingbeat-flight.wasm.xz?url';
import UnpackWorker from './unpack?worker&inline';
import type * as answers from './answers';
import type {Gradients, Motor, Tables} from './answers';
import {type Answer, type Columns, instance, list, resultOf, type Stated} from './library';

export {assignments, type Columns, Refused, type Stated} from './library';
export type {Balance, Evidence, Key, Motor, Problem, Quantity, Report, Tables} from './answers';

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

export class Core {
  readonly tables: Tables;
  constructor(private readonly module: Module) {
    this.tables = JSON.parse(module.tables()) as Tables;
  }

  read(text: string, name: string, tables: Record<string, string> = {}): {toml: string; name: string} {
    return resultOf(this.module.read(text, name, JSON.stringify(tables)));
  }
  values(s: Stated): Values {
    return resultOf(this.module.values(s.text, list(s)));
  }
  /** The vehicle file with the changes in it, comments kept. */
  edited(s: Stated): string {
    return resultOf<{toml: string}>(this.module.edited(s.text, list(s))).toml;
  }
  solve(s: Stated, options: RunOptions): Solved {
    return resultOf(this.module.solve(s.text, list(s), pack(options)));
  }
  startUp(s: Stated, options: RunOptions): StartUp {
    return resultOf(this.module.startUp(s.text, list(s), pack(options)));
  }
  gradients(s: Stated, keys: string[], options: RunOptions): Gradients['gradients'] {
    return resultOf<Gradients>(this.module.gradients(s.text, list(s), JSON.stringify(keys), pack(options))).gradients;
  }
  mechanism(s: Stated, angles: Float64Array): Mechanism {
    return resultOf(this.module.mechanism(s.text, list(s), angles));
  }
  ensemble(
    s: Stated,
    keys: string[],
    values: Float64Array,
    options: RunOptions,
  ): {statuses: string[]; columns: Columns} {
    return resultOf(this.module.ensemble(s.text, list(s), JSON.stringify(keys), values, pack(options)));
  }
  /** The SI value of "1200 rpm" for "Hz", as the options of the program read it. */
  quantity(text: string, unit: string): number {
    return resultOf<{value: number}>(this.module.quantity(text, unit)).value;
  }
  motors(s: Stated, catalogue: string, gear: number): Motor[] {
    return resultOf<{motors: Motor[]}>(this.module.motors(s.text, list(s), catalogue, gear)).motors;
  }
}

const pack = (options: RunOptions) => JSON.stringify(options);

/** The compiled code, from the page itself where it stands in it, else from beside it. */
export const compiledCore = () => compiled('wingbeat-core', packedUrl);
export const compiledFlight = () => compiled('wingbeat-flight-core', packedFlightUrl);

async function compiled(id: string, url: string): Promise<WebAssembly.Module> {
  const embedded = document.getElementById(id)?.textContent;
  return WebAssembly.compile(await unpacked(embedded ?? (await fetched(url))));
}

async function fetched(url: string): Promise<ArrayBuffer> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

/** In a worker, for the page is to answer meanwhile. */
function unpacked(packed: string | ArrayBuffer): Promise<ArrayBuffer> {
  return new Promise((done, failed) => {
    const worker = new UnpackWorker();
    worker.onmessage = ({data}: MessageEvent<ArrayBuffer | string>) => {
      worker.terminate();
      if (typeof data === 'string') failed(new Error(data));
      else done(data);
    };
    worker.onerror = (event) => failed(new Error(event.message));
    worker.postMessage(packed, typeof packed === 'string' ? [] : [packed]);
  });
}

export const startCore = async (compiled: WebAssembly.Module) => new Core(await instance<Module>(createCore, compiled));

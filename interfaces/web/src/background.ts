// The worker, asked from the page.
import type {Columns, RunOptions, Stated} from './core';
import type {Reply, Task} from './worker';
import ExplorerWorker from './worker?worker&inline';

export interface Ensemble {
  statuses: string[];
  columns: Columns;
}

export class Background {
  private readonly worker = new ExplorerWorker();
  private readonly waiting = new Map<number, {done: (reply: Reply) => void; progress?: (share: number) => void}>();
  private last = 0;

  constructor(compiled: WebAssembly.Module) {
    this.worker.postMessage({compiled});
    this.worker.onmessage = (event: MessageEvent<Reply>) => {
      const waiting = this.waiting.get(event.data.id);
      if (event.data.kind === 'progress') return waiting?.progress?.(event.data.done);
      this.waiting.delete(event.data.id);
      waiting?.done(event.data);
    };
  }

  /** By key and metric; null where a later request overtook it or nothing flaps. */
  async gradients(stated: Stated, keys: string[], options: RunOptions) {
    const reply = await this.ask({kind: 'gradients', stated, keys, options});
    return reply.kind === 'gradients' ? reply.gradients : null;
  }

  async ensemble(
    stated: Stated,
    keys: string[],
    values: Float64Array,
    options: RunOptions,
    chunk: number,
    progress?: (share: number) => void,
  ): Promise<Ensemble> {
    const reply = await this.ask({kind: 'ensemble', stated, keys, values, options, chunk}, progress);
    if (reply.kind !== 'ensemble') throw new Error(reply.kind === 'refused' ? reply.message : reply.kind);
    return reply;
  }

  private ask(task: Task, progress?: (share: number) => void): Promise<Reply> {
    return new Promise((done) => {
      this.waiting.set(++this.last, {done, progress});
      this.worker.postMessage({id: this.last, task});
    });
  }
}

// Workers, asked from the page. Each can be ended: by the user, by a deadline, or because a later request waits.
import type {Tasks} from './worker';
import type {Problem} from './core';
import ExplorerWorker from './worker?worker&inline';
import type {Reply} from './worker_loop';

/** `overtaken`: a later request took its place. `failed`: no answer, with the reason. */
export type Outcome<T> =
  | {kind: 'done'; answer: T; took: number}
  | {kind: 'refused'; problems: Problem[]}
  | {kind: 'overtaken'}
  | {kind: 'failed'; why: string};

/** What can be asked by its kind. */
type Asks<T> = {[K in keyof T]: {ask: unknown; answer: unknown}};

interface Job {
  request: {id: number; kind: PropertyKey; ask: unknown};
  done: (outcome: Outcome<never>) => void;
  progress: ((value: never) => void) | undefined;
  begun: number;
  deadline: number;
}

export class Channel<T extends Asks<T> = Tasks> {
  private worker: Worker | null = null;
  private running: Job | null = null;
  private waiting: Job | null = null;
  private last = 0;
  private clock = 0;
  private impatience = 0;

  /**
   * `deadline` [ms] without an answer or progress, after which a task is ended; `patience` [ms] that a running task
   * keeps while a later one waits.
   */
  constructor(
    private readonly compiled: WebAssembly.Module,
    private readonly deadline: number,
    private readonly patience: number,
    private readonly make: () => Worker = () => new ExplorerWorker(),
  ) {}

  get busy() {
    return this.running !== null;
  }
  /** Since when the running task runs [ms], as performance.now(). */
  get since() {
    return this.running?.begun ?? null;
  }

  /** Starts the worker before it is asked for anything. */
  warm() {
    this.worker ??= this.started();
  }

  /** The latest request wins: one that still waits is overtaken. */
  ask<K extends keyof T>(
    kind: K,
    ask: T[K]['ask'],
    progress?: (value: never) => void,
  ): Promise<Outcome<T[K]['answer']>> {
    return new Promise((done) => {
      const request = {id: ++this.last, kind, ask};
      const job: Job = {request, done, progress, begun: 0, deadline: this.deadline};
      this.waiting?.done({kind: 'overtaken'});
      this.waiting = null;
      if (!this.running) return this.start(job);
      this.waiting = job;
      clearTimeout(this.impatience);
      const left = this.running.begun + this.patience - performance.now();
      this.impatience = window.setTimeout(() => this.end({kind: 'overtaken'}), Math.max(0, left));
    });
  }

  /** Ends what runs; what waits is dropped too. */
  stop(why: string) {
    this.waiting?.done({kind: 'overtaken'});
    this.waiting = null;
    this.end({kind: 'failed', why});
  }

  /** Ends the worker, too; the next request starts another one. */
  close() {
    this.stop('ended');
    this.worker?.terminate();
    this.worker = null;
  }

  private start(job: Job) {
    this.running = job;
    job.begun = performance.now();
    this.worker ??= this.started();
    this.worker.postMessage(job.request);
    this.watch(job);
  }

  private started(): Worker {
    const worker = this.make();
    worker.postMessage({compiled: this.compiled});
    worker.onmessage = (event: MessageEvent<Reply>) => this.received(event.data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.end({kind: 'failed', why: `the computation broke off: ${event.message}`});
    };
    return worker;
  }

  private watch(job: Job) {
    clearTimeout(this.clock);
    const seconds = job.deadline / 1000;
    this.clock = window.setTimeout(
      () => this.end({kind: 'failed', why: `no answer within ${seconds} s`}),
      job.deadline,
    );
  }

  private received(reply: Reply) {
    const job = this.running;
    if (!job || reply.id !== job.request.id) return;
    if ('begun' in reply) return this.watch(job); // the start of the worker does not count
    if ('progress' in reply) {
      job.progress?.(reply.progress as never);
      return this.watch(job);
    }
    // What threw anything else than a refusal may have left the library in disorder: another worker takes over.
    if ('broken' in reply) return this.end({kind: 'failed', why: `the computation broke off: ${reply.broken}`});
    this.finish(
      'refused' in reply
        ? {kind: 'refused', problems: reply.refused}
        : {kind: 'done', answer: reply.answer as never, took: performance.now() - job.begun},
    );
  }

  private end(outcome: Outcome<never>) {
    if (!this.running) return;
    this.worker?.terminate();
    this.worker = null;
    this.finish(outcome);
  }

  private finish(outcome: Outcome<never>) {
    clearTimeout(this.clock);
    clearTimeout(this.impatience);
    const job = this.running,
      next = this.waiting;
    this.running = this.waiting = null;
    if (next) this.start(next);
    job?.done(outcome);
  }
}

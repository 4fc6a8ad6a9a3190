// A library in a worker: one task after the other, each answered once. The page ends the worker to end a task.
import type {Problem} from './answers';
import {Refused} from './library';

export type Reply =
  | {id: number; begun: true}
  | {id: number; progress: unknown}
  | {id: number; answer: unknown}
  | {id: number; refused: Problem[]}
  | {id: number; broken: string};

/** The buffers of all arrays in an answer, which are handed over without a copy. */
function buffersOf(value: unknown, found: ArrayBufferLike[] = []): ArrayBufferLike[] {
  if (value instanceof Float64Array) found.push(value.buffer);
  else if (value && typeof value === 'object') for (const part of Object.values(value)) buffersOf(part, found);
  return found;
}

export function serve<Library, Request extends {id: number}>(
  start: (compiled: WebAssembly.Module) => Promise<Library>,
  answer: (library: Library, request: Request) => unknown,
) {
  let library: Promise<Library> | null = null,
    begun = false;
  self.onmessage = async (event: MessageEvent<Request | {compiled: WebAssembly.Module}>) => {
    if ('compiled' in event.data) {
      library = start(event.data.compiled);
      return;
    }
    const {id} = event.data;
    let reply: Reply;
    try {
      const started = await library!;
      // Once: what precedes it is the start of the worker, which a deadline does not count.
      if (!begun) self.postMessage({id, begun: true} satisfies Reply);
      begun = true;
      reply = {id, answer: answer(started, event.data)};
    } catch (error) {
      reply = error instanceof Refused ? {id, refused: error.problems} : {id, broken: String(error)};
    }
    self.postMessage(reply, {transfer: 'answer' in reply ? (buffersOf(reply.answer) as Transferable[]) : []});
  };
}

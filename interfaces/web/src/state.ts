// What the page shows: a vehicle with changed values, a pinned one to compare with, the conditions; and its link.
import type {RunOptions} from './core';
import {shipped} from './vehicles';

export interface Design {
  name: string;
  text: string;
  changes: Record<string, string>;
}
export interface State {
  design: Design;
  pinned: Design | null;
  condition: string;
  hold: 'voltage' | 'frequency' | 'lift';
  held: number; // [Hz] or [N]
}

export function initialState(): State {
  return {design: shippedDesign('friction2022'), pinned: null, condition: 'air', hold: 'voltage', held: 0};
}

export function shippedDesign(name: string): Design {
  return {name, text: shipped[name], changes: {}};
}

export function runOptions(state: State): RunOptions {
  const options: RunOptions = {condition: state.condition};
  if (state.hold === 'frequency') options.frequency = state.held;
  if (state.hold === 'lift') options.lift = state.held;
  return options;
}

// ---- the link: designs by name and changes; a file of the user's own comes along compressed

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}
async function packed(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream('deflate-raw'));
  return btoa(String.fromCharCode(...bytes))
    .replaceAll('+', '-')
    .replaceAll('/', '_')
    .replaceAll('=', '');
}
async function unpacked(text: string): Promise<string> {
  const bytes = Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
  return new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate-raw')));
}

async function write(design: Design, prefix: string, into: URLSearchParams) {
  into.set(`${prefix}vehicle`, design.name);
  if (shipped[design.name] !== design.text) into.set(`${prefix}file`, await packed(design.text));
  for (const [key, value] of Object.entries(design.changes)) into.append(`${prefix}set`, `${key}=${value}`);
}

async function read(from: URLSearchParams, prefix: string): Promise<Design | null> {
  const name = from.get(`${prefix}vehicle`);
  const file = from.get(`${prefix}file`);
  const text = file ? await unpacked(file) : name ? shipped[name] : undefined;
  if (!name || text === undefined) return null;
  const changes: Record<string, string> = {};
  for (const change of from.getAll(`${prefix}set`)) {
    const equals = change.indexOf('=');
    if (equals > 0) changes[change.slice(0, equals)] = change.slice(equals + 1);
  }
  return {name, text, changes};
}

export async function linkOf(state: State): Promise<string> {
  const link = new URLSearchParams();
  await write(state.design, '', link);
  if (state.pinned) await write(state.pinned, 'a.', link);
  if (state.condition !== 'air') link.set('condition', state.condition);
  if (state.hold !== 'voltage') link.set(state.hold, String(state.held));
  return `#${link}`;
}

/** The state of a link; what it does not say, or says in a way that cannot be read, is the initial state's. */
export async function stateOf(hash: string): Promise<State> {
  const state = initialState();
  if (hash.length < 2) return state;
  const link = new URLSearchParams(hash.slice(1));
  try {
    state.design = (await read(link, '')) ?? state.design;
    state.pinned = await read(link, 'a.');
  } catch {
    return state;
  }
  const condition = link.get('condition');
  if (condition === 'vacuum' || condition === 'wingless') state.condition = condition;
  for (const hold of ['frequency', 'lift'] as const) {
    const held = Number(link.get(hold) ?? NaN);
    if (held > 0) Object.assign(state, {hold, held});
  }
  return state;
}

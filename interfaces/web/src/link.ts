// A state as the fragment of an address: designs by name and changes; a file of the user's own comes along compressed.
import {conditions, type Design, maxPins, type State, stateFor} from './state';

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}
async function packed(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream('deflate-raw'));
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''))
    .replaceAll('+', '-')
    .replaceAll('/', '_')
    .replaceAll('=', '');
}
async function unpacked(text: string): Promise<string> {
  const bytes = Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
  return new TextDecoder('utf-8', {fatal: true}).decode(await through(bytes, new DecompressionStream('deflate-raw')));
}

type Vehicles = Readonly<Record<string, string>>;
const pinPrefixes = Array.from({length: maxPins}, (_, n) => `${String.fromCharCode(97 + n)}.`);

async function write(design: Design, prefix: string, into: URLSearchParams, shipped: Vehicles) {
  into.set(`${prefix}vehicle`, design.name);
  if (shipped[design.name] !== design.text) into.set(`${prefix}file`, await packed(design.text));
  for (const [key, value] of Object.entries(design.changes)) into.append(`${prefix}set`, `${key}=${value}`);
}

async function read(from: URLSearchParams, prefix: string, shipped: Vehicles, problems: string[]) {
  const name = from.get(`${prefix}vehicle`),
    file = from.get(`${prefix}file`);
  if (name === null) return null;
  let text = Object.hasOwn(shipped, name) ? shipped[name] : undefined;
  if (file !== null) {
    try {
      text = await unpacked(file);
    } catch {
      problems.push(`the vehicle file of ${name} in the link is damaged or incomplete`);
      return null;
    }
  }
  if (text === undefined) {
    problems.push(`there is no vehicle ${name} here`);
    return null;
  }
  const changes: Record<string, string> = {};
  for (const change of from.getAll(`${prefix}set`)) {
    const equals = change.indexOf('=');
    if (equals > 0 && equals + 1 < change.length) changes[change.slice(0, equals)] = change.slice(equals + 1);
    else problems.push(`${prefix}set=${change} has no value`);
  }
  return {name, text, changes};
}

/** Begins with a version and ends with a mark, so that a link that was cut off is recognised. */
export async function linkOf(state: State, shipped: Vehicles): Promise<string> {
  const link = new URLSearchParams({v: '2'});
  await write(state.design, '', link, shipped);
  for (const [n, pin] of state.pins.entries()) await write(pin, pinPrefixes[n]!, link, shipped);
  if (state.condition !== 'air') link.set('condition', state.condition);
  if (state.hold !== 'voltage') link.set(state.hold, String(state.held));
  link.set('end', '1');
  return `#${link}`;
}

const known = new RegExp(
  `^(v|end|embed|condition|frequency|lift|([${pinPrefixes.map((p) => p[0]).join('')}]\\.)?(vehicle|file|set))$`,
);

/** The state of a link, or null and why it cannot be used. A link without a fragment has neither. */
export async function stateOf(hash: string, shipped: Vehicles): Promise<{state: State | null; problems: string[]}> {
  const problems: string[] = [];
  if (hash.length < 2) return {state: null, problems};
  const link = new URLSearchParams(hash.slice(1));
  for (const name of new Set(link.keys())) if (!known.test(name)) problems.push(`${name} is not known in a link`);
  if (link.has('v') && link.get('end') !== '1') problems.push('the link is incomplete: its end is missing');
  const design = await read(link, '', shipped, problems);
  if (!link.has('vehicle')) problems.push('the link names no vehicle');
  if (!design) return {state: null, problems};
  const pins: Design[] = [];
  for (const prefix of pinPrefixes) {
    const pin = await read(link, prefix, shipped, problems);
    if (pin) pins.push(pin);
  }
  let state: State = {...stateFor(design), pins};
  const condition = link.get('condition');
  if (condition !== null) {
    const found = conditions.find((c) => c === condition);
    if (found) state = {...state, condition: found};
    else problems.push(`condition=${condition}: expected ${conditions.join(', ')}`);
  }
  for (const hold of ['frequency', 'lift'] as const) {
    const text = link.get(hold);
    if (text === null) continue;
    if (Number(text) > 0 && Number.isFinite(Number(text))) state = {...state, hold, held: Number(text)};
    else problems.push(`${hold}=${text}: expected a number above 0`);
  }
  return {state: problems.length ? null : state, problems};
}

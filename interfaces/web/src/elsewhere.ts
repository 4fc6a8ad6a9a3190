// The state of the page as a command and as a Python program.
import {heldUnit, type State} from './state';

const quoted = (text: string) => (/^[\w.=+-]+$/.test(text) ? text : `"${text.replace(/(["\\$`])/g, '\\$1')}"`);
const python = (text: string) =>
  /^[+-]?\d/.test(text) && Number.isFinite(Number(text))
    ? text
    : text === 'true'
      ? 'True'
      : text === 'false'
        ? 'False'
        : JSON.stringify(text);
/** Vehicles of the page have a name in the program too, the user's own have a file. */
const vehicleOf = (state: State, own: boolean) => (own ? `${state.design.name}.toml` : state.design.name);

export function shellCommand(state: State, own: boolean): string {
  const parts = [`wingbeat run ${quoted(vehicleOf(state, own))}`];
  for (const [key, value] of Object.entries(state.design.changes)) parts.push(`--set ${quoted(`${key}=${value}`)}`);
  if (state.condition !== 'air') parts.push(`--condition ${state.condition}`);
  if (state.hold !== 'voltage') parts.push(`--${state.hold} "${state.held} ${heldUnit[state.hold]}"`);
  return parts.join(' \\\n  ');
}

export function pythonProgram(state: State, own: boolean): string {
  const changes = Object.entries(state.design.changes)
    .map(([key, value]) => `    "${key}": ${python(value)},\n`)
    .join('');
  const options = [
    ...(state.condition !== 'air' ? [`condition="${state.condition}"`] : []),
    ...(state.hold !== 'voltage' ? [`${state.hold}=${state.held}`] : []),
  ].join(', ');
  const vehicle = `vehicle = wb.read(${JSON.stringify(vehicleOf(state, own))})`;
  return (
    `import wingbeat as wb\n\n${vehicle}${changes ? `.replace({\n${changes}})` : ''}\n` +
    `result = vehicle.solve(${options})\nprint(result.status, result.lift_mean, result.power_electrical)\n`
  );
}

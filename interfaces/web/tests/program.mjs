// The program, whose answers the page must give: WINGBEAT_PROGRAM, build/ci's unless given.
import {execFile} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {mkdtemp, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {promisify} from 'node:util';
import {root} from './browser.mjs';

const program = process.env.WINGBEAT_PROGRAM ?? join(root, 'build/ci/wingbeat');
const execute = promisify(execFile);

export async function run(...options) {
  try {
    const {stdout, stderr} = await execute(program, ['run', ...options], {cwd: root});
    return {code: 0, stdout, stderr};
  } catch (error) {
    if (typeof error.code !== 'number') throw error;
    return {code: error.code, stdout: error.stdout, stderr: error.stderr};
  }
}

/** The object of --json, with the flight of a vehicle on a battery, or the sentences of what is refused. */
export async function answer(vehicle, changes, condition) {
  const sets = Object.entries(changes).flatMap(([key, value]) => ['--set', `${key}=${value}`]);
  const file = `data/designs/${vehicle}.toml`;
  const flight = /^type = "battery/m.test(readFileSync(join(root, file), 'utf8')) ? ['--endurance'] : [];
  const {code, stdout, stderr} = await run(file, '--json', ...flight, '--condition', condition, ...sets);
  return code === 2 ? {refused: stderr} : {report: JSON.parse(stdout)};
}

/** A second of `wingbeat fly` as columns; waypoints: time, x, y, height, yaw. */
export async function flightOf({vehicle, sample, height, controller, wind = {}, start = {}, waypoints}) {
  const folder = await mkdtemp(join(tmpdir(), 'flight-'));
  const section = (name, values) =>
    Object.keys(values).length
      ? [`[${name}]`, ...Object.entries(values).map(([key, value]) => `${key} = ${JSON.stringify(value)}`)]
      : [];
  const lines = [
    ...section('study', {vehicle, duration: 1, sample}),
    ...section('start', {height, ...start}),
    ...section('limits', {ground: 0}),
    ...section('controller', {type: controller}),
    ...section('wind', wind),
    ...section('path', {interpolation: 'smooth'}),
  ];
  for (const waypoint of waypoints) {
    const keys = ['time', 'x', 'y', 'height', 'yaw'].map((key, n) => `${key} = ${waypoint[n]}`);
    lines.push('[[waypoint]]', ...keys);
  }
  const plan = join(folder, 'plan.toml'),
    data = join(folder, 'flight.nc');
  await writeFile(plan, lines.join('\n'));
  const {stdout: report} = await execute(program, ['fly', plan, '-o', data, '--json']).catch((error) => {
    if (error.code !== 3) throw error; // it ends early
    return error;
  });
  const read = `import json, netCDF4; d = netCDF4.Dataset(${JSON.stringify(data)})
print(json.dumps({n: v[:].tolist() for n, v in d.variables.items() if v.dtype.kind == "f" and v.ndim == 1}))`;
  const {stdout} = await execute(process.env.PYTHON ?? '/usr/bin/python3', ['-c', read], {maxBuffer: 2 ** 28});
  const {outcome, end_s: end} = JSON.parse(report);
  return {...JSON.parse(stdout.replaceAll('NaN', 'null')), outcome, end};
}

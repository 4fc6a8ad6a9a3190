// The program, whose answers the page must give: WINGBEAT_PROGRAM, build/ci's unless given.
import {execFile} from 'node:child_process';
import {readFileSync} from 'node:fs';
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

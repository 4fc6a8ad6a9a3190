// Free flight: equal to the program's number by number; its controls, its ends, its worker.
import assert from 'node:assert/strict';
import {cpus, loadavg} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {open, root, singleFile} from './browser.mjs';
import {browser, done, page} from './page_each.mjs';
import {choose, idle} from './page_tools.mjs';
import {flightOf} from './program.mjs';

const flying = 'flight-friction2022';
const note = (p = page) => p.textContent('#pilot-note');
const says = (pattern, p = page) =>
  p.waitForFunction(
    ([source]) => new RegExp(source).test(document.querySelector('#pilot-note').textContent),
    [pattern.source],
  );
async function start(vehicle = flying, p = page) {
  await choose(p, '#vehicle', vehicle);
  await p.click('#fly');
  await says(/Trimmed for hover/, p);
}
const time = (p = page) => p.evaluate(() => window.flight.free.time);
/** A number of the list, in the unit shown. */
const number = (name, p = page) =>
  p.evaluate(
    (of) =>
      parseFloat(
        [...document.querySelectorAll('#pilot dt')]
          .find((dt) => dt.textContent === of)
          .nextSibling.textContent.replace('−', '-'),
      ),
    name,
  );

/** Flies in a worker of its own, whatever the page shows: pieces as asked for, all their rows in columns. */
const flown = (vehicle, options, wishes, p = page) =>
  p.evaluate(
    async ([name, how, asked]) => {
      const engine = await window.flight.free.channel();
      const outcome = await engine.ask('begin', {stated: {text: window.shipped[name], changes: {}}, options: how});
      if (outcome.kind !== 'done' || !outcome.answer.flies) return {outcome};
      const columns = {},
        pieces = [];
      for (const wish of asked) {
        const {answer} = await engine.ask('fly', wish);
        for (const [column, numbers] of Object.entries(answer.columns))
          (columns[column] ??= []).push(...Array.from(numbers));
        pieces.push({...answer, columns: null});
      }
      engine.close();
      return {begun: outcome.answer, pieces, columns};
    },
    [vehicle, options, wishes],
  );

// Flights are equal to 1e-6 of these sizes.
const tolerance = 1e-6;
const compared = [
  ['x', 'north_m', 1],
  ['y', 'east_m', 1],
  ['height', 'height_m', 1],
  ['roll', 'roll_rad', 1],
  ['pitch', 'pitch_rad', 1],
  ['yaw', 'yaw_rad', 1],
  ['u', 'u_m_per_s', 1],
  ['w', 'w_m_per_s', 1],
  ['q', 'q_rad_per_s', 10],
  ['control_voltage', 'voltage', 10],
];
const cases = [
  [flying, 'lqr', {}],
  [flying, 'pid', {wind: {north: 0.3, east: -0.2, up: 0.1}}],
  [flying, 'none', {start: {v: 0.1, q: 0.5}}],
  ['flight-purdue', 'lqr', {start: {u: 0.2, p: 1}}],
  ['flight-x-wing', 'pid', {}],
  ['flight-x-wing-battery', 'lqr', {wind: {north: 0.2}}],
];
test('flights are those of the program, number by number', async () => {
  await start();
  for (const [vehicle, controller, how] of cases) {
    const height = 1,
      aim = {north: 0.1, east: -0.05, height: 1.05, yaw: 0.2, within: 0.4};
    const options = {controller, height, ...how};
    const ours = await flown(vehicle, options, [{until: 0.1}, {until: 0.5, aim}, {until: 0.75}, {until: 1}]);
    const changes = ours.pieces[0].time_s;
    const plan = {
      vehicle: join(root, `data/designs/${vehicle}.toml`),
      sample: ours.begun.row_period_s,
      height,
      controller,
      wind: how.wind,
      start: how.start,
      waypoints: [
        [0, 0, 0, height, 0],
        [changes, 0, 0, height, 0],
        [changes + aim.within, aim.north, aim.east, aim.height, aim.yaw],
      ],
    };
    const theirs = await flightOf(plan);
    assert.ok(ours.columns.time_s.length > 300, vehicle);
    const apart = (one, other, size) =>
      one.reduce((most, x, row) => (row < other.length ? Math.max(most, Math.abs(x - other[row]) / size) : most), 0);
    assert.ok(apart(theirs.time.slice(0, -1), ours.columns.time_s, 1) < 1e-9);
    let largest = 0;
    for (const [name, column, size] of compared) {
      // The last row of the program's is at the end of its plan.
      const far = apart(theirs[name].slice(0, -1), ours.columns[column], size);
      largest = Math.max(largest, far);
      assert.ok(far < tolerance, `${vehicle} ${controller} ${name}: ${far}`);
    }
    const rows = Math.min(theirs.time.length, ours.columns.time_s.length);
    console.log(`${vehicle} ${controller}: ${rows} rows, largest difference ${largest.toExponential(1)}`);
    if (!ours.pieces.at(-1).flies) {
      assert.equal(ours.pieces.at(-1).outcome, theirs.outcome);
      assert.ok(Math.abs(ours.pieces.at(-1).time_s - theirs.end) < 1e-6, `${ours.pieces.at(-1).time_s} ${theirs.end}`);
    } else assert.equal(theirs.outcome, 'completed');
    assert.ok(rows > 300 && rows > (0.9 * Math.min(1, theirs.end)) / ours.begun.row_period_s, `${vehicle} ${rows}`);
  }
  await done();
});

test('a set-point is reached by either controller, and a push is recovered with one only', async () => {
  await start();
  for (const controller of ['lqr', 'pid']) {
    const aim = {north: 0.3, east: 0.2, height: 1.2, yaw: 0.5};
    const {columns, pieces} = await flown(flying, {controller, height: 1}, [{until: 0.2}, {until: 5, aim}]);
    assert.ok(pieces[1].flies, pieces[1].detail);
    const last = (name) => columns[name].at(-1);
    for (const [name, wanted] of [
      ['north_m', 0.3],
      ['east_m', 0.2],
      ['height_m', 1.2],
      ['yaw_rad', 0.5],
    ])
      assert.ok(Math.abs(last(name) - wanted) < 0.04, `${controller} ${name} ${last(name)}`);
    assert.equal(last('aim_north_m'), 0.3);
  }
  const push = {v: 0.5};
  const held = await flown(flying, {controller: 'lqr', height: 1}, [{until: 0.2}, {until: 4, push}]);
  assert.ok(held.pieces[1].flies, held.pieces[1].detail);
  assert.ok(Math.abs(held.columns.east_m.at(-1)) < 0.03, String(held.columns.east_m.at(-1)));
  assert.ok(Math.max(...held.columns.east_m) > 0.03);
  const left = await flown(flying, {controller: 'none', height: 1}, [{until: 0.2}, {until: 4, push}]);
  assert.ok(!left.pieces[1].flies);
  assert.equal(left.pieces[1].outcome, 'crashed');
  assert.match(left.pieces[1].detail, /after [\d.]+ s/);
  await done();
});

test('the flight plays in the slow motion chosen; set-points, wind and push act by keyboard', async () => {
  await start();
  assert.equal(await time(), 0); // without animation it waits
  await page.focus('#flight-play');
  await page.keyboard.press('Enter');
  await page.selectOption('#flight-rate', {label: '1 / 5'});
  await page.waitForFunction(() => window.flight.free.time > 0.1);
  assert.ok((await number('electrical power')) > 1);
  await page.focus('#flight-east');
  for (let n = 0; n < 4; ++n) await page.keyboard.press('ArrowRight');
  const asked = Number(await page.inputValue('#flight-east'));
  assert.ok(asked > 0);
  assert.match(await page.getAttribute('#flight-east', 'aria-valuetext'), /^0\.\d+ m$/);
  await page.selectOption('#flight-rate', {label: 'real time'});
  await page.waitForFunction((east) => {
    const {track, time: now} = window.flight.free;
    return Math.abs(track.at(now).east_m - east) < 0.15 * east;
  },
    asked); // prettier-ignore
  await page.focus('#flight-push');
  await page.keyboard.press('Enter');
  await says(/Pushed after/);
  const before = await time();
  await page.waitForFunction((t) => window.flight.free.time > t + 0.15, before);
  await page.click('#flight-play');
  const paused = await time();
  await page.waitForTimeout(300);
  assert.equal(await time(), paused);
  await page.click('#flight-start');
  await says(/Trimmed for hover/);
  assert.equal(await page.inputValue('#flight-east'), '0');
  await done();
});

test('stop ends the worker, another vehicle ends the flight, leaving 3D too', async () => {
  const workers = () => page.workers().length;
  await page.click('#fly'); // the worker that draws stays
  await page.waitForSelector('#flight-view:not([hidden])');
  await page.click('#fly');
  await choose(page, '#vehicle', flying);
  await page.waitForTimeout(500);
  const before = workers();
  await page.click('#fly');
  await says(/Trimmed for hover/);
  assert.equal(workers(), before + 1);
  await page.click('#flight-stop');
  await says(/^Stopped/);
  await page.waitForTimeout(100);
  assert.equal(workers(), before);
  assert.ok(await page.isDisabled('#flight-push'));
  await page.click('#flight-start');
  await says(/Trimmed for hover/);
  await page.evaluate(() => window.explorer.change({'vehicle.mass': '3.5 g'}));
  await idle(page);
  await says(/The vehicle has changed/);
  await page.click('#flight-start');
  await says(/Trimmed for hover/);
  await page.click('#fly');
  await page.waitForTimeout(100);
  assert.ok(workers() <= before + 1); // that of derivatives may have started meanwhile
  assert.ok(await page.isHidden('#flight-view'));
  await done();
});

test('without a body the page says what to add; without a trim, why', async () => {
  await page.click('#fly');
  await page.waitForSelector('#cycle-flight');
  assert.match(await page.textContent('#cycle-flight'), /\[body\].*moments of inertia/s);
  assert.ok(await page.isHidden('#pilot'));
  await choose(page, '#vehicle', flying);
  await says(/Trimmed for hover/);
  assert.ok(await page.isHidden('#cycle-flight'));
  await page.evaluate(() => window.explorer.change({'vehicle.mass': '30 g'}));
  await idle(page);
  await page.click('#flight-start');
  await says(/It cannot be trimmed for hover: \S/);
  assert.ok(await page.isDisabled('#flight-stop'));
  await page.evaluate(() => window.explorer.change({'vehicle.mass': '', 'body.inertia_roll': ''}));
  await choose(page, '#vehicle', 'friction2022');
  assert.ok(await page.isVisible('#cycle-flight'));
  await done();
});

test('a crash is said with its time, when it is shown', async () => {
  await start();
  await page.selectOption('#flight-controller', {label: 'none: controls of hover'});
  await says(/The controls of hover are held/);
  assert.ok(await page.isDisabled('#flight-north'));
  await page.selectOption('#flight-rate', {label: 'real time'});
  await page.click('#flight-play');
  await page.selectOption('#flight-push-kind', {label: 'pitch, 5 rad/s'});
  await page.click('#flight-push');
  await says(/(It tips over: .*|It hits the ground) after [\d.]+ s/);
  assert.ok(await page.isDisabled('#flight-push'));
  await done();
});

test('in the single file too; nothing of it is loaded before; axe is clean; no long task in flight', async () => {
  const other = await open(browser, singleFile);
  const {page: p} = other;
  await start(flying, p);
  await p.waitForSelector('.flight-numbers dd');
  await p.addScriptTag({path: join(root, 'interfaces/web/node_modules/axe-core/axe.min.js')});
  const found = await p.evaluate(() =>
    window.axe.run(document.querySelector('[aria-label="in flight"]'), {resultTypes: ['violations']}),
  );
  assert.deepEqual(
    found.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(' '))}`),
    [],
  );
  await p.evaluate(() => {
    document.querySelector('[aria-label="in flight"]').scrollIntoView();
    window.tasks = [];
    new PerformanceObserver((list) => {
      for (const {duration} of list.getEntries()) window.tasks.push(duration);
    }).observe({type: 'longtask'});
  });
  const client = await p.context().newCDPSession(p);
  await client.send('Performance.enable');
  const measured = async () => {
    const {metrics} = await client.send('Performance.getMetrics');
    const frames = await p.evaluate(() => window.frames_shown);
    return {frames, seconds: metrics.find((m) => m.name === 'ThreadTime').value};
  };
  await p.evaluate(() => {
    const {scene} = window.flight.free,
      show = scene.show.bind(scene);
    window.frames_shown = 0;
    scene.show = (look) => {
      ++window.frames_shown;
      show(look);
    };
  });
  const from = await time(p),
    before = await measured();
  await p.waitForTimeout(4000);
  const after = await measured();
  await client.detach();
  const each = (after.seconds - before.seconds) / (after.frames - before.frames);
  assert.ok(each < 0.025, `${each} s of processor time for a frame`);
  assert.ok((await time(p)) > from, await note(p));
  // Tasks are timed by the clock: where others take the processors, they and the drawing without a graphics card wait.
  if (loadavg()[0] < cpus().length) assert.deepEqual(await p.evaluate(() => window.tasks), []);
  assert.ok((await p.locator('#flight').screenshot()).length > 4000);
  assert.deepEqual(other.problems, []);
  await other.context.close();
  const loaded = () =>
    page.evaluate(() =>
      performance.getEntriesByType('resource').filter((r) => /flight/.test(r.name)).map((r) => r.name),
    ); // prettier-ignore
  assert.deepEqual(await loaded(), []);
  await start();
  assert.equal((await loaded()).filter((name) => /wingbeat-flight\.wasm/.test(name)).length, 1);
  await done();
});

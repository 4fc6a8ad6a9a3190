// What a visitor does, on the hosted page and on the single file opened from disk.
import assert from 'node:assert/strict';
import {readFile, writeFile} from 'node:fs/promises';
import {mkdtempSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {createRequire} from 'node:module';
import {after, before, describe, test} from 'node:test';
import {launch, open, serve, singleFile} from './browser.mjs';
import {answered, choose, compute, idle, openAll, report, type} from './page_tools.mjs';
import {run} from './program.mjs';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const folder = mkdtempSync(join(tmpdir(), 'wingbeat-explorer-'));
let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  server.close();
});

for (const [name, url] of [
  ['hosted', () => server.url],
  ['single file from disk', () => singleFile],
]) {
  describe(name, () => {
    let page, context, problems;
    before(async () => {
      ({page, context, problems} = await open(browser, url()));
    });
    after(async () => {
      assert.deepEqual(problems, []);
      await context.close();
    });

    test('a slider moves every number', async () => {
      const before = await report(page);
      const slider = page.getByLabel('supply.voltage, slider');
      await slider.focus();
      for (let n = 0; n < 5; ++n) await slider.press('PageUp');
      const now = await report(page);
      assert.ok(now.voltage_v > before.voltage_v && now.lift_mean_n > before.lift_mean_n);
      assert.match(await page.textContent('#value-frequency_hz'), /Hz$/);
      await page.click('#restore');
      assert.deepEqual(await report(page), before);
    });

    test("a value with a unit; one without sense is refused in the program's words, and nothing changes", async () => {
      await type(page, 'supply.voltage', '3500 mV');
      assert.equal((await report(page)).voltage_v, 3.5);
      await type(page, 'supply.voltage', '3 parsnips');
      const note = await page.locator('[data-key="supply.voltage"] .complaint').textContent();
      const said = note.replace(/\. In use: 3\.5 V$/, '');
      assert.notEqual(said, note);
      const {stderr} = await run('data/designs/friction2022.toml', '--set', 'supply.voltage=3 parsnips');
      assert.ok(said.length > 20 && stderr.includes(said), `${said} | ${stderr}`);
      assert.equal((await report(page)).voltage_v, 3.5);
    });

    test('sensitivities are the derivatives', async () => {
      await page.waitForSelector('body[data-sensitivities]');
      const bars = page.locator('[data-key="supply.voltage"] .bars');
      await page.waitForFunction(() => document.querySelector('[data-key="supply.voltage"] .bars').title);
      const shown = Number((await bars.getAttribute('title')).match(/lift \+([\d.]+) %/)[1]);
      const slope = await page.evaluate(() => {
        const {core, state, shown} = window.explorer;
        const lift = (voltage) =>
          core.solve(
            {...state.design, changes: {...state.design.changes, 'supply.voltage': String(voltage)}},
            {tolerance: 1e-10},
          ).report.lift_mean_n;
        const v = shown.values['supply.voltage'],
          h = 1e-4 * v;
        return (((lift(v + h) - lift(v - h)) / (2 * h)) * v) / lift(v);
      });
      assert.ok(Math.abs(shown / slope - 1) < 0.03, `${shown} ${slope}`);
    });

    test('a choice that needs other keys gets their starting values', async () => {
      await openAll(page);
      await choose(page, '#key-friction-type', 'none');
      assert.equal((await report(page)).power_friction_w, 0);
      await page.click('#restore');
    });

    test('a shared link gives the same numbers', async () => {
      await type(page, 'supply.voltage', '2.75 V');
      await choose(page, '#condition', 'vacuum');
      await page.waitForFunction(() => location.hash.includes('2.75') && location.hash.includes('vacuum'));
      const other = await open(browser, page.url());
      assert.deepEqual(await report(other.page), await report(page));
      assert.deepEqual(other.problems, []);
      await other.context.close();
      await choose(page, '#condition', 'air');
    });

    test('the TOML saved runs in the program, and opens again', async () => {
      await type(page, 'transmission.crank_radius', '4.5 mm');
      const [saved] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
      const file = join(folder, `${name.split(' ')[0]}.toml`);
      await saved.saveAs(file);
      const {code, stdout} = await run(file, '--json');
      assert.equal(code, 0);
      assert.equal(JSON.parse(stdout).lift_mean_n.toPrecision(11), (await report(page)).lift_mean_n.toPrecision(11));
      assert.match(await readFile(file, 'utf8'), /^#/m, 'comments stay');
      await page.setInputFiles('#file', file);
      await page.waitForFunction((n) => document.querySelector('#vehicle').value === n, name.split(' ')[0]);
      const link = page.url();
      await page.waitForFunction((before) => location.hash.includes('file='), link);
    });

    test('a file with mistakes is answered with all of them', async () => {
      const file = join(folder, 'wrong.toml');
      await writeFile(
        file,
        (await readFile('../../data/designs/friction2022.toml', 'utf8')).replace('[motor]', '[motor]\nshoe_size = 43'),
      );
      await page.setInputFiles('#file', file);
      await page.waitForSelector('#message:not([hidden])');
      const {stderr} = await run(file);
      const said = await page.textContent('#message');
      assert.ok(stderr.includes(said.split('\n')[0].replace('wrong.toml', '')), `${said} | ${stderr}`);
      await choose(page, '#vehicle', 'friction2022');
      assert.ok(await page.locator('#message').isHidden());
    });

    test('a design that locks stops where it stops', async () => {
      await choose(page, '#vehicle', 'friction2022-springs');
      await type(page, 'supply.voltage', '0.8 V');
      const found = await report(page);
      assert.equal(found.status, 'locked');
      assert.match(await page.textContent('#mechanism .rest'), /locked, rests at 34\.5/);
      assert.match(await page.textContent('#headline'), /friction holds/);
      await page.evaluate(() => window.explorer.views.playback.show(1));
      const end = await page.evaluate(() => {
        const angles = window.explorer.shown.startUp.columns.crank_angle_rad;
        return (angles[angles.length - 1] * 180) / Math.PI;
      });
      assert.ok(Math.abs(end - 34.524) < 0.1, String(end));
      await page.click('#restore');
    });

    test('A and B side by side', async () => {
      await choose(page, '#vehicle', 'friction2022');
      await page.click('#pin');
      await idle(page);
      await choose(page, '#vehicle', 'friction2022-springs');
      assert.ok((await page.locator('.curve.ghost').count()) >= 5);
      assert.equal(await page.locator('#mechanism .ghost').count(), 1);
      assert.match(await page.textContent('#metrics tr:has([title="lift_mean_n"])'), /\+33\.2 %/);
      await page.getByRole('button', {name: 'forget A'}).click();
      await idle(page);
      assert.equal(await page.locator('.curve.ghost').count(), 0);
    });

    test('a trend of 200 designs, a map, and a click that takes a design', async () => {
      await choose(page, '#vehicle', 'friction2022');
      await compute(page);
      assert.match(await page.getAttribute('body', 'data-study'), /^200 /);
      await compute(page, {up: 'transmission.crank_radius'});
      assert.match(await page.getAttribute('body', 'data-study'), /^1600 /);
      assert.match(await page.textContent('#study-note'), /flapping/);
      const before = (await report(page)).voltage_v;
      await page.locator('#study-picture .surface').click({position: {x: 300, y: 60}});
      const now = await report(page);
      assert.notEqual(now.voltage_v, before);
      await page.click('#restore');
    });

    test('every vehicle, drive and motor', async () => {
      for (const vehicle of await page.locator('#vehicle option').evaluateAll((all) => all.map((o) => o.value))) {
        if (vehicle === name.split(' ')[0]) continue;
        await choose(page, '#vehicle', vehicle);
        assert.equal((await report(page)).status, 'flapping', vehicle);
        await page.evaluate(() => window.explorer.views.playback.show(0.3));
      }
      await choose(page, '#vehicle', 'friction2022');
      await choose(page, '#motor', {index: 2});
      assert.equal(await page.locator('#message').isHidden(), true, await page.textContent('#message'));
      await page.click('#restore');
    });

    test('pictures and the cycle as files', async () => {
      for (const kind of ['SVG', 'PNG']) {
        for (const picture of ['mechanism', 'power-flow', 'lift']) {
          const [saved] = await Promise.all([
            page.waitForEvent('download'),
            page.getByLabel(`${picture} as ${kind}`).click(),
          ]);
          const content = await readFile(await saved.path());
          assert.ok(content.length > 1500, `${picture} ${kind} ${content.length}`);
          assert.ok(
            kind === 'PNG' ? content.subarray(1, 4).toString() === 'PNG' : content.toString().startsWith('<svg'),
          );
        }
      }
      const [csv] = await Promise.all([page.waitForEvent('download'), page.click('#csv')]);
      const file = join(folder, 'cycle.csv');
      await run('data/designs/friction2022.toml', '--waveforms', file, '--force');
      const ours = (await readFile(await csv.path(), 'utf8')).split('\n'),
        theirs = (await readFile(file, 'utf8')).split('\n');
      assert.equal(ours.length, theirs.length);
      assert.equal(ours[0], theirs[0]);
    });

    test('the tour of six questions', async () => {
      await page.click('#tour');
      for (let step = 1; step <= 6; ++step) {
        await page.waitForFunction((n) => document.body.dataset.tour === String(n), step);
        assert.doesNotMatch(await page.textContent('#tour-panel'), /NaN|undefined|–/);
        await answered(page, step);
        assert.doesNotMatch(await page.textContent('#tour-panel'), /NaN|undefined|–/);
        if (step < 6) await page.getByRole('button', {name: 'next'}).click();
      }
      await page.getByRole('button', {name: 'leave the tour'}).click();
    });

    test('every control is reached by the keyboard, and axe finds nothing serious', async () => {
      await page.evaluate(() => {
        for (const d of document.querySelectorAll('details')) d.open = true;
      });
      await page.evaluate(() => {
        document.activeElement?.blur();
        window.reached = new Set();
      });
      const wanted = await page.evaluate(
        () =>
          [...document.querySelectorAll('button, select, input, summary, [role=slider]')].filter(
            (e) => !e.disabled && e.checkVisibility({visibilityProperty: true}),
          ).length,
      );
      for (let n = 0; n < wanted + 40; ++n) {
        await page.keyboard.press('Tab');
        await page.evaluate(() => window.reached.add(document.activeElement));
      }
      const missed = await page.evaluate(() =>
        [...document.querySelectorAll('button, select, input, summary, [role=slider]')]
          .filter((e) => !e.disabled && e.checkVisibility({visibilityProperty: true}) && !window.reached.has(e))
          .map((e) => e.id || e.textContent),
      );
      assert.deepEqual(missed, []);
      for (const theme of ['light', 'dark']) {
        await page.evaluate((t) => {
          document.documentElement.dataset.theme = t;
        }, theme);
        if (theme === 'light') await page.addScriptTag({path: axe});
        const found = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
        const serious = found.violations
          .filter((v) => ['serious', 'critical'].includes(v.impact))
          .map(
            (v) =>
              `${theme} ${v.id}: ${v.nodes
                .map((n) => n.target.join(' '))
                .slice(0, 3)
                .join(', ')}`,
          );
        assert.deepEqual(serious, []);
      }
    });
  });
}

test('reduced motion: nothing moves by itself', async () => {
  const {page, context, problems} = await open(browser, server.url, {reducedMotion: 'reduce'});
  const before = await page.innerHTML('#mechanism');
  await page.waitForTimeout(300);
  assert.equal(await page.innerHTML('#mechanism'), before);
  assert.deepEqual(problems, []);
  await context.close();
});

test('while a slider moves: what is out of sight waits, no choice is set anew; at rest all is of the last design', async () => {
  const {page, context, problems} = await open(browser, server.url);
  const moving = await page.evaluate(async () => {
    const {explorer} = window;
    await new Promise((done) => setTimeout(done, 500)); // what is seen is known by then
    const {set} = Object.getOwnPropertyDescriptor(HTMLSelectElement.prototype, 'value');
    let chosen = 0;
    Object.defineProperty(HTMLSelectElement.prototype, 'value', {
      ...Object.getOwnPropertyDescriptor(HTMLSelectElement.prototype, 'value'),
      set(value) {
        ++chosen;
        set.call(this, value);
      },
    });
    const read = () => ({
      metrics: document.querySelector('#metrics').textContent,
      power: document.querySelector('#plot-power path.curve').getAttribute('d'),
      headline: document.querySelector('#headline-numbers').textContent,
      rows: explorer.shown.solved.columns.time_s.length,
    });
    const before = read();
    for (let n = 0; n < 5; ++n) {
      const going = explorer.change({'supply.voltage': String(2.6 + 0.01 * n)}, {final: false});
      await Promise.all([going, explorer.idle()]);
    }
    return {before, after: read(), chosen};
  });
  const {before, after} = moving;
  assert.equal(moving.chosen, 0);
  assert.notEqual(after.headline, before.headline);
  assert.equal(after.metrics, before.metrics);
  assert.equal(after.power, before.power);
  assert.ok(after.rows < before.rows);
  await page.waitForFunction((rows) => window.explorer.shown.solved.columns.time_s.length === rows, before.rows);
  const shown = await page.evaluate(() => [
    document.querySelector('#metrics').textContent,
    document.querySelector('#plot-power path.curve').getAttribute('d'),
  ]);
  assert.notEqual(shown[0], before.metrics);
  assert.notEqual(shown[1], before.power);
  // The same as of a change that is final at once.
  const fresh = await page.evaluate(async () => {
    await window.explorer.change({'supply.voltage': '2.7'});
    await window.explorer.change({'supply.voltage': '2.64'});
    return [
      document.querySelector('#metrics').textContent,
      document.querySelector('#plot-power path.curve').getAttribute('d'),
    ];
  });
  assert.deepEqual(shown, fresh);
  assert.deepEqual(problems, []);
  await context.close();
});

test('a pause stops all panels at one instant, those out of sight too', async () => {
  const {page, context} = await open(browser, server.url);
  await page.waitForTimeout(700);
  await page.click('#play');
  const places = await page.evaluate(() =>
    [...document.querySelectorAll('#plots .plot:not([hidden]) .cursor')].map((line) => line.getAttribute('x1')),
  );
  assert.equal(places.length, 6);
  assert.equal(new Set(places).size, 1, places.join());
  await context.close();
});

test('pictures in 3D are drawn in a worker, not by the page', async () => {
  const {page, context, problems} = await open(browser, server.url);
  await page.click('#fly');
  await page.waitForSelector('#flight-view:not([hidden])');
  await page.waitForTimeout(1500);
  const refused = await page.evaluate(() => {
    try {
      document.querySelector('#flight').getContext('webgl2');
      return '';
    } catch (error) {
      return error.name;
    }
  });
  assert.equal(refused, 'InvalidStateError'); // the canvas has been given away
  assert.ok((await page.locator('#flight').screenshot()).length > 4000, 'nothing is drawn');
  assert.deepEqual(problems, []);
  await context.close();
});

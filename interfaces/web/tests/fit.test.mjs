// Keys fitted to a measured cycle in the page.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {done, page} from './page_each.mjs';
import {fileOf, idle, report, type} from './page_tools.mjs';

/** A bench file of the design with other values of keys, from an instant of its cycle on. */
async function bench(changes, noise = 0) {
  const text = await page.evaluate(
    ([values, scatter]) => {
      const {core, state} = window.explorer;
      const stated = {text: state.design.text, changes: {...state.design.changes, ...values}};
      const {time_s, current_a, stroke_angle_rad} = core.solve(stated, {rows: 361, tolerance: 1e-9}).columns;
      const rows = ['time_s,current_a,stroke_angle_rad'];
      let seed = 1;
      const next = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
      for (let n = 0; n < 360; n += 4) {
        const row = (n + 100) % 360;
        rows.push([time_s[n] + 0.5, current_a[row] * (1 + scatter * next()), stroke_angle_rad[row]].join());
      }
      return rows.join('\n');
    },
    [changes, noise],
  );
  await page.setInputFiles('#file', await fileOf('bench.csv', text));
  await page.waitForSelector('#fitting:not([hidden])');
}
const fitted = async () => {
  await page.evaluate(() => delete document.body.dataset.fit);
  await page.click('#fit');
  await page.waitForSelector('body[data-fit]');
  await idle(page);
};
const value = (key) => page.evaluate((k) => window.explorer.values[k], key);

test('a fit finds the friction and the pitch law that a measurement was made with, in one step', async () => {
  const before = await report(page);
  await bench({'friction.radius': '2.1e-3', 'aerodynamics.pitch_coefficient': '6e-3'});
  assert.deepEqual(await page.locator('#fit-keys th').allTextContents(), [
    'friction.radius',
    'aerodynamics.pitch_coefficient',
  ]);
  await fitted();
  assert.ok(Math.abs((await value('friction.radius')) / 2.1e-3 - 1) < 0.003, String(await value('friction.radius')));
  const pitch = await value('aerodynamics.pitch_coefficient');
  assert.ok(Math.abs(pitch / 6e-3 - 1) < 0.003, String(pitch));
  const note = await page.textContent('#fit-note');
  assert.match(note, /friction\.radius 2\.5 mm to 2\.\d+ mm ± [\d.e-]+ %/);
  assert.equal(await page.getAttribute('body', 'data-fit'), 'converged');
  await page.click('#undo');
  assert.deepEqual(await report(page), before);
  await done();
});

test('measured minus model is drawn where it is asked for', async () => {
  await bench({'friction.radius': '2.1e-3'}, 0.02);
  assert.equal(await page.locator('.measured').count(), 2);
  await page.check('#residuals');
  assert.equal(await page.locator('.residual').count(), 2);
  assert.match(await page.textContent('#plot-current .title'), /current, measured − model, mA/);
  assert.equal(await page.locator('#plot-lift .residual').count(), 0);
  await page.uncheck('#residuals');
  assert.equal(await page.locator('.residual').count(), 0);
  await page.getByRole('button', {name: 'remove the measurement'}).click();
  assert.ok(await page.locator('#fitting').isHidden());
  await done();
});

test('a fit can be stopped, and limits that are wrong are marked', async () => {
  await bench({'friction.radius': '2.1e-3'});
  const before = await report(page);
  await page.getByLabel('friction.radius, lower limit of the fit').fill('9 parsnips');
  await page.click('#fit');
  assert.match(await page.textContent('#fit-note'), /parsnips/);
  await page.getByLabel('friction.radius, lower limit of the fit').fill('1 mm');
  for (const key of ['wing.inertia', 'motor.inertia']) await page.selectOption('#fit-add', key);
  await page.click('#fit');
  await page.waitForFunction(() => /Step/.test(document.querySelector('#fit-note').textContent));
  await page.click('#fit');
  await page.waitForFunction(() => /stopped/.test(document.querySelector('#fit-note').textContent));
  assert.equal(await page.textContent('#fit'), 'fit');
  assert.deepEqual(await report(page), before);
  // The page goes on, and so does the next fit.
  await type(page, 'supply.voltage', '2.9 V');
  for (const key of ['wing.inertia', 'motor.inertia']) await page.getByRole('button', {name: `remove ${key}`}).click();
  await fitted();
  await done();
});

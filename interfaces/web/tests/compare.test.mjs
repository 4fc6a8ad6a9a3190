// Several designs compared, a design that hovers, measured cycles, pictures in other pages.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {open} from './browser.mjs';
import {browser, done, page, server} from './page_each.mjs';
import {choose, compute, field, fileOf, idle, openAll, report, type} from './page_tools.mjs';
import {answer} from './program.mjs';

test('several pins, the difference to the first, swapped and forgotten; a link has them all', async () => {
  const first = await report(page);
  await page.click('#pin');
  await idle(page);
  await type(page, 'supply.voltage', '3.3 V');
  const second = await report(page);
  await page.click('#pin');
  await choose(page, '#vehicle', 'friction2022-springs');
  const heads = await page.locator('#metrics thead th').allTextContents();
  assert.deepEqual(heads, ['metric', 'A', 'B', 'present', 'present against A']);
  const row = page.locator('#metrics tr:has([title="lift_mean_n"]) td');
  assert.match((await row.allTextContents())[3], /^\+33\.2 %$/);
  await page.getByRole('button', {name: 'swap B with the present design'}).click();
  assert.deepEqual(await report(page), second);
  assert.match(await page.textContent('#pins'), /B friction2022-springs/);
  await page.waitForFunction(() => location.hash.includes('b.vehicle=friction2022-springs'));
  const other = await open(browser, page.url());
  await idle(other.page);
  assert.equal(await other.page.textContent('#metrics'), await page.textContent('#metrics'));
  await other.context.close();
  await page.getByRole('button', {name: 'forget B'}).click();
  await page.getByRole('button', {name: 'swap A with the present design'}).click();
  assert.deepEqual(await report(page), first);
  await done();
});

test('make it hover: one press gives a design that the program confirms, and undo takes it back', async () => {
  const before = await report(page);
  assert.ok(before.lift_to_weight < 0.5);
  await page.click('#hover');
  await page.waitForSelector('body[data-hover]');
  await idle(page);
  const found = await report(page);
  assert.equal(await page.getAttribute('body', 'data-hover'), 'reached');
  assert.ok(found.lift_to_weight >= 0.9999 && found.lift_to_weight < 1.01, String(found.lift_to_weight));
  assert.equal(found.domain, 'inside');
  const changes = await page.evaluate(() => window.explorer.state.design.changes);
  assert.deepEqual(Object.keys(changes).sort(), ['supply.voltage', 'transmission.crank_radius']);
  const {report: theirs} = await answer('friction2022', changes, 'air');
  assert.equal(found.power_electrical_w.toPrecision(9), theirs.power_electrical_w.toPrecision(9));
  // No neighbour that hovers inside the domain needs less.
  const [volts, radius] = [Number(changes['supply.voltage']), Number(changes['transmission.crank_radius'])];
  for (const [v, r] of [
    [1.02, 1],
    [1, 1.02],
    [1.02, 0.98],
    [0.98, 1.02],
  ]) {
    const near = {'supply.voltage': String(volts * v), 'transmission.crank_radius': String(radius * r)};
    const {report: other} = await answer('friction2022', near, 'air');
    const hovers = other?.status === 'flapping' && other.domain === 'inside' && other.lift_to_weight >= 1;
    if (hovers) assert.ok(other.power_electrical_w > 0.998 * found.power_electrical_w, JSON.stringify(near));
  }
  assert.ok((await page.locator('#hover-picture circle').count()) > 3);
  await page.click('#undo');
  assert.deepEqual(await report(page), before);
  await done();
});

test('make it hover: limits are kept, what is out of reach is said, wrong limits are marked', async () => {
  const limit = page.getByLabel('supply.voltage, upper limit');
  await limit.fill('3 parsnips');
  await page.click('#hover');
  assert.equal(await limit.getAttribute('aria-invalid'), 'true');
  assert.match(await page.textContent('#hover-note'), /supply\.voltage, upper limit: .*parsnips/);
  await limit.fill('3200 mV');
  await page.getByRole('button', {name: 'remove transmission.crank_radius'}).click();
  await page.click('#hover');
  await page.waitForSelector('body[data-hover]');
  assert.match(await page.textContent('#hover-note'), /No design within these limits reaches 1\./);
  assert.ok(Math.abs((await report(page)).voltage_v - 3.2) < 1e-3);
  await done();
});

test('a measured cycle is drawn beside the model, with its deviation', async () => {
  const text = await page.evaluate(() => {
    const {time_s, current_a, lift_n} = window.explorer.shown.solved.columns;
    const rows = ['time_s,current_a,lift_n,temperature'];
    for (let n = 0; n < 360; n += 6) rows.push([time_s[n] + 0.004, current_a[n] + 0.002, lift_n[n] * 1, 20].join());
    return rows.join('\n');
  });
  await page.setInputFiles('#file', await fileOf('bench.csv', text));
  await page.waitForSelector('#measured:not([hidden])');
  const said = await page.textContent('#measured');
  const current = Number(said.match(/current ([\d.]+) mA/)[1]);
  assert.ok(current > 1.5 && current < 2.3, said);
  assert.match(said, /Columns not used: temperature/);
  assert.equal(await page.locator('.measured').count(), 2);
  await page.getByRole('button', {name: 'remove the measurement'}).click();
  assert.equal(await page.locator('.measured').count(), 0);
  await page.setInputFiles('#file', await fileOf('wrong.csv', 'a,b\n1,2\n3,4\n'));
  await page.waitForSelector('#message:not([hidden])');
  assert.match(await page.textContent('#message'), /wrong\.csv: a column time_s or crank_angle_rad is missing/);
  await done();
});

test('a map has a colour for each level of its scale', async () => {
  await compute(page, {up: 'transmission.crank_radius'});
  const fills = (part) => page.$$eval(part, (all) => [...new Set(all.map((e) => e.getAttribute('fill')))]);
  const bands = await fills('#study-picture .bands path');
  assert.ok(bands.length >= 5, `${bands.length} colours`);
  assert.deepEqual(await fills('#study-picture rect[fill]'), bands);
  await done();
});

test('?embed shows the pictures named and nothing else', async () => {
  const other = await open(browser, `${server.url}?embed=mechanism,lift#vehicle=hawkmoth`);
  const visible = await other.page.evaluate(() =>
    [...document.querySelectorAll('[data-picture]')].filter((e) => e.checkVisibility()).map((e) => e.dataset.picture),
  );
  assert.deepEqual(visible, ['mechanism', 'lift']);
  for (const id of ['vehicle', 'controls', 'headline', 'shell', 'metrics'])
    assert.ok(await other.page.locator(`#${id}`).isHidden(), id);
  assert.equal((await report(other.page)).status, 'flapping');
  await other.context.close();
  await done();
});

test('meanings are shown where they are asked for', async () => {
  await openAll(page);
  const meaning = page.locator('#key-supply-voltage-meaning');
  assert.ok(await meaning.isHidden());
  await page.check('#meanings');
  assert.match(await meaning.textContent(), /voltage/);
  assert.ok(await meaning.isVisible());
  assert.ok((await page.locator('#headline .meaning:visible').count()) >= 5);
  await done();
});

test('on a phone the numbers stay in sight while a slider moves', async () => {
  const phone = await open(browser, server.url, {viewport: {width: 390, height: 844}});
  await openAll(phone.page);
  await field(phone.page, 'supply.voltage').scrollIntoViewIfNeeded();
  await phone.page.mouse.wheel(0, 300);
  await phone.page.waitForTimeout(200);
  const box = await phone.page.locator('#value-lift_mean_n').boundingBox();
  assert.ok(box.y >= 0 && box.y + box.height < 200, JSON.stringify(box));
  const covers = await phone.page.evaluate(() => document.querySelector('#headline dl').offsetHeight);
  assert.ok(covers < 140, String(covers));
  for (const key of await phone.page.locator('#hover-keys th').all()) {
    const {width, height} = await key.boundingBox();
    assert.ok(width > 4 * height, `a key of ${width} x ${height}`);
  }
  await phone.context.close();
  await done();
});

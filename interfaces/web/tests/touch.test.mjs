// The mechanism moved by hand, the vehicle in flight, the powers of an instant.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {test} from 'node:test';
import {open, singleFile} from './browser.mjs';
import {browser, done, page, server} from './page_each.mjs';
import {choose, idle, report, type} from './page_tools.mjs';

const grip = (joint, on = page) => on.locator(`.grip[data-joint="${joint}"]`);
const centre = async (joint, on = page) => {
  const {x, y, width, height} = await grip(joint, on).boundingBox();
  return [x + width / 2, y + height / 2];
};
const value = (key, on = page) => on.evaluate((k) => window.explorer.values[k], key);
const depth = () => page.evaluate(() => document.querySelector('#undo').getAttribute('aria-disabled'));
/** Moves a joint by pixels, in some steps. */
async function drag(joint, dx, dy, {release = true} = {}) {
  await grip(joint).scrollIntoViewIfNeeded();
  const [x, y] = await centre(joint);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let n = 1; n <= 6; ++n) await page.mouse.move(x + (dx * n) / 6, y + (dy * n) / 6);
  if (release) await page.mouse.up();
  await idle(page);
}

test('crank pin, hinge and wing tip follow the pointer, and each drag is one step', async () => {
  await page.evaluate(() => window.explorer.views.playback.show(0.1));
  const before = await report(page);
  const start = {
    radius: await value('transmission.crank_radius'),
    offset: await value('transmission.hinge_offset'),
    scale: (await value('wing.planform.scale')) ?? 1,
  };
  const [axis, pin] = await page.evaluate(() => {
    const {mechanism, solved} = window.explorer.shown;
    const angle = solved.columns.crank_angle_rad[36];
    return [
      [mechanism.columns.axis_x[0], mechanism.columns.axis_y[0]],
      [Math.cos(angle), Math.sin(angle)],
    ];
  });
  assert.deepEqual(axis, [0, 0]);
  await drag('pin', 12 * pin[0], -12 * pin[1]); // outwards
  const radius = await value('transmission.crank_radius');
  assert.ok(radius > 1.05 * start.radius && radius < 2 * start.radius, String(radius));
  assert.ok((await report(page)).stroke_amplitude_rad > before.stroke_amplitude_rad);
  assert.match(await page.inputValue('#key-transmission-crank_radius'), /mm$/);
  await drag('hinge', 14, 0);
  const offset = await value('transmission.hinge_offset');
  assert.ok(offset > 1.1 * start.offset, String(offset));
  const [hingeX, hingeY] = await centre('hinge'),
    [tipX, tipY] = await centre('tip');
  await drag('tip', 0.2 * (tipX - hingeX), 0.2 * (tipY - hingeY));
  const scale = await value('wing.planform.scale');
  assert.ok(Math.abs(scale / start.scale / 1.2 - 1) < 0.02, String(scale));
  // The tip is where it was dropped: the drawing follows the wing.
  await page.click('#undo');
  await idle(page);
  assert.equal((await value('wing.planform.scale')) ?? 1, start.scale);
  assert.equal(await value('transmission.hinge_offset'), offset);
  await page.click('#undo');
  await idle(page);
  assert.equal(await value('transmission.hinge_offset'), start.offset);
  assert.equal(await value('transmission.crank_radius'), radius);
  await page.click('#undo');
  assert.deepEqual(await report(page), before);
  assert.equal(await depth(), 'true');
  await done();
});

test('while a joint is held the picture keeps its scale, and the joint stays below the pointer', async () => {
  await page.evaluate(() => window.explorer.views.playback.show(0));
  await drag('tip', 40, 0, {release: false});
  const [x] = await centre('tip');
  assert.equal(await page.getAttribute('body', 'data-dragging'), 'tip');
  const axisHeld = await page.locator('#mechanism .motor, #mechanism .ground').first().getAttribute('d');
  await page.mouse.move(x + 30, 200, {steps: 3});
  await idle(page);
  assert.equal(await page.locator('#mechanism .motor, #mechanism .ground').first().getAttribute('d'), axisHeld);
  await page.mouse.up();
  await idle(page);
  assert.equal(await page.getAttribute('body', 'data-dragging'), null);
  await done();
});

test('a drag is broken off by Escape, and a joint does not go where no vehicle can be built', async () => {
  const before = await report(page);
  await drag('hinge', 15, 0, {release: false});
  assert.notEqual(await value('transmission.hinge_offset'), 0.006);
  await page.keyboard.press('Escape');
  await page.mouse.up();
  assert.deepEqual(await report(page), before);
  assert.equal(await depth(), 'true');
  // A crank longer than its rod is refused in the program's words; the last crank that can be built stays.
  await page.evaluate(() => window.explorer.views.playback.show(0.5));
  const angle = await page.evaluate(() => window.explorer.shown.solved.columns.crank_angle_rad[180]);
  await drag('pin', 300 * Math.cos(angle), -300 * Math.sin(angle), {release: false});
  assert.match(await page.textContent('#drag-note'), /crank_radius|rod_length/);
  await page.mouse.up();
  await idle(page);
  assert.equal(await page.textContent('#drag-note'), '');
  assert.ok((await value('transmission.crank_radius')) <= 0.02);
  await done();
});

test('joints move by the arrow keys, as sliders do', async () => {
  await grip('pin').focus();
  const before = await value('transmission.crank_radius');
  await page.keyboard.press('ArrowUp');
  await idle(page);
  assert.ok(Math.abs((await value('transmission.crank_radius')) / before / 1.01 - 1) < 1e-4);
  assert.match(await grip('pin').getAttribute('aria-valuetext'), /mm$/);
  await page.keyboard.press('PageDown');
  await idle(page);
  assert.ok((await value('transmission.crank_radius')) < 0.93 * before);
  await page.keyboard.press('Control+z');
  await idle(page);
  assert.equal(await value('transmission.crank_radius'), before);
  await done();
});

test('a finger moves a joint', async () => {
  const phone = await open(browser, server.url, {
    viewport: {width: 390, height: 844},
    hasTouch: true,
    isMobile: true,
    reducedMotion: 'reduce',
  });
  const tip = grip('tip', phone.page);
  await tip.scrollIntoViewIfNeeded();
  const [x, y] = await centre('tip', phone.page),
    [hingeX, hingeY] = await centre('hinge', phone.page);
  const client = await phone.context.newCDPSession(phone.page);
  const touch = (kind, points) => client.send('Input.dispatchTouchEvent', {type: kind, touchPoints: points});
  await touch('touchStart', [{x, y}]);
  for (let n = 1; n <= 5; ++n) {
    const share = (0.25 * n) / 5;
    await touch('touchMove', [{x: x + share * (x - hingeX), y: y + share * (y - hingeY)}]);
  }
  await touch('touchEnd', []);
  await idle(phone.page);
  const scale = await value('wing.planform.scale', phone.page);
  assert.ok(Math.abs(scale / 1.25 - 1) < 0.05, String(scale));
  assert.deepEqual(phone.problems, []);
  await phone.context.close();
  await done();
});

test('each mechanism offers the joints that its keys place', async () => {
  for (const [vehicle, joints] of [
    ['two-wing-four-bar', ['pin', 'hinge', 'tip']],
    ['x-wing-crank', ['pin', 'hinge', 'tip']],
    ['direct-drive', ['tip']],
    ['hawkmoth', ['tip']],
  ]) {
    await choose(page, '#vehicle', vehicle);
    const offered = await page.$$eval('.grip:not([hidden])', (all) => all.map((g) => g.dataset.joint));
    assert.deepEqual(offered.sort(), joints.sort(), vehicle);
  }
  await choose(page, '#vehicle', 'x-wing-crank');
  await grip('hinge').focus();
  await page.keyboard.press('ArrowUp');
  await idle(page);
  assert.deepEqual(await page.evaluate(() => Object.keys(window.explorer.state.design.changes)), [
    'transmission.stroke_amplitude',
  ]);
  await done();
});

test('arrows and legend have a rod force where there is a rod', async () => {
  const name = page.locator('#force-name');
  assert.equal(await name.textContent(), 'rod force');
  await choose(page, '#vehicle', 'two-wing-four-bar');
  assert.equal(await name.textContent(), 'coupler force');
  for (const vehicle of ['direct-drive', 'robobee-piezo', 'hawkmoth']) {
    await choose(page, '#vehicle', vehicle);
    assert.ok(await name.isHidden(), vehicle);
    assert.equal(await page.locator('#mechanism .arrow.force').count(), 0, vehicle);
  }
  await done();
});

test('the flows follow the powers of the instant, and their marks the energy that has passed', async () => {
  const flow = () =>
    page.evaluate(() => {
      const {columns, balance} = window.explorer.shown.solved;
      const share = window.explorer.views.playback.share,
        row = Math.round(share * 360);
      return {
        now: [...document.querySelectorAll('#sankey .now')].map((e) => Number(e.getAttribute('stroke-width'))),
        mean: [...document.querySelectorAll('#sankey .flow')].map((e) => Number(e.getAttribute('stroke-width'))),
        marks: [...document.querySelectorAll('#sankey .marks')].map((e) => Number(e.getAttribute('stroke-dashoffset'))),
        input: columns.power_electrical_w[row] / balance.electrical,
        note: document.querySelector('#sankey text.live').textContent,
      };
    });
  const at = async (share) => {
    await page.evaluate((s) => window.explorer.views.playback.show(s), share);
    return flow();
  };
  const early = await at(0.1),
    late = await at(0.4);
  for (const {now, mean, input, note} of [early, late]) {
    assert.ok(now.length >= 4 && now.length <= mean.length);
    assert.ok(Math.abs(now[0] / mean[0] - Math.min(3, Math.abs(input))) < 0.02, `${now[0]} ${mean[0]} ${input}`);
    assert.match(note, /^now [\d.]+ mW (into|from) rotor(, wings)? and (wings|springs)/);
  }
  assert.notDeepEqual(early.now, late.now);
  for (const [n, mark] of late.marks.entries()) if (late.now[n] > 1) assert.ok(mark !== early.marks[n]);
  // A whole cycle later each mark is where the next one was.
  const end = await at(0.99999);
  for (const mark of end.marks) assert.ok(Math.abs(mark / (4 * 26) + 1) < 0.02, String(mark));
  const [saved] = await Promise.all([page.waitForEvent('download'), page.getByLabel('power-flow as SVG').click()]);
  assert.doesNotMatch(await readFile(await saved.path(), 'utf8'), /stroke-dashoffset="-\d{2}/);
  await done();
});

for (const [name, url] of [
  ['hosted', () => server.url],
  ['single file', () => singleFile],
]) {
  test(`in flight, ${name}: loaded when asked for; it falls, climbs or hovers by lift over weight`, async () => {
    const asked = [];
    const other = await open(browser, url());
    const {page: p} = other;
    p.on('request', (request) => asked.push(request.url()));
    assert.equal(
      await p.evaluate(() => performance.getEntriesByType('resource').filter((r) => /flight/.test(r.name)).length),
      0,
    );
    await p.click('#fly');
    await p.waitForFunction(() => /It falls/.test(document.querySelector('#flight-note').textContent));
    if (name === 'hosted')
      assert.ok(
        asked.some((a) => /scenes.*\.js$/.test(a)),
        asked.join(),
      );
    const height = async () => {
      const said = await p.textContent('#flight-note');
      const [, number, unit, way] = said.match(/([\d.e-]+) (n|µ|m|)m (below|above)/);
      return Number(number) * {n: 1e-9, µ: 1e-6, m: 1e-3, '': 1}[unit] * (way === 'below' ? -1 : 1);
    };
    await p.waitForTimeout(1500);
    const first = await height();
    await p.waitForTimeout(700);
    assert.ok(first < 0 && (await height()) < first, 'it falls ever further');
    // Something is drawn: more than the paper's colour.
    const shot = await p.locator('#flight').screenshot();
    assert.ok(shot.length > 4000, String(shot.length));
    await p.evaluate(() => window.explorer.change({'supply.voltage': '6 V'}).then(() => window.explorer.idle()));
    await p.waitForFunction(() => /It climbs/.test(document.querySelector('#flight-note').textContent));
    await p.click('#let-go');
    // From some instants of the cycle it falls at first.
    await p.waitForFunction(() => /above the start/.test(document.querySelector('#flight-note').textContent));
    await p.waitForFunction(() => /m\/s up/.test(document.querySelector('#flight-note').textContent));
    await p.evaluate(() => window.explorer.change({'vehicle.mass': ''}));
    await p.click('#fly');
    assert.ok(await p.locator('#flight-view').isHidden());
    assert.deepEqual(other.problems, []);
    await other.context.close();
    await done();
  });
}

test('wings in flight have the angles of the cycle, and a vehicle of unknown weight stays where it is', async () => {
  await choose(page, '#vehicle', 'robobee-piezo');
  await page.click('#fly');
  await page.waitForFunction(() => /weight is not known/.test(document.querySelector('#flight-note').textContent));
  await type(page, 'supply.amplitude', '0.001 V');
  await page.waitForFunction(() => document.querySelector('#flight-note').textContent.length > 10);
  await done();
});

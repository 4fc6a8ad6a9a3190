// What was wrong with the first explorer, defect by defect.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {after, before, beforeEach, test} from 'node:test';
import {join} from 'node:path';
import {launch, open, root, serve} from './browser.mjs';
import {run} from './program.mjs';
import {answered, choose, compute, field, fileOf, idle, numberIn, openAll, report, type} from './page_tools.mjs';

let server, browser, page, context;
before(async () => {
  server = await serve();
  browser = await launch();
});
beforeEach(async () => {
  await context?.close();
  ({page, context} = await open(browser, server.url));
});
after(async () => {
  await browser.close();
  server.close();
});

const text = (selector) => page.textContent(selector);
const lift = async () => {
  await idle(page);
  return numberIn(await text('#value-lift_mean_n'));
};
const clickPicture = async (x, y) => {
  await page.locator('#study-picture .surface').click({position: {x, y}});
  await idle(page);
};
/** The lift that the command on the page gives. */
async function liftOfCommand() {
  const words = (await text('#shell'))
    .replaceAll('\\\n', ' ')
    .match(/"[^"]*"|\S+/g)
    .map((w) => w.replaceAll('"', ''));
  const {stdout, stderr} = await run(...words.slice(2), '--json');
  assert.ok(stdout, stderr);
  return JSON.parse(stdout).lift_mean_n;
}
const near = (a, b, share = 1e-3) => assert.ok(Math.abs(a / b - 1) < share, `${a} is not ${b}`);
const design = (name) => readFile(join(root, `data/designs/${name}.toml`), 'utf8');

test('1: a click on an earlier picture takes the vehicle of that picture', async () => {
  await compute(page);
  await choose(page, '#vehicle', 'friction2022-springs');
  await clickPicture(300, 60);
  assert.equal(await page.inputValue('#vehicle'), 'friction2022');
  near(await liftOfCommand(), await lift());
  const [saved] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
  assert.equal(saved.suggestedFilename(), 'friction2022.toml');
});

test('1: a picture says that it is of another design, condition or key', async () => {
  const stale = page.locator('#study-stale');
  await compute(page);
  assert.ok(await stale.isHidden());
  await type(page, 'supply.voltage', '2.5 V'); // a place on the picture
  assert.ok(await stale.isHidden());
  await type(page, 'wing.inertia', '8e-8 kg m2');
  assert.match(await stale.textContent(), /Computed for friction2022/);
  await choose(page, '#vehicle', 'friction2022-springs');
  assert.match(await stale.textContent(), /Computed for friction2022,/);
  await choose(page, '#vehicle', 'friction2022');
  assert.ok(await stale.isHidden());
  await choose(page, '#condition', 'vacuum');
  assert.match(await stale.textContent(), /Computed for friction2022/);
  await choose(page, '#condition', 'air');
  await page.selectOption('#across', 'wing.inertia');
  assert.match(await stale.textContent(), /Computed over supply.voltage/);
});

test('1: another metric is drawn at once', async () => {
  await compute(page);
  const before = await text('#study-picture .title');
  await page.selectOption('#metric', 'frequency_hz');
  assert.notEqual(await text('#study-picture .title'), before);
  assert.match(await text('#study-picture .title'), /frequency/);
});

test('1: a vehicle changed while a map is computed does not change whose map it is', async () => {
  await page.selectOption('#up', 'transmission.crank_radius');
  await page.click('#study');
  await choose(page, '#vehicle', 'friction2022-springs');
  await page.waitForSelector('body[data-study^="1600 "]');
  assert.match(await text('#study-picture'), /friction2022/);
  assert.doesNotMatch(await text('#study-picture'), /springs/);
  assert.match(await text('#study-stale'), /Computed for friction2022,/);
  await clickPicture(300, 100);
  assert.equal(await page.inputValue('#vehicle'), 'friction2022');
  near(await liftOfCommand(), await lift());
});

test('1: a picture under a condition and a held frequency gives a design under that condition', async () => {
  await choose(page, '#hold', 'frequency');
  await compute(page);
  await choose(page, '#condition', 'vacuum');
  await clickPicture(300, 60);
  assert.equal(await page.inputValue('#condition'), 'air');
  assert.equal(await page.inputValue('#hold'), 'voltage');
  near(await liftOfCommand(), await lift());
});

test('2: a refused value stays in its field, marked, with the reason below it', async () => {
  await openAll(page);
  for (const [key, wrong, reason] of [
    ['supply.voltage', '3,5 V', /voltage/],
    ['motor.inertia', '-1', /motor\.inertia: must be/],
    ['transmission.crank_radius', '1 m', /.../], // larger than the rod: the reason names another key
  ]) {
    const before = await report(page);
    await type(page, key, wrong);
    const input = field(page, key);
    assert.equal(await input.inputValue(), wrong);
    assert.equal(await input.getAttribute('aria-invalid'), 'true');
    assert.match(await page.textContent(`[data-key="${key}"] .complaint`), reason);
    assert.ok(await page.locator(`[data-key="${key}"] .complaint`).isVisible());
    assert.deepEqual(await report(page), before);
    await type(
      page,
      key,
      {'supply.voltage': '2.9 V', 'motor.inertia': '1.4e-7', 'transmission.crank_radius': '5 mm'}[key],
    );
    assert.equal(await input.getAttribute('aria-invalid'), null);
    assert.equal(await page.textContent(`[data-key="${key}"] .complaint`), '');
  }
});

test('2: the reason is brought to sight where the section is closed', async () => {
  await page.evaluate(() => {
    for (const d of document.querySelectorAll('#controls details')) d.open = false;
    const input = document.querySelector('[data-key="motor.inertia"] input[type=text]');
    input.value = '-1';
    input.dispatchEvent(new Event('change'));
  });
  assert.ok(await page.locator('[data-key="motor.inertia"] .complaint').isVisible());
});

test('3: links that cannot be used say so and keep the address', async () => {
  for (const [hash, reason] of [
    ['#vehicle=unicorn', /no vehicle unicorn/],
    ['#vehicle=friction2022&set=supply.voltage%3D3%20parsnips', /supply\.voltage/],
    ['#vehicle=friction2022&set=supply.volt', /no value/],
    ['#vehicle=friction2022&condition=honey', /honey/],
    ['#vehicle=friction2022&frequency=fast', /fast/],
    ['#vehicle=friction2022&colour=red', /colour/],
    ['#v=2&vehicle=friction2022&set=supply.voltage%3D2.', /incomplete/],
    ['#v=2&vehicle=mine&file=q1bKTMlMVbJSSi1W&end=1', /mine/],
  ]) {
    const other = await open(browser, server.url + hash);
    await idle(other.page);
    await other.page.waitForTimeout(200);
    assert.ok(await other.page.locator('#message').isVisible(), hash);
    assert.match(await other.page.textContent('#message'), reason);
    assert.equal(new URL(other.page.url()).hash, hash);
    await other.context.close();
  }
});

test('3: a link that was cut off is recognised', async () => {
  await type(page, 'supply.voltage', '2.75 V');
  await page.waitForFunction(() => location.hash.includes('2.75'));
  for (const length of [-1, -8, -14]) {
    const other = await open(browser, page.url().slice(0, length));
    assert.ok(await other.page.locator('#message').isVisible());
    await other.context.close();
  }
});

test('4: a frequency out of reach is not flapping', async () => {
  await choose(page, '#hold', 'frequency');
  await page.fill('#held', '500 Hz');
  await page.press('#held', 'Enter');
  await idle(page);
  assert.match(await text('#headline'), /out of reach/);
  assert.match(await text('#headline'), /500 Hz cannot be reached/);
  assert.equal(await page.locator('.status-flapping').count(), 0);
  assert.doesNotMatch(await text('#mechanism .rest'), /flapping/);
});

test('4: held fields take quantities as the program does', async () => {
  await choose(page, '#hold', 'frequency');
  const hold = async (quantity) => {
    await page.fill('#held', quantity);
    await page.press('#held', 'Enter');
    await idle(page);
  };
  const before = await report(page);
  await hold('500 mN');
  assert.equal(await page.inputValue('#held'), '500 mN');
  assert.equal(await page.getAttribute('#held', 'aria-invalid'), 'true');
  assert.match(await text('#held-note'), /expected a frequency such as "22 Hz", got "500 mN"/);
  assert.deepEqual(await report(page), before);
  await hold('1200 rpm');
  near((await report(page)).frequency_hz, 20, 1e-6);
  assert.equal(await page.getAttribute('#held', 'aria-invalid'), null);
  await choose(page, '#hold', 'lift');
  await hold('1 gf');
  near((await report(page)).lift_mean_n, 9.80665e-3, 1e-5);
  near(await liftOfCommand(), 9.80665e-3, 1e-5);
});

test('5: the power flow that is saved has its letters, the power plot its names', async () => {
  const saved = async (picture) => {
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByLabel(`${picture} as SVG`).click()]);
    return readFile(await file.path(), 'utf8');
  };
  const flow = await saved('power-flow');
  const halos = flow.match(/<text[^>]*stroke-width="4px"[^>]*>/g);
  assert.ok(halos.length >= 3);
  for (const halo of halos) assert.match(halo, /paint-order="stroke/);
  const power = await saved('power');
  for (const name of ['electrical', 'motor output', 'friction', 'aerodynamic'])
    assert.ok(power.includes(`>${name}<`), name);
});

test('6: files of the user stay in the list and open again, whatever their ending', async () => {
  const own = (await design('friction2022')).replace('"3 V"', '"2.6 V"');
  for (const name of ['mine.toml', 'second.TOML', 'third.txt']) {
    await page.setInputFiles('#file', await fileOf(name, own));
    await page.waitForFunction((n) => document.querySelector('#vehicle').value === n, name.split('.')[0]);
  }
  await choose(page, '#vehicle', 'hawkmoth');
  await choose(page, '#vehicle', 'mine');
  assert.equal((await report(page)).voltage_v, 2.6);
  await choose(page, '#vehicle', 'hawkmoth');
  await page.setInputFiles('#file', await fileOf('mine.toml', own.replace('2.6 V', '2.7 V')));
  await page.waitForFunction(() => document.querySelector('#vehicle').value === 'mine');
  assert.equal((await report(page)).voltage_v, 2.7);
  await page.waitForFunction(() => location.hash.includes('mine'));
  await page.reload();
  await page.waitForSelector('body[data-ready]');
  assert.equal((await report(page)).voltage_v, 2.7);
  await choose(page, '#vehicle', 'third');
  assert.equal((await report(page)).voltage_v, 2.6);
});

test('6: the same file opens again, and a file named like a vehicle of the page is not taken for it', async () => {
  const file = await fileOf('friction2022.toml', (await design('friction2022')).replace('"3 V"', '"2.6 V"'));
  for (let n = 0; n < 2; ++n) {
    await page.setInputFiles('#file', file);
    await page.waitForFunction(() => document.querySelector('#vehicle').value === 'friction2022-own');
    assert.equal((await report(page)).voltage_v, 2.6);
    assert.match(await text('#shell'), /friction2022-own\.toml/);
    await choose(page, '#vehicle', 'friction2022');
    assert.equal((await report(page)).voltage_v, 3);
  }
  await page.setInputFiles('#file', await fileOf('notes.pdf', 'a,b\n1,2\n'));
  await page.waitForSelector('#message:not([hidden])');
  assert.match(await text('#message'), /no vehicle file/);
});

test('7: the motor of the file comes back, and the list shows which motor it is', async () => {
  const before = await report(page);
  await page.waitForFunction(() => document.querySelector('#motor').options.length > 2);
  const model = await page.evaluate(
    () => [...document.querySelector('#motor').options].find((o) => o.value && !o.disabled).value,
  );
  await choose(page, '#motor', model);
  assert.notEqual((await report(page)).current_mean_a, before.current_mean_a);
  await page.waitForTimeout(400);
  assert.equal(await page.inputValue('#motor'), model);
  await choose(page, '#motor', '');
  assert.deepEqual(await report(page), before);
  await type(page, 'motor.inertia', '2e-7 kg m2');
  await page.waitForFunction(() => document.querySelector('#motor').selectedOptions[0].textContent === 'changed');
});

test('8: no step of the tour is outside the domain without saying so; numbers of the paper are named', async () => {
  await page.click('#tour');
  for (let step = 1; step <= 6; ++step) {
    await page.waitForFunction((n) => document.body.dataset.tour === String(n), step);
    assert.equal((await report(page)).domain, 'inside', `step ${step} as it asks`);
    await answered(page, step);
    const {domain} = await report(page);
    const said = await text('#tour-panel');
    if (domain !== 'inside') assert.match(said, /outside/, `step ${step}`);
    if (step === 3) {
      assert.match(said, /62\.\d % more lift/);
      assert.equal(domain, 'inside');
    }
    if (step === 5) {
      assert.match(said, /19\.3 % less power in this model/);
      assert.match(said, /paper\s+reports about 18 % less/);
    }
    if (step < 6) await page.getByRole('button', {name: 'next'}).click();
  }
});

test('9: sliders span the values of the file that is open', async () => {
  const one = await design('friction2022');
  const other = one.replace('"3 V"', '"9 V"'); // of the same length
  const place = () =>
    page.evaluate(() => Number(document.querySelector('[aria-label="supply.voltage, slider"]').value));
  await page.setInputFiles('#file', await fileOf('other.toml', other));
  await page.waitForFunction(() => document.querySelector('#vehicle').value === 'other');
  await idle(page);
  assert.equal(await place(), 500);
});

test('9: the focus stays where it was', async () => {
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.tagName);
  await openAll(page);
  await page.focus('#key-friction-type');
  await choose(page, '#key-friction-type', 'none');
  assert.equal(await focused(), 'key-friction-type');
  await page.focus('[data-key="friction.type"] .reset');
  await page.keyboard.press('Enter');
  await idle(page);
  assert.equal(await focused(), 'key-friction-type');
  await type(page, 'supply.voltage', '2.9 V');
  await page.focus('#restore');
  await page.keyboard.press('Enter');
  await idle(page);
  assert.equal(await focused(), 'restore');
  await page.click('#pin');
  await idle(page);
  await page.focus('[aria-label="forget A"]');
  await page.keyboard.press('Enter');
  await idle(page);
  assert.notEqual(await focused(), 'BODY');
});

test('9: the pointer over a plot does not stop the animation', async () => {
  await page.locator('#plot-lift').scrollIntoViewIfNeeded();
  await page.locator('#plot-lift').hover({position: {x: 100, y: 60}});
  await page.mouse.move(300, 500);
  await page.locator('#plot-lift').hover({position: {x: 150, y: 60}});
  assert.equal(await page.getAttribute('#play', 'aria-pressed'), 'true');
});

test('9: the theme is remembered', async () => {
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  await page.click('#theme');
  const chosen = await theme();
  assert.ok(chosen);
  await page.reload();
  await page.waitForSelector('body[data-ready]');
  assert.equal(await theme(), chosen);
});

test('9: rounding is not shown as a number', async () => {
  for (const vehicle of ['direct-drive', 'two-wing-direct', 'two-wing-direct-hinge', 'robobee-piezo']) {
    await choose(page, '#vehicle', vehicle);
    const cells = await page.locator('#metrics td, #headline dd').allTextContents();
    for (const cell of cells) assert.doesNotMatch(cell, /e-1\d|[\d.]+ (f|p)[AWN]/, `${vehicle}: ${cell}`);
  }
  await choose(page, '#vehicle', 'direct-drive');
  assert.equal(await text('#value-current_mean_a'), '0 A');
});

test('9: the page shows its version and the notices of all that is in it', async () => {
  const version = (await readFile(join(root, 'CMakeLists.txt'), 'utf8')).match(/project\(wingbeat VERSION (\S+)/)[1];
  assert.ok((await text('#about')).includes(`wingbeat ${version}`));
  await page.click('#about summary');
  await page.waitForFunction(() => document.querySelector('#notices').textContent.length > 1000);
  const notices = await text('#notices');
  for (const owner of [
    'Mike Bostock',
    'Google Inc.',
    'Benoit Jacob',
    'Johan Mabille',
    'Niels Lohmann',
    'Victor Zverovich',
  ])
    assert.ok(notices.includes(owner), owner);
  for (const name of ['d3-shape', 'Boost', 'UDUNITS', 'Emscripten', 'toml++', 'fast_float', 'Redistribution and use'])
    assert.ok(notices.includes(name), name);
});

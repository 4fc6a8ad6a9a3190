// One state with a history; solving that can be ended, and a page that answers meanwhile.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {open} from './browser.mjs';
import {designs, sequence} from './designs.mjs';
import {browser, done, page, server} from './page_each.mjs';
import {choose, compute, field, idle, openAll, report, type} from './page_tools.mjs';
import {answer} from './program.mjs';

/** 60 random edits, with `scripts/test-explorer --all` 300. */
const edits = process.env.WINGBEAT_ALL ? 300 : 60;

const text = (selector) => page.textContent(selector);
const value = async (key) => {
  await openAll(page);
  return field(page, key).inputValue();
};
const hashHas = (part) => page.waitForFunction((p) => location.hash.includes(p), part);

test('undo, redo and Back take vehicle, values, condition and pins with them', async () => {
  await type(page, 'supply.voltage', '2.5 V');
  await hashHas('2.5');
  await choose(page, '#condition', 'vacuum');
  await hashHas('vacuum');
  await choose(page, '#vehicle', 'hawkmoth');
  await hashHas('hawkmoth');
  await page.click('#pin');
  await idle(page);
  assert.equal(await page.locator('#pins li').count(), 1);
  const all = await report(page);
  await page.click('#undo'); // the pin
  await idle(page);
  assert.equal(await page.locator('#pins li').count(), 0);
  await page.click('#undo'); // the vehicle
  assert.equal(await value('supply.voltage'), '2.5 V');
  assert.equal(await page.inputValue('#vehicle'), 'friction2022');
  assert.equal(await page.inputValue('#condition'), 'vacuum');
  await page.click('#undo');
  await page.click('#undo');
  await idle(page);
  assert.equal(await value('supply.voltage'), '3 V');
  assert.equal(await page.getAttribute('#undo', 'aria-disabled'), 'true');
  for (let n = 0; n < 4; ++n) await page.keyboard.press('Control+y');
  assert.deepEqual(await report(page), all);
  assert.equal(await page.inputValue('#vehicle'), 'hawkmoth');
  await done();
});

test('Back and Forward of the browser', async () => {
  await type(page, 'supply.voltage', '2.5 V');
  await hashHas('2.5');
  const before = await report(page);
  await choose(page, '#vehicle', 'hawkmoth');
  await hashHas('hawkmoth');
  await page.goBack();
  await page.waitForFunction(() => document.querySelector('#vehicle').value === 'friction2022');
  assert.deepEqual(await report(page), before);
  assert.equal(await value('supply.voltage'), '2.5 V');
  await page.goForward();
  await page.waitForFunction(() => document.querySelector('#vehicle').value === 'hawkmoth');
  assert.equal((await report(page)).status, 'flapping');
  await done();
});

test('a slider that was dragged is one step', async () => {
  await page.evaluate(() => {
    const slider = document.querySelector('[aria-label="supply.voltage, slider"]');
    for (let n = 500; n < 560; n += 5) {
      slider.value = String(n);
      slider.dispatchEvent(new Event('input'));
    }
    slider.dispatchEvent(new Event('change'));
  });
  const moved = (await report(page)).voltage_v;
  assert.ok(moved > 3);
  await page.click('#undo');
  assert.equal((await report(page)).voltage_v, 3);
  assert.equal(await page.getAttribute('#undo', 'aria-disabled'), 'true');
  await done();
});

test('the last of many requests is what the page shows', async () => {
  const next = sequence(5);
  for (let round = 0; round < 6; ++round) {
    const last = await page.evaluate(
      ([names, volts]) => {
        const {explorer, shipped} = window;
        names.forEach((name, n) => {
          void explorer.go({
            ...explorer.state,
            design: {name, text: shipped[name], changes: {'wing.inertia': volts[n]}},
          });
        });
        return volts.at(-1);
      },
      [
        ['pitch-hinge', 'hawkmoth', 'friction2022', 'friction2022-springs', 'friction2022'],
        Array.from({length: 5}, () => String((6e-8 * (1 + next())).toPrecision(6))),
      ],
    );
    const now = await report(page);
    const {report: theirs} = await answer('friction2022', {'wing.inertia': last}, 'air');
    assert.equal(now.lift_mean_n.toPrecision(9), theirs.lift_mean_n.toPrecision(9));
    assert.equal(await page.inputValue('#vehicle'), 'friction2022');
    assert.ok(await page.locator('#notice').isHidden());
  }
  await done();
});

/** What takes the library long: a piezo at an absurd voltage. */
const slow = () =>
  page.evaluate(() => {
    void window.explorer.go({
      ...window.explorer.state,
      design: {name: 'robobee-piezo', text: window.shipped['robobee-piezo'], changes: {'supply.amplitude': '1e6 V'}},
    });
  });

test('a computation can be stopped; what is shown says of what it is; another state is computed after it', async () => {
  const before = await report(page);
  await slow();
  await page.waitForSelector('#notice:not([hidden])');
  assert.match(await text('#notice'), /robobee-piezo, supply\.amplitude 1e6 V Computing\. .* those of friction2022/);
  await page.click('#stop');
  assert.match(await text('#notice'), /Not computed: stopped\. .* those of friction2022/);
  assert.deepEqual(await report(page), before);
  assert.equal(await page.inputValue('#vehicle'), 'robobee-piezo');
  await choose(page, '#vehicle', 'hawkmoth');
  assert.equal((await report(page)).status, 'flapping');
  assert.ok(await page.locator('#notice').isHidden());
  await done();
});

test('a worker that dies is restarted', async () => {
  await slow();
  await page.evaluate(() => window.explorer.solver.worker.onerror(new ErrorEvent('error', {message: 'killed'})));
  assert.match(await text('#notice'), /broke off: killed/);
  await choose(page, '#vehicle', 'friction2022-springs');
  assert.equal((await report(page)).status, 'flapping');
  await done();
});

test('a computation without an answer ends by itself', async () => {
  await page.evaluate(() => {
    window.explorer.solver.deadline = 500;
  });
  await slow();
  await page.waitForFunction(() => /no answer within 0\.5 s/.test(document.querySelector('#notice').textContent));
  await page.getByRole('button', {name: 'compute again'}).click();
  await page.waitForFunction(() => /Computing|no answer/.test(document.querySelector('#notice').textContent));
  await page.click('#undo');
  assert.equal((await report(page)).status, 'flapping');
  await done();
});

test('a map can be stopped, and the page answers while one is computed', async () => {
  await choose(page, '#vehicle', 'hawkmoth');
  await page.selectOption('#up', 'wing.inertia');
  await page.click('#study');
  await page.waitForFunction(() => document.querySelector('#study').textContent === 'stop');
  await type(page, 'supply.voltage', '5 V');
  assert.equal((await report(page)).voltage_v, 5);
  await page.click('#study');
  assert.match(await text('#study-note'), /Not computed: stopped/);
  await choose(page, '#vehicle', 'friction2022');
  await compute(page);
  assert.match(await text('#study-note'), /^200 designs/);
  await done();
});

test('every vehicle and random edits give the numbers of the program', async () => {
  const values = await page.evaluate(() =>
    Object.fromEntries(
      Object.entries(window.shipped).map(([name, text]) => [name, window.explorer.core.values({text, changes: {}})]),
    ),
  );
  const list = designs(edits + Object.keys(values).length, values);
  let refused = 0;
  let ended = 0;
  for (const {vehicle, changes, condition} of list) {
    const {report: theirs} = await answer(vehicle, changes, condition);
    const ours = await page.evaluate(
      async ([name, changes, condition]) => {
        const {explorer, shipped} = window;
        await explorer.go({...explorer.state, design: {name, text: shipped[name], changes}, condition});
        await explorer.idle();
        const {state, shown} = explorer;
        return state.design.name === name && shown.state === state && shown.solved.report;
      },
      [vehicle, changes, condition],
    );
    const what = `${vehicle} ${JSON.stringify(changes)} ${condition}`;
    if (!theirs) {
      ++refused;
      continue;
    }
    // What the program does not decide either may be ended at the page's deadline.
    if (!ours && theirs.status === null) {
      ++ended;
      continue;
    }
    assert.ok(ours, what);
    assert.equal(ours.status, theirs.status, what);
    for (const key of ['frequency_hz', 'lift_mean_n', 'power_electrical_w']) {
      if (theirs[key] === null || theirs.status !== 'flapping') assert.equal(ours[key], theirs[key], what);
      else assert.ok(Math.abs(ours[key] - theirs[key]) <= 1e-8 * Math.abs(theirs[key]) + 1e-12, `${what}: ${key}`);
    }
  }
  assert.ok(refused <= 0.1 * list.length);
  assert.ok(ended <= 0.02 * list.length);
  await done();
});

test('a change touches only what it changes in numbers and pictures', async () => {
  const kept = await page.evaluate(async () => {
    const {explorer} = window;
    const first = () => [
      document.querySelector('#value-lift_mean_n'),
      ...document.querySelectorAll('#balance td, #metrics th, #sankey text, #mechanism text, #plot-lift .curve'),
    ];
    const before = first(),
      texts = before.map((e) => e.textContent);
    await explorer.change({'supply.voltage': '3.05 V'}, {final: false});
    const after = first();
    return {
      same: after.filter((e, n) => e === before[n]).length,
      changed: after.filter((e, n) => e.textContent !== texts[n]).length,
      count: before.length,
      lift: texts[0],
    };
  });
  assert.ok(kept.count > 40);
  assert.equal(kept.same, kept.count);
  assert.ok(kept.changed > 10);
  const {lift_mean_n} = await report(page);
  const [shown] = (await page.textContent('#value-lift_mean_n')).split(' ');
  assert.ok(Math.abs(Number(shown) / (1e3 * lift_mean_n) - 1) < 1e-3 && kept.lift !== `${shown} mN`);
  await done();
});

test('the mechanism moves on while a slider moves and while a design takes long', async () => {
  const moving = await open(browser, server.url);
  const seen = await moving.page.evaluate(async () => {
    const {explorer} = window,
      {views} = explorer,
      mechanism = document.querySelector('#mechanism');
    const shares = new Set();
    for (let n = 0; n < 20; ++n) {
      await explorer.change({'supply.voltage': String(2.9 + 0.01 * n)}, {final: false});
      shares.add(views.playback.share);
    }
    // As if nothing came for half a second.
    explorer.work = 'solving';
    explorer.asked = performance.now();
    const drawn = new Set();
    for (const end = performance.now() + 500; performance.now() < end;) {
      await new Promise(requestAnimationFrame);
      drawn.add(mechanism.innerHTML);
    }
    explorer.work = 'solved';
    return {shares: shares.size, drawn: drawn.size};
  });
  assert.ok(seen.shares > 10, String(seen.shares));
  assert.ok(seen.drawn > 3, String(seen.drawn));
  assert.deepEqual(moving.problems, []);
  await moving.context.close();
  await done();
});

test('the endurance, which takes longer than the cycle, comes into the table of metrics', async () => {
  await choose(page, '#vehicle', 'friction2022-battery');
  const row = page.locator('#metrics tr:has([title="endurance_s"]) td');
  await row.waitFor({state: 'attached'});
  const {endurance_s} = await report(page);
  assert.ok(endurance_s > 0);
  assert.match(await row.textContent(), /(s|min|h)$/);
  await done();
});

test('a vehicle without the key that was chosen for trends does not change the choice for others', async () => {
  assert.equal(await page.inputValue('#across'), 'supply.voltage');
  await choose(page, '#vehicle', 'direct-drive');
  assert.equal(await page.inputValue('#across'), 'supply.amplitude');
  await choose(page, '#vehicle', 'friction2022-springs');
  assert.equal(await page.inputValue('#across'), 'supply.voltage');
  await done();
});

test('from start to a saved file by the keyboard alone', async () => {
  const tabTo = async (selector) => {
    for (let n = 0; n < 200; ++n) {
      if (await page.evaluate((s) => document.activeElement?.matches(s), selector)) return;
      await page.keyboard.press('Tab');
    }
    assert.fail(`${selector} is not reached`);
  };
  await tabTo('#vehicle');
  await page.keyboard.type('friction2022-springs');
  await idle(page);
  await tabTo('#key-supply-voltage');
  await page.keyboard.press('Control+a');
  await page.keyboard.type('3300 mV');
  await page.keyboard.press('Enter');
  const {voltage_v} = await report(page);
  assert.equal(voltage_v, 3.3);
  await tabTo('#across');
  await tabTo('#study');
  await page.keyboard.press('Enter');
  await page.waitForSelector('body[data-study]');
  await tabTo('#take-best');
  await page.keyboard.press('Enter');
  await idle(page);
  await tabTo('#save');
  const [saved] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Enter')]);
  assert.equal(saved.suggestedFilename(), 'friction2022-springs.toml');
  await done();
});

// What the page explains and what can be taken from it: questions, values of the paper, words, states as text, cards,
// paper, sound, phones.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {test} from 'node:test';
import {open, root, singleFile} from './browser.mjs';
import {browser, done, page, server} from './page_each.mjs';
import {answered, choose, idle, openAll, report, type} from './page_tools.mjs';

test('the tour asks, says whether the answer is right, and counts', async () => {
  await page.click('#tour');
  await page.waitForSelector('body[data-tour="1"]');
  assert.match(await page.textContent('#tour-panel h2'), /\?$/);
  const efficiency = (await report(page)).efficiency_system;
  assert.ok(efficiency > 0.1 && efficiency < 1 / 3);
  await page.getByRole('button', {name: 'more than a third', exact: true}).click();
  await page.waitForSelector('body[data-answered="1"]');
  assert.match(await page.textContent('#tour-panel'), /Not more than a third, but: a tenth to a third\./);
  for (let step = 2; step <= 6; ++step) {
    await page.getByRole('button', {name: 'next'}).click();
    await page.waitForSelector(`body[data-tour="${step}"]`);
    if (step < 6) await answered(page, step);
  }
  await page.getByRole('button', {name: 'it falls'}).click();
  await page.waitForSelector('body[data-answered="6"]');
  const said = await page.textContent('#tour-panel');
  assert.match(said, /Right: it falls\./);
  assert.match(said, /1 of 6 answered at once/);
  await done();
});

test('values of the paper stand beside those of the model where the page shows what they are of', async () => {
  const rows = async () => {
    await idle(page);
    return page.$$eval('#paper-values tbody tr', (all) =>
      all.map((row) => [...row.children].map((cell) => cell.textContent)),
    );
  };
  const [frequency] = await rows();
  assert.match(frequency[0], /flapping frequency/);
  assert.equal(frequency[1], '21.7 Hz');
  assert.ok(Math.abs(Number.parseFloat(frequency[2]) - (await report(page)).frequency_hz) < 0.06);
  assert.match(frequency[3], /figures 17 to 19; used to calibrate/);
  await page.click('#pin');
  await choose(page, '#vehicle', 'friction2022-springs');
  const compared = await rows();
  const lift = compared.find((row) => /mean lift, change by springs/.test(row[0]));
  assert.deepEqual(lift.slice(1, 3), ['33.3 %', '33.2 %']);
  const force = compared.find((row) => /mean magnitude of the rod force, change/.test(row[0]));
  assert.equal(force[1], '−33 %');
  assert.match(force[2], /^−\d/);
  await type(page, 'supply.voltage', '3.1 V');
  assert.deepEqual(await rows(), []);
  await choose(page, '#vehicle', 'hawkmoth');
  assert.deepEqual(await rows(), []);
  // A narrow table does not break words into letters.
  const phone = await open(browser, server.url, {viewport: {width: 390, height: 844}});
  await phone.page.locator('#paper-values').scrollIntoViewIfNeeded();
  const widths = await phone.page.$$eval('#paper-values tbody th', (all) => all.map((th) => th.clientWidth));
  assert.ok(Math.min(...widths) > 90, String(widths));
  await phone.context.close();
  await done();
});

test('a name that is tapped says what it means: of keys, results and words', async () => {
  const meaning = page.locator('#meaning');
  assert.ok(await meaning.isHidden());
  await openAll(page);
  await page.locator('[data-key="transmission.crank_radius"] label').click();
  assert.match(await meaning.textContent(), /^transmission\.crank_radius .*crank radius/);
  assert.ok(await meaning.isVisible());
  await page.keyboard.press('Escape');
  assert.ok(await meaning.isHidden());
  await page.locator('#headline dt', {hasText: 'system efficiency'}).click();
  assert.match(await meaning.textContent(), /^efficiency_system /);
  await page.locator('.arrows b', {hasText: 'rod force'}).click();
  assert.match(await meaning.textContent(), /crank reaction force/);
  await page.locator('h2', {hasText: 'One cycle'}).click();
  assert.ok(await meaning.isHidden());
  const phone = await open(browser, server.url, {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true});
  await phone.page.locator('#headline dt').first().tap();
  const box = await phone.page.locator('#meaning').boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 390 && box.y >= 0, JSON.stringify(box));
  await phone.context.close();
  await done();
});

test('the glossary has every key, every result and the words of the page, and is searched', async () => {
  await page.click('#glossary');
  const terms = () => page.$$eval('#glossary-terms dt', (all) => all.map((t) => t.textContent));
  const all = await terms();
  const known = await page.evaluate(() => {
    const {keys, metrics} = window.explorer.core.tables;
    return [...keys, ...metrics].map((k) => k.key);
  });
  for (const key of known) assert.ok(all.includes(key), key);
  for (const word of ['domain of validity', 'slider-crank', 'rod force']) assert.ok(all.includes(word), word);
  for (const text of await page.$$eval('#glossary-terms dd', (d) => d.map((t) => t.textContent)))
    assert.ok(text.length > 10, text);
  await page.fill('#glossary-search', 'validity');
  const found = await terms();
  assert.ok(found.includes('domain of validity') && found.length < 12, found.join());
  await page.keyboard.press('Escape');
  assert.ok(await page.locator('#glossary-dialog').isHidden());
  await done();
});

test('a page from disk copies its state as text, which opens in a hosted page and in one from disk', async () => {
  const permissions = ['clipboard-read', 'clipboard-write'];
  const disk = await open(browser, singleFile, {permissions});
  await disk.page.evaluate(() =>
    window.explorer.change({'supply.voltage': '2.75 V'}).then(() => window.explorer.idle()),
  );
  await disk.page.click('#link');
  await disk.page.waitForFunction(() => document.querySelector('#link').textContent === 'copied as text');
  const text = await disk.page.evaluate(() => navigator.clipboard.readText());
  assert.match(text, /^v=2&vehicle=friction2022&set=supply\.voltage%3D2\.75/);
  const wanted = await report(disk.page);
  for (const url of [server.url, singleFile]) {
    const other = await open(browser, url, {permissions});
    await other.page.evaluate((t) => navigator.clipboard.writeText(t), text);
    await other.page.keyboard.press('Control+v');
    await other.page.waitForFunction(() => window.explorer.state.design.changes['supply.voltage'] === '2.75 V');
    assert.deepEqual(await report(other.page), wanted);
    await other.page.click('#undo');
    await idle(other.page);
    assert.equal((await report(other.page)).voltage_v, 3);
    await other.page.click('#share');
    await other.page.fill('#share-open', `see ${server.url}#${text}`);
    await other.page.click('#share-take');
    await other.page.waitForFunction(() => window.explorer.state.design.changes['supply.voltage'] === '2.75 V');
    assert.deepEqual(other.problems, []);
    await other.context.close();
  }
  await disk.context.close();
  const hosted = await open(browser, server.url, {permissions});
  await hosted.page.click('#link');
  await hosted.page.waitForFunction(() => document.querySelector('#link').textContent === 'copied');
  assert.match(await hosted.page.evaluate(() => navigator.clipboard.readText()), /^http:\/\/127\.0\.0\.1:\d+\/#v=2/);
  await hosted.context.close();
  await done();
});

test('without a clipboard the text is shown marked; text that is no state is refused with the reason', async () => {
  await page.evaluate(() => Object.defineProperty(navigator, 'clipboard', {value: undefined}));
  await page.click('#link');
  await page.waitForSelector('#share-dialog[open]');
  const marked = await page.evaluate(() => {
    const field = document.activeElement;
    return field.value.slice(field.selectionStart, field.selectionEnd);
  });
  assert.match(marked, /^http.*#v=2.*end=1$/);
  for (const [text, reason] of [
    ['good morning', /no state/],
    ['v=2&vehicle=friction2022&set=supply.volt', /incomplete/],
    ['v=2&vehicle=unicorn&end=1', /no vehicle unicorn/],
    ['v=2&vehicle=friction2022&set=supply.voltage%3D3+parsnips&end=1', /parsnips/],
  ]) {
    await page.fill('#share-open', text);
    await page.click('#share-take');
    await page.waitForFunction(() => document.querySelector('#share-note').textContent);
    assert.match(await page.textContent('#share-note'), reason);
    assert.ok(await page.locator('#share-dialog').isVisible());
  }
  await done();
});

test('the card has the design, its numbers, its pictures and the version', async () => {
  await type(page, 'supply.voltage', '3.3 V');
  await page.click('#share');
  const version = (await readFile(join(root, 'CMakeLists.txt'), 'utf8')).match(/project\(wingbeat VERSION (\S+)/)[1];
  const doi = (await readFile(join(root, 'CITATION.cff'), 'utf8')).match(/^doi: *"?([^"\s]+)/m)?.[1];
  for (const kind of ['svg', 'png']) {
    const [saved] = await Promise.all([page.waitForEvent('download'), page.click(`#card-${kind}`)]);
    assert.equal(saved.suggestedFilename(), `friction2022-card.${kind}`);
    const content = await readFile(await saved.path());
    if (kind === 'png') {
      assert.ok(content.length > 20_000);
      assert.equal(content.readUInt32BE(16), 1520); // pixels
      continue;
    }
    const text = content.toString();
    assert.ok(text.includes(`wingbeat ${version}, ${doi ? `doi:${doi}` : 'no DOI registered'}`));
    assert.match(text, /friction2022, supply\.voltage 3\.3 V/);
    const {frequency_hz: f} = await report(page);
    assert.ok(text.includes(`>${Number(f.toPrecision(4))} Hz<`), String(f));
    assert.ok((text.match(/<svg/g) ?? []).length >= 4);
    assert.doesNotMatch(text, /NaN|undefined|Infinity/);
    await page.evaluate((t) => {
      const parsed = new DOMParser().parseFromString(t, 'image/svg+xml');
      if (parsed.querySelector('parsererror')) throw new Error(parsed.documentElement.textContent);
    }, text);
  }
  await done();
});

test('on paper: pictures, numbers and what they are of, no controls', async () => {
  await page.emulateMedia({media: 'print'});
  const visible = (selector) => page.locator(selector).first().isVisible();
  for (const id of ['#print-state', '#headline', '#mechanism', '#sankey', '#plot-lift', '#metrics', '#about p'])
    assert.ok(await visible(id), id);
  for (const id of ['#parameters', '#vehicle', '#play', '.save', '.grip', '#hover', '#fly', '#study', '#pin'])
    assert.ok(!(await visible(id)), id);
  assert.match(await page.textContent('#print-state'), /^friction2022; wingbeat \d/);
  const pdf = await page.pdf({format: 'A4'});
  const pages = pdf.toString('latin1').match(/\/Type\s*\/Page\b/g).length;
  assert.ok(pages >= 2 && pages <= 6, `${pages} pages`);
  await done();
});

test('sound: off until asked for, at the flapping frequency, which it follows', async () => {
  await page.evaluate(() => {
    window.tones = [];
    for (const name of ['setTargetAtTime']) {
      const real = AudioParam.prototype[name];
      AudioParam.prototype[name] = function (value, ...more) {
        window.tones.push(value);
        return real.call(this, value, ...more);
      };
    }
  });
  assert.equal(await page.getAttribute('#sound', 'aria-pressed'), 'false');
  assert.equal(await page.getAttribute('body', 'data-sound'), null);
  await page.click('#sound');
  await page.waitForSelector('body[data-sound]');
  const heard = async () => Number(await page.getAttribute('body', 'data-sound'));
  const {frequency_hz: first} = await report(page);
  assert.ok(Math.abs((await heard()) / first - 1) < 1e-5);
  assert.ok((await page.evaluate(() => window.tones)).some((t) => Math.abs(t / first - 1) < 1e-9));
  await type(page, 'supply.voltage', '3.6 V');
  const {frequency_hz: second} = await report(page);
  assert.ok(second > first && Math.abs((await heard()) / second - 1) < 1e-5);
  await choose(page, '#vehicle', 'friction2022-springs');
  await type(page, 'supply.voltage', '0.8 V'); // locked
  assert.equal(await page.getAttribute('body', 'data-sound'), null);
  await page.click('#sound');
  assert.equal(await page.getAttribute('#sound', 'aria-pressed'), 'false');
  await done();
});

test('a part of the cycle around the cursor is shown larger, in all plots', async () => {
  const ticks = () => page.$$eval('#plot-lift > g text', (all) => all.map((t) => t.textContent));
  const drawn = () => page.getAttribute('#plot-lift .curve', 'd');
  await page.evaluate(() => window.explorer.views.playback.show(0.5));
  const [whole, curve] = [await ticks(), await drawn()];
  await page.selectOption('#zoom', '4');
  assert.notDeepEqual(await ticks(), whole);
  assert.notEqual(await drawn(), curve);
  const x = Number(await page.getAttribute('#plot-lift .cursor', 'x1'));
  assert.ok(Math.abs(x - (52 + 412) / 2) < 2, String(x)); // in the middle of the frame
  await page.locator('#plot-lift').scrollIntoViewIfNeeded();
  const box = await page.locator('#plot-lift').boundingBox();
  await page.mouse.click(box.x + (52 / 420) * box.width + 1, box.y + box.height / 2);
  const share = await page.evaluate(() => window.explorer.views.playback.share);
  assert.ok(Math.abs(share - 0.375) < 0.01, String(share));
  await page.evaluate(() => window.explorer.views.playback.show(0.9));
  assert.ok(await page.locator('#plot-lift .cursor').isHidden());
  await page.selectOption('#abscissa', 'crank angle');
  await page.selectOption('#zoom', '1');
  await page.selectOption('#abscissa', 'time');
  assert.deepEqual(await ticks(), whole);
  await done();
});

test('axe finds nothing serious in dialogs, tour, fit and flight', async () => {
  const axe = join(root, 'interfaces/web/node_modules/axe-core/axe.min.js');
  await page.addScriptTag({path: axe});
  const check = async (where) => {
    const found = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
    const serious = found.violations
      .filter((v) => ['serious', 'critical'].includes(v.impact))
      .map((v) => `${where} ${v.id}: ${v.nodes.map((n) => n.target.join(' ')).slice(0, 3)}`);
    assert.deepEqual(serious, []);
  };
  await page.click('#glossary');
  await check('glossary');
  await page.keyboard.press('Escape');
  await page.click('#share');
  await check('share');
  await page.keyboard.press('Escape');
  await page.click('#tour');
  await page.waitForSelector('body[data-tour="1"]');
  await check('question');
  await answered(page, 1);
  await page.click('#fly');
  await page.waitForSelector('#flight-view:not([hidden])');
  await page.evaluate(() => {
    const {time_s, lift_n} = window.explorer.shown.solved.columns;
    window.explorer.views.measure({name: 'a.csv', columns: {time_s, lift_n}, ignored: []});
  });
  await check('answer, flight, fit');
  await done();
});

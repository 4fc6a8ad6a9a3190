// The page in Debian's firefox-esr, which playwright drives by WebDriver BiDi; skipped where it is not installed.
import assert from 'node:assert/strict';
import {existsSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {firefox} from 'playwright-core';
import {patience, serve, singleFile} from './browser.mjs';
import {answer} from './program.mjs';

const executablePath = process.env.FIREFOX ?? '/usr/bin/firefox-esr';
const skip = existsSync(executablePath) ? false : `${executablePath} is not installed`;
let server, browser;
before(async () => {
  if (skip) return;
  server = await serve();
  browser = await firefox.launch({channel: 'moz-firefox', executablePath, timeout: patience});
});
after(async () => {
  await browser?.close();
  server?.close();
});

for (const [name, url] of [
  ['hosted', () => server.url],
  ['single file from disk', () => singleFile],
]) {
  test(`Firefox, ${name}: numbers, slider, undo, map, hovering, flight`, {skip}, async () => {
    const page = await browser.newPage({viewport: {width: 1440, height: 900}});
    page.setDefaultTimeout(patience);
    await page.goto(url());
    await page.waitForSelector('body[data-ready]');
    const report = () => page.evaluate(() => window.explorer.idle().then(() => window.explorer.shown.solved.report));
    const {report: theirs} = await answer('friction2022', {}, 'air');
    const first = await report();
    assert.equal(first.lift_mean_n.toPrecision(9), theirs.lift_mean_n.toPrecision(9));
    await page.evaluate(() => {
      const slider = document.querySelector('[aria-label="supply.voltage, slider"]');
      slider.value = '700';
      for (const kind of ['input', 'change']) slider.dispatchEvent(new Event(kind));
    });
    assert.ok((await report()).lift_mean_n > first.lift_mean_n);
    await page.click('#undo');
    assert.deepEqual(await report(), first);
    await page.click('#study');
    await page.waitForSelector('body[data-study^="200 "]');
    await page.click('#hover');
    await page.waitForSelector('body[data-hover="reached"]');
    assert.ok((await report()).lift_to_weight >= 0.9999);
    await page.click('#fly');
    await page.waitForFunction(() =>
      /hovers|No picture in 3D/.test(document.querySelector('#flight-note').textContent),
    );
    assert.ok(await page.isHidden('#message'), await page.textContent('#message'));
    await page.close();
  });
}

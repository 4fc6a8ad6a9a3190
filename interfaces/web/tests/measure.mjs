// What the page costs: scripts/test-explorer --measure.
import {cpus, loadavg} from 'node:os';
import {gzipSync} from 'node:zlib';
import {readFileSync} from 'node:fs';
import {launch, open, serve, singleFile} from './browser.mjs';
import {choose, compute} from './page_tools.mjs';

const server = await serve(),
  browser = await launch();
const {page, context} = await open(browser, server.url);
console.log(`first load: ${server.sent()} bytes compressed`);
const file = readFileSync(singleFile.replace('file://', ''));
console.log(`single file: ${file.length} bytes, ${gzipSync(file).length} compressed`);

/** From an input event of a slider to the picture laid out. */
const sliding = (key) =>
  page.evaluate(async (name) => {
    const slider = document.querySelector(`[aria-label="${name}, slider"]`);
    const times = [];
    for (let n = 0; n < 200; ++n) {
      await new Promise(requestAnimationFrame);
      const begun = performance.now();
      slider.value = String(400 + ((n * 7) % 200));
      slider.dispatchEvent(new Event('input'));
      await window.explorer.idle();
      document.body.getBoundingClientRect(); // style and layout included
      times.push(performance.now() - begun);
    }
    times.sort((a, b) => a - b);
    return {median: times[100], late: times[190]};
  }, key);
const openSections = () =>
  page.evaluate(() => {
    for (const d of document.querySelectorAll('#controls details')) d.open = true;
  });
console.log(`load of the machine: ${loadavg().map((x) => x.toFixed(2))}, ${cpus().length} processors`);
for (const [vehicle, key] of [
  ['friction2022', 'supply.voltage'],
  ['friction2022', 'transmission.crank_radius'],
  ['two-wing-four-bar', 'supply.voltage'],
  ['x-wing-crank', 'supply.voltage'],
  ['hawkmoth', 'supply.voltage'],
  ['pitch-hinge-crank', 'supply.voltage'],
  ['two-wing-direct', 'supply.amplitude'],
  ['two-wing-direct-hinge', 'supply.amplitude'],
  ['purdue-flapper', 'supply.amplitude'],
  ['robobee-piezo', 'supply.amplitude'],
]) {
  await choose(page, '#vehicle', vehicle);
  await openSections();
  const {median, late} = await sliding(key);
  console.log(
    `slider to picture, ${vehicle}, ${key}: median ${median.toFixed(1)} ms, 95 % within ${late.toFixed(1)} ms`,
  );
}
await choose(page, '#vehicle', 'friction2022');

/** Tasks of the main thread: by the clock, in which other threads of a busy machine have their share, and by processor
 * time. */
const traceTasks = () => browser.startTracing(page, {categories: ['toplevel']});
const sayTasks = async (what) => {
  const {traceEvents} = JSON.parse((await browser.stopTracing()).toString());
  const place = ({pid, tid}) => `${pid} ${tid}`;
  const main = new Set(
    traceEvents.filter((e) => e.name === 'thread_name' && e.args.name === 'CrRendererMain').map(place),
  );
  const tasks = traceEvents.filter((e) => e.ph === 'X' && /::RunTask$/.test(e.name) && main.has(place(e)));
  const longest = (key) => Math.round(tasks.reduce((most, e) => Math.max(most, e[key] ?? 0), 0) / 1000);
  const above = (key) => tasks.filter((e) => e[key] > 50_000).length;
  console.log(
    `${what}: longest task ${longest('tdur')} ms of processor time, ${longest('dur')} ms by the clock; ` +
      `above 50 ms: ${above('tdur')} and ${above('dur')}`,
  );
};

// While absurd values, a trend and a map are computed.
await traceTasks();
for (const [vehicle, key, quantity] of [
  ['friction2022', 'wing.inertia', '1e-15'],
  ['friction2022', 'supply.voltage', '1e6 V'],
  ['friction2022', 'motor.inertia', '1e6'],
  ['robobee-piezo', 'supply.amplitude', '1e6 V'],
  ['hawkmoth', 'aerodynamics.air_density', '1e9'],
]) {
  await page.evaluate(
    ([name, changes]) => {
      const {explorer, shipped} = window;
      void explorer.go({...explorer.state, design: {name, text: shipped[name], changes}});
    },
    [vehicle, {[key]: quantity}],
  );
  await page.waitForTimeout(700);
}
await choose(page, '#vehicle', 'friction2022');
await compute(page);
await compute(page, {up: 'transmission.crank_radius'});
await page.click('#hover');
await page.waitForSelector('body[data-hover]');
await page.click('#glossary');
await page.keyboard.press('Escape');
await page.click('#share');
await page.keyboard.press('Escape');
await page.click('#sound');
await page.click('#sound');
const [x, y] = await page.evaluate(() => {
  document.querySelector('#mechanism').scrollIntoView();
  const {left, top} = document.querySelector('.grip[data-joint=tip]').getBoundingClientRect();
  return [left + 14, top + 14];
});
await page.mouse.move(x, y);
await page.mouse.down();
for (let n = 1; n <= 40; ++n) await page.mouse.move(x - n, y, {steps: 2});
await page.mouse.up();
await sayTasks('main thread');
await traceTasks();
await page.click('#fly');
await page.waitForSelector('#flight-view:not([hidden])');
await page.waitForTimeout(1500);
await sayTasks('3D opened');
await page.click('#fly');
await page.selectOption('#up', '');

const memory = async () => {
  const client = await context.newCDPSession(page);
  await client.send('HeapProfiler.collectGarbage');
  await client.detach();
  return page.evaluate(() => [performance.memory.usedJSHeapSize, document.querySelectorAll('*').length]);
};
const many = (count) =>
  page.evaluate(async (updates) => {
    for (let n = 0; n < updates; ++n) {
      await window.explorer.change({'supply.voltage': String(2.5 + (n % 200) / 200)}, {final: false});
    }
  }, count);
await many(500);
const before = await memory();
await many(10000);
await page.waitForTimeout(500);
const after = await memory();
console.log(
  `memory: ${(before[0] / 1e6).toFixed(2)} MB and ${before[1]} elements, after 10,000 updates ${(
    after[0] / 1e6
  ).toFixed(2)} MB and ${after[1]} elements`,
);

await page.click('#restore');
await page.click('#study');
await page.waitForSelector('body[data-study^="200 "]');
console.log(`trend of 200 designs: ${(await page.evaluate(() => document.body.dataset.study)).split(' ')[1]} ms`);
await page.selectOption('#up', 'transmission.crank_radius');
await page.click('#study');
await page.waitForSelector('body[data-study^="1600 "]');
console.log(`map of 1600 designs: ${(await page.evaluate(() => document.body.dataset.study)).split(' ')[1]} ms`);

const begun = [];
for (let n = 0; n < 5; ++n) {
  const other = await open(browser, server.url);
  begun.push(await other.page.evaluate(() => window.firstNumber));
  await other.context.close();
}
console.log(`first number: ${begun.map((t) => Math.round(t)).join(', ')} ms after the navigation began`);
await browser.close();
server.close();

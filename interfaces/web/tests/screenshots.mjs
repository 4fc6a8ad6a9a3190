// Pictures of nine states to look at: scripts/test-explorer --screenshots, into build/explorer/screenshots.
import {join} from 'node:path';
import {launch, open, root, serve} from './browser.mjs';
import {answered, compute, idle} from './page_tools.mjs';

const server = await serve(),
  browser = await launch();
const spilled = [];

const at = (page, share) => page.evaluate((s) => window.explorer.views.playback.show(s), share);
const vehicle = async (page, name) => {
  await page.selectOption('#vehicle', name);
  await idle(page);
};
/** What brings the page to each state, from a fresh page. */
const states = {
  start: (page) => at(page, 0.18),
  compare: async (page) => {
    await page.click('#pin');
    await vehicle(page, 'friction2022-springs');
    await at(page, 0.18);
    await compute(page, {up: 'transmission.crank_radius'});
  },
  locked: async (page) => {
    await vehicle(page, 'friction2022-springs');
    await page.evaluate(() => window.explorer.change({'supply.voltage': '0.8 V'}));
    await idle(page);
    await at(page, 1);
    await compute(page);
  },
  'four-bar': async (page) => {
    await vehicle(page, 'two-wing-four-bar');
    await page.check('#meanings');
    await at(page, 0.1);
  },
  'direct-flight': async (page) => {
    await vehicle(page, 'two-wing-direct-hinge');
    await page.click('#fly');
    await page.waitForSelector('#flight-view:not([hidden])');
    await at(page, 0.1);
  },
  'free-flight': async (page) => {
    await vehicle(page, 'flight-friction2022');
    await page.click('#fly');
    await page.waitForFunction(() => /Trimmed/.test(document.querySelector('#pilot-note').textContent));
    await page.selectOption('#flight-rate', {label: '1 / 5'});
    await page.locator('#flight-play').scrollIntoViewIfNeeded();
    await page.click('#flight-push');
    await page.click('#flight-play');
    await page.waitForFunction(() => window.flight.free.time > 0.4);
    await page.click('#flight-play');
  },
  fit: async (page) => {
    await page.evaluate(() => {
      const {core, state, views} = window.explorer;
      const stated = {text: state.design.text, changes: {'friction.radius': '2.1e-3'}};
      const {time_s, current_a, lift_n} = core.solve(stated, {rows: 91}).columns;
      views.measure({name: 'bench.csv', columns: {time_s, current_a, lift_n}, ignored: ['humidity']});
    });
    await page.check('#residuals');
    await page.click('#fit');
    await page.waitForSelector('body[data-fit]');
    await idle(page);
  },
  hover: async (page) => {
    await page.click('#hover');
    await page.waitForSelector('body[data-hover]');
    await idle(page);
    await at(page, 0.3);
  },
  tour: async (page) => {
    await page.click('#tour');
    for (let step = 1; step <= 5; ++step) {
      await page.waitForSelector(`body[data-tour="${step}"]`);
      if (step === 5) await answered(page, step);
      else await page.getByRole('button', {name: 'next'}).click();
    }
  },
};
/** Shown over the page, in the window alone. */
const dialogs = {
  card: (page) => page.click('#share'),
  glossary: async (page) => {
    await page.click('#glossary');
    await page.fill('#glossary-search', 'friction');
  },
};

for (const width of [1440, 1024, 390]) {
  for (const theme of ['light', 'dark']) {
    const fresh = async () => {
      const opened = await open(browser, server.url, {
        viewport: {width, height: 900},
        colorScheme: theme,
        reducedMotion: 'reduce',
      });
      // A picture of the whole page has in it what lies below the window.
      await opened.page.addStyleTag({content: '.views > .wide { content-visibility: visible !important; }'});
      return opened;
    };
    const shoot = async (page, name, fullPage) => {
      await page.waitForTimeout(500);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      if (wide > 0) spilled.push(`${name} ${width} ${theme}: ${wide} px too wide`);
      await page.screenshot({path: join(root, `build/explorer/screenshots/${name}-${width}-${theme}.png`), fullPage});
    };
    for (const [name, bring] of Object.entries(states)) {
      const {page, context} = await fresh();
      await bring(page);
      await shoot(page, name, true);
      if (name === 'start') await shoot(page, 'top', false);
      await context.close();
    }
    for (const [name, bring] of Object.entries(dialogs)) {
      const {page, context} = await fresh();
      await bring(page);
      await shoot(page, name, false);
      await context.close();
    }
  }
}
await browser.close();
server.close();
console.log(spilled.length ? spilled.join('\n') : 'nothing is wider than the window');

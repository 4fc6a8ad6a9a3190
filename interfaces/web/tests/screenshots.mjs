// Pictures of the page to look at: scripts/test-explorer --screenshots, into build/explorer/screenshots.
import {join} from 'node:path';
import {launch, open, root, serve} from './browser.mjs';

const server = await serve(),
  browser = await launch();
const spilled = [];
for (const width of [1440, 1024, 390]) {
  for (const theme of ['light', 'dark']) {
    const {page, context} = await open(browser, server.url, {
      viewport: {width, height: 900},
      colorScheme: theme,
      reducedMotion: 'reduce',
    });
    const shoot = async (name) => {
      await page.waitForTimeout(400);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      if (wide > 0) spilled.push(`${name} ${width} ${theme}: ${wide} px too wide`);
      await page.screenshot({
        path: join(root, `build/explorer/screenshots/${name}-${width}-${theme}.png`),
        fullPage: true,
      });
    };
    // A picture of the whole page has in it what lies below the window.
    await page.addStyleTag({content: '.views > .wide { content-visibility: visible !important; }'});
    await page.evaluate(() => window.explorer.views.playback.show(0.18));
    if (width === 1440) {
      await page.waitForTimeout(600);
      await page.screenshot({path: join(root, `build/explorer/screenshots/top-${theme}.png`)});
    }
    await shoot('start');
    await page.click('#pin');
    await page.selectOption('#vehicle', 'friction2022-springs');
    await page.evaluate(() => window.explorer.views.playback.show(0.18));
    await page.selectOption('#up', 'transmission.crank_radius');
    await page.click('#study');
    await page.waitForSelector('body[data-study^="1600 "]', {timeout: 120000});
    await shoot('compare');
    await page.evaluate(() => {
      window.explorer.go({...window.explorer.state, pins: []});
      window.explorer.change({'supply.voltage': '0.8 V'});
      return window.explorer.idle().then(() => window.explorer.views.playback.show(1));
    });
    await page.selectOption('#up', '');
    await page.click('#study');
    await page.waitForSelector('body[data-study^="200 "]');
    await shoot('locked');
    if (width === 390 || theme === 'light') {
      for (const vehicle of ['two-wing-four-bar', 'two-wing-direct-hinge']) {
        await page.selectOption('#vehicle', vehicle);
        await page.evaluate(() => window.explorer.views.playback.show(0.1));
        await shoot(vehicle);
      }
      await page.click('#tour');
      for (let n = 0; n < 3; ++n) await page.getByRole('button', {name: 'next'}).click();
      await shoot('tour');
    }
    await context.close();
  }
}
await browser.close();
server.close();
console.log(spilled.length ? spilled.join('\n') : 'nothing is wider than the window');

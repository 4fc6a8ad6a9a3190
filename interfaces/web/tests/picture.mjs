// The picture of README.md: scripts/test-explorer --picture. Chromium makes no WebP of a page but of a canvas.
import {writeFileSync} from 'node:fs';
import {launch, open, serve} from './browser.mjs';

const server = await serve(),
  browser = await launch();
const {page} = await open(browser, server.url, {reducedMotion: 'reduce', colorScheme: 'light'});
await page.waitForSelector('body[data-sensitivities]');
await page.evaluate(() => window.explorer.views.playback.show(0.18));
const png = (await page.screenshot()).toString('base64');
const webp = await page.evaluate(async (data) => {
  const picture = new Image();
  picture.src = `data:image/png;base64,${data}`;
  await picture.decode();
  const canvas = Object.assign(document.createElement('canvas'), {width: picture.width, height: picture.height});
  canvas.getContext('2d').drawImage(picture, 0, 0);
  return canvas.toDataURL('image/webp', 0.8).split(',')[1];
}, png);
writeFileSync(process.argv[2], Buffer.from(webp, 'base64'));
await browser.close();
server.close();

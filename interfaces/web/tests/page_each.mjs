// A page of its own, hosted and without the animation, for each test of a file; `page` and the others are those of the
// test that runs.
import assert from 'node:assert/strict';
import {after, before, beforeEach} from 'node:test';
import {launch, open, serve} from './browser.mjs';

export let server, browser, page;
let context, problems;
before(async () => {
  server = await serve();
  browser = await launch();
});
beforeEach(async () => {
  ({page, context, problems} = await open(browser, server.url, {reducedMotion: 'reduce'}));
});
after(async () => {
  await browser.close();
  server.close();
});

/** Ends a test, whose page had no problems. */
export async function done() {
  assert.deepEqual(problems, []);
  await context.close();
}

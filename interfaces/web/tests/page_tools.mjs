// What tests do with the page, and what they read from it.
import {join} from 'node:path';
import {mkdtemp, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';

/** When nothing is being solved for the state of the page. */
export const idle = (page) => page.evaluate(() => window.explorer.idle?.());

export async function report(page) {
  await idle(page);
  return page.evaluate(() => window.explorer.shown.solved.report);
}

export const field = (page, key) => page.locator(`[data-key="${key}"] :is(input[type=text], select)`);

/** Opens every section of the parameters. */
export const openAll = (page) =>
  page.evaluate(() => {
    for (const d of document.querySelectorAll('#controls details')) d.open = true;
  });

export async function type(page, key, text) {
  await openAll(page);
  await field(page, key).fill(text);
  await field(page, key).press('Enter');
  await idle(page);
}

export async function choose(page, id, value) {
  await page.selectOption(id, value);
  await idle(page);
}

export async function compute(page, {across = 'supply.voltage', up = ''} = {}) {
  await page.evaluate(() => delete document.body.dataset.study);
  await page.selectOption('#across', across);
  await page.selectOption('#up', up);
  await page.click('#study');
  await page.waitForSelector('body[data-study]');
}

/** A file of the name with the text, in a folder of its own. */
export async function fileOf(name, text) {
  const file = join(await mkdtemp(join(tmpdir(), 'explorer-')), name);
  await writeFile(file, text);
  return file;
}

/** The number of a text such as "12.34 mN" in SI. */
export function numberIn(text) {
  const [, number, unit] = text.replace('−', '-').match(/(-?[\d.]+(?:e-?\d+)?)\s*(\S*)/);
  const prefix = unit.length > 1 ? {m: 1e-3, µ: 1e-6, k: 1e3}[unit[0]] : undefined;
  return Number(number) * (prefix ?? 1);
}

/** Asks for the answer of a step of the tour. */
export async function answered(page, step) {
  await page.getByRole('button', {name: 'show the answer'}).click();
  await page.waitForFunction((n) => document.body.dataset.answered === String(n), step);
}

// Debian's Chromium on the page that scripts/build-explorer has built, without a network beyond this machine.
import {createServer} from 'node:http';
import {readFile} from 'node:fs/promises';
import {extname, join, resolve} from 'node:path';
import {gzipSync} from 'node:zlib';
import {chromium} from 'playwright-core';

export const root = resolve(new URL('.', import.meta.url).pathname, '../../..');
const built = process.env.WINGBEAT_EXPLORER ?? join(root, 'build/explorer');
const types = {'.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm'};

/** The site on a port of its own, compressed as hosts do it; `sent()` counts the bytes of bodies. */
export async function serve() {
  let sent = 0;
  const server = createServer(async (request, response) => {
    try {
      const path = new URL(request.url, 'http://localhost').pathname;
      const file = join(built, 'site', path === '/' ? 'index.html' : path);
      const body = gzipSync(await readFile(file));
      sent += body.length;
      response.writeHead(200, {
        'content-type': types[extname(file)] ?? 'application/octet-stream',
        'content-encoding': 'gzip',
      });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  return {url: `http://127.0.0.1:${server.address().port}/`, sent: () => sent, close: () => server.close()};
}

export const singleFile = `file://${join(built, 'wingbeat-explorer.html')}`;

/** How long any wait may take, in ms: a machine may stand still for a minute, and that alone fails no test. */
export const patience = 600_000;

export async function launch() {
  const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
  return chromium.launch({executablePath, args: ['--no-sandbox'], timeout: patience});
}

/** A page at `url`, started; `problems` gathers what the console reports and what asked for the network. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({viewport: {width: 1440, height: 900}, acceptDownloads: true, ...options});
  const problems = [];
  await context.route('**/*', (route) => {
    const {protocol, hostname} = new URL(route.request().url());
    if (/^(data|blob|file):$/.test(protocol) || hostname === '127.0.0.1') return route.continue();
    problems.push(`asked for ${route.request().url()}`);
    return route.abort();
  });
  context.setDefaultTimeout(patience);
  const page = await context.newPage();
  page.on('console', (message) => {
    // Screenshots of WebGL are read back, of which its driver without a graphics card warns.
    if (/GPU stall due to ReadPixels/.test(message.text())) return;
    if (['error', 'warning'].includes(message.type())) problems.push(message.text());
  });
  page.on('pageerror', (error) => problems.push(String(error)));
  await page.goto(url);
  await page.waitForSelector('body[data-ready]').catch(async (error) => {
    throw new Error(`${error.message}\n${problems.join('\n')}\n${await page.textContent('#message')}`);
  });
  return {page, context, problems};
}

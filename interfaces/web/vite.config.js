import {execFileSync} from 'node:child_process';
import {gzipSync} from 'node:zlib';
import {mkdirSync, readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {defineConfig} from 'vite';
import {doi, notices, published, version} from './notices.js';

// scripts/build-explorer says where the core is and where the page goes.
const core = process.env.WINGBEAT_CORE;
const output = process.env.WINGBEAT_EXPLORER;
if (!core || !output) throw new Error('build the explorer by scripts/build-explorer');

/** A library as .xz: a third smaller than gzip makes it, whatever the host does. */
function packed(library) {
  const options = ['--check=crc32', '--lzma2=preset=9e,lc=4,lp=0,pb=0', '--stdout'];
  return execFileSync('xz', options, {input: readFileSync(join(core, `${library}.wasm`)), maxBuffer: 2 ** 26});
}
const parts = join(output, 'parts');
mkdirSync(parts, {recursive: true});
for (const library of ['wingbeat-core', 'wingbeat-flight'])
  writeFileSync(join(parts, `${library}.wasm.xz`), packed(library));
writeFileSync(join(parts, 'notices.txt'), notices());

/** The glue of emscripten names the module, which the page does not load by that name. */
const withoutPlainModule = {
  name: 'without-plain-module',
  generateBundle(_, bundle) {
    for (const name of Object.keys(bundle)) if (name.endsWith('.wasm')) delete bundle[name];
  },
};

/** Beside the hosted page one HTML file with everything in it, for a page opened from disk. */
const singleFile = {
  name: 'single-file',
  closeBundle() {
    const site = join(output, 'site');
    const assets = readdirSync(join(site, 'assets'));
    const page = readFileSync(join(site, 'index.html'), 'utf8');
    const text = (named) => readFileSync(join(site, 'assets', assets.find(named)), 'utf8');
    const embedded = (id, content) => `<script type="text/plain" id="${id}">${content.toString('base64')}</script>\n`;
    const zipped = (content) => gzipSync(content, {level: 9});
    const style = text((name) => name.endsWith('.css')),
      main = text((name) => name.endsWith('.js') && page.includes(name)),
      flight = text((name) => /^scenes.*\.js$/.test(name));
    if (/\bfrom *["']\.|\bimport *["']\./.test(flight)) throw new Error('the flight view is no module of its own');
    const html = page
      .replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${style}</style>`)
      .replace(/<script type="module"[^>]*><\/script>/, '')
      .replace(
        '</body>',
        () =>
          embedded('wingbeat-core', readFileSync(join(parts, 'wingbeat-core.wasm.xz'))) +
          embedded('wingbeat-flight-core', readFileSync(join(parts, 'wingbeat-flight.wasm.xz'))) +
          embedded('wingbeat-flight', zipped(flight)) +
          embedded('wingbeat-notices', zipped(notices())) +
          `<script type="module">${main.replaceAll('</script', '<\\/script')}</script>\n</body>`,
      );
    writeFileSync(join(output, 'wingbeat-explorer.html'), html);
  },
};

export default defineConfig({
  base: './',
  define: {
    __VERSION__: JSON.stringify(version()),
    __DOI__: JSON.stringify(doi()),
    __PUBLISHED__: JSON.stringify(published()),
  },
  resolve: {alias: {'#core': resolve(core), '#packed': resolve(parts), '#data': resolve('../../data')}},
  build: {
    outDir: join(output, 'site'),
    emptyOutDir: true,
    assetsInlineLimit: 0,
    modulePreload: false,
    target: 'es2022',
  },
  server: {fs: {strict: false}},
  plugins: [withoutPlainModule, singleFile],
});

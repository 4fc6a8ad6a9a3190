import {gzipSync} from 'node:zlib';
import {readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {defineConfig} from 'vite';
import {notices, version} from './notices.js';

// scripts/build-explorer says where the core is and where the page goes.
const core = process.env.WINGBEAT_CORE;
const output = process.env.WINGBEAT_EXPLORER;
if (!core || !output) throw new Error('build the explorer by scripts/build-explorer');

/** Beside the hosted page one HTML file with everything in it, for a page opened from disk. */
const singleFile = {
  name: 'single-file',
  closeBundle() {
    const site = join(output, 'site');
    const assets = readdirSync(join(site, 'assets'));
    const text = (ending) =>
      readFileSync(
        join(
          site,
          'assets',
          assets.find((name) => name.endsWith(ending)),
        ),
        'utf8',
      );
    const wasm = gzipSync(readFileSync(join(core, 'wingbeat-core.wasm')), {level: 9}).toString('base64');
    const html = readFileSync(join(site, 'index.html'), 'utf8')
      .replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${text('.css')}</style>`)
      .replace(/<script type="module"[^>]*><\/script>/, '')
      .replace(
        '</body>',
        () =>
          `<script type="text/plain" id="wingbeat-core">${wasm}</script>\n` +
          `<script type="module">${text('.js').replaceAll('</script', '<\\/script')}</script>\n</body>`,
      );
    writeFileSync(join(output, 'wingbeat-explorer.html'), html);
  },
};

export default defineConfig({
  base: './',
  define: {__VERSION__: JSON.stringify(version()), __NOTICES__: JSON.stringify(notices())},
  resolve: {alias: {'#core': resolve(core), '#data': resolve('../../data')}},
  build: {
    outDir: join(output, 'site'),
    emptyOutDir: true,
    assetsInlineLimit: 0,
    modulePreload: false,
    target: 'es2022',
  },
  server: {fs: {strict: false}},
  plugins: [singleFile],
});

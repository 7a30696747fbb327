// Puts the playground together, one HTML file: node build_playground.mjs PACKAGE TREE ESBUILD OUTPUT

import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';

const [packageFolder, tree, viewerPackages, output] = process.argv.slice(2);
const esbuild = createRequire(resolve(viewerPackages, 'package.json'))('esbuild');
const source = (name) => join(tree, 'web/playground', name);

function bundled(path) {
  const { outputFiles } = esbuild.buildSync({
    entryPoints: [resolve(path)],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2022',
    write: false,
    logLevel: 'error',
  });
  return outputFiles[0].text.trim().replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
}

const licences = readFileSync(join(packageFolder, 'LICENSES-third-party.txt'), 'utf8').replaceAll('--', '- -').trim();
const wasm = gzipSync(readFileSync(join(packageFolder, 'lamella.wasm')), { level: 9 }).toString('base64');
const page = readFileSync(source('index.html'), 'utf8')
  .replace('<!--styles-->', () => `<style>\n${readFileSync(source('styles.css'), 'utf8')}</style>`)
  .replace(
    '<!--script-->',
    () => `<script type="text/plain" id="worker">${bundled(join(packageFolder, 'browser_worker.js'))}</script>
    <script>${bundled(source('playground.js'))}</script>
    <script type="text/plain" id="wasm">${wasm}</script>
    <!-- Licences of what is in this page:\n\n${licences}\n-->`,
  );
writeFileSync(output, page);

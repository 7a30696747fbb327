// The samples of the documentation in a page: with three.js, bundled by Vite and in its development server, in Chromium and
// in Firefox. LAMELLA_PROGRAM, LAMELLA_PACKAGE, LAMELLA_PAGE.

import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, normalize } from 'node:path';
import { after, before, test } from 'node:test';
import { build as bundle } from 'esbuild';
import { chromium } from 'playwright-core';
import { build, createServer as createDevelopmentServer } from 'vite';

const packageFolder = process.env.LAMELLA_PACKAGE;
const page = readFileSync(process.env.LAMELLA_PAGE, 'utf8');
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
const firefoxPath = ['/usr/bin/firefox-esr', '/usr/bin/firefox'].find(existsSync);
const root = mkdtempSync(join(import.meta.dirname ?? process.cwd(), 'sample-')); // beside node_modules

const sample = (pattern) => page.match(pattern)[1];
const kinds = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };
const isolation = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' };

/** Serves the files of a folder on this computer, and takes what pages post to /result. */
async function serve(folder, headers = {}) {
  let report;
  const result = new Promise((resolve) => (report = resolve));
  const server = createServer((request, response) => {
    if (request.method === 'POST') {
      let text = '';
      request.on('data', (data) => (text += data)).on('end', () => (response.end(), report(text)));
      return;
    }
    const path = join(folder, normalize(request.url === '/' ? '/index.html' : request.url));
    if (!existsSync(path)) return response.writeHead(404).end();
    for (const [name, value] of Object.entries(headers)) response.setHeader(name, value);
    response.setHeader('content-type', kinds[/\.[a-z]+$/.exec(path)?.[0]] ?? 'text/plain').end(readFileSync(path));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, result, close: () => server.close() };
}

let browser;
before(async () => {
  if (!browserPath) throw new Error("no browser: install Debian's chromium");
  browser = await chromium.launch({ executablePath: browserPath, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });
  mkdirSync(join(root, 'node_modules'));
  cpSync(packageFolder, join(root, 'node_modules/lamella'), { recursive: true });
  writeFileSync(join(root, 'index.html'), '<!doctype html><meta charset="utf-8"><body><script type="module" src="./main.js"></script>');
  writeFileSync(join(root, 'main.js'), sample(/^```js\n(import \* as THREE [^`]*)^```$/m));
  writeFileSync(join(root, 'vite.config.js'), sample(/^```js\n\/\/ vite.config.js\n([^`]*)^```$/m));
  writeFileSync(join(root, 'package.json'), '{"type": "module"}');
});
after(async () => {
  await browser?.close();
  rmSync(root, { recursive: true, force: true });
});

/** Opens a page with the sample of three.js, and checks that both the mesh and its layers are seen. */
async function checkScene(address) {
  const opened = await browser.newPage();
  const complaints = [];
  opened.on('pageerror', (error) => complaints.push(error.stack));
  await opened.goto(address);
  await opened.waitForFunction(() => document.title === 'sliced', null, { timeout: 120000 });
  const seen = await opened.evaluate(() => {
    const canvas = document.querySelector('canvas');
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    const rows = new Set();
    let [lines, part] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [red, green, blue] = data.subarray(i, i + 3);
      if (red - blue > 60) {
        lines += 1;
        rows.add(Math.floor(i / 4 / canvas.width));
      } else if (red < 245 && Math.abs(red - blue) < 8 && Math.abs(red - green) < 8) part += 1;
    }
    return { lines, part, rows: rows.size };
  });
  assert.deepEqual(complaints, []);
  assert.ok(seen.lines > 3000 && seen.part > 3000 && seen.rows > 200, JSON.stringify(seen));
  await opened.close();
}

test('the sample of three.js, bundled by Vite, shows layers over the mesh', async () => {
  await build({ root, logLevel: 'error', build: { target: 'es2022' } });
  const server = await serve(join(root, 'dist'));
  await checkScene(server.address);
  server.close();
  const isolated = await serve(join(root, 'dist'), isolation);
  await checkScene(isolated.address);
  isolated.close();
});

test('the sample of three.js, bundled by esbuild, works beside the files of the package and names what is missing', async () => {
  const outdir = join(root, 'bundle');
  await bundle({ entryPoints: [join(root, 'main.js')], bundle: true, format: 'esm', outdir, logLevel: 'error' });
  cpSync(join(root, 'index.html'), join(outdir, 'index.html'));
  const failure = async () => {
    const server = await serve(outdir);
    const opened = await browser.newPage();
    const failed = opened.waitForEvent('pageerror');
    await opened.goto(server.address);
    const { message } = await failed;
    await opened.close();
    server.close();
    return message;
  };
  assert.match(await failure(), /lamella\.wasm cannot be loaded \(404 Not Found\): .*beside the script/);
  const names = readdirSync(packageFolder).filter((name) => /\.(js|wasm)$/.test(name));
  for (const name of names) if (name !== 'browser_worker.js') cpSync(join(packageFolder, name), join(outdir, name));
  assert.match(await failure(), /browser_worker\.js cannot be loaded: .*beside the script/);
  cpSync(join(packageFolder, 'browser_worker.js'), join(outdir, 'browser_worker.js'));
  const server = await serve(outdir);
  await checkScene(server.address);
  server.close();
});

test('a bundle for Node.js without the files of the package names what is missing, and one that leaves it out works', async () => {
  const entry = join(root, 'node_main.js');
  writeFileSync(entry, "import { makeBody } from 'lamella';\nconsole.log((await makeBody('box')).triangles);\n");
  const run = async (external) => {
    const outfile = join(root, 'bundled.mjs');
    await bundle({ entryPoints: [entry], bundle: true, platform: 'node', format: 'esm', outfile, external, logLevel: 'error' });
    return spawnSync(process.execPath, [outfile], { encoding: 'utf8' });
  };
  assert.match((await run([])).stderr, /LamellaError: lamella\.wasm is missing beside .*bundled\.mjs: /);
  assert.equal((await run(['lamella'])).stdout, '12\n');
});

test('the sample of three.js works in the development server of Vite', async () => {
  const server = await createDevelopmentServer({ root, logLevel: 'error', server: { port: 0, host: '127.0.0.1', fs: { strict: false } } });
  await server.listen();
  await checkScene(server.resolvedUrls.local[0]);
  await server.close();
});

/** A page that slices, and posts how. */
const script = `<!doctype html><body><script type="module">
  import { makeBody, sliceToFile, slice, sliceLayers } from './lamella/browser.js';
  try {
    const mesh = await makeBody('lattice', { cells: 5 });
    const { bytes, statistics } = await sliceToFile(mesh, 'cli', { layerHeight: 0.2 });
    const { statistics: two } = await sliceToFile(mesh, 'cli', { layerHeight: 0.2, threads: 2 });
    const hash = [...new Uint8Array(await crypto.subtle.digest('SHA-256', bytes))].map((byte) => byte.toString(16).padStart(2, '0')).join('');
    const hashes = (await slice(await makeBody('rook'), { layerHeight: 5 })).layers.map((layer) => layer.hash);
    let layers = 0;
    for await (const layer of sliceLayers(mesh, { layerHeight: 1 })) layers += 1;
    await fetch('/result', { method: 'POST', body: JSON.stringify({ isolated: crossOriginIsolated, threads: two.threads, hash, hashes, layers }) });
  } catch (error) {
    await fetch('/result', { method: 'POST', body: JSON.stringify({ failed: String(error?.stack ?? error) }) });
  }
</script>`;

const visits = {
  Chromium: (address) => browser.newPage().then(async (opened) => (await opened.goto(address), () => opened.close())),
  Firefox(address) {
    const profile = mkdtempSync(join(tmpdir(), 'lamella-firefox-'));
    const running = spawn(firefoxPath, ['--headless', '--no-remote', '--profile', profile, address], { stdio: 'ignore', env: { ...process.env, HOME: profile } });
    return async () => {
      const ended = new Promise((resolve) => running.on('exit', resolve));
      running.kill();
      await ended;
      rmSync(profile, { recursive: true, force: true });
    };
  },
};
for (const [name, visit] of Object.entries(visits))
  for (const [kind, headers, threads] of [
    ['an isolated page', isolation, 2],
    ['an ordinary page', {}, 1],
  ])
    test(`${name} has the bytes of the program in ${kind}, with ${threads === 1 ? 'one thread' : 'two threads'}`, { skip: name === 'Firefox' && !firefoxPath && 'Firefox is not installed' }, async () => {
      const folder = mkdtempSync(join(tmpdir(), 'lamella-sample-'));
      cpSync(packageFolder, join(folder, 'lamella'), { recursive: true });
      writeFileSync(join(folder, 'index.html'), script);
      const native = (...words) => execFileSync(process.env.LAMELLA_PROGRAM, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
      native('make', 'lattice', '--cells', '5', '-o', 'lattice.stl');
      native('slice', 'lattice.stl', '-o', 'lattice.cli', '--layer-height', '0.2');
      native('make', 'rook', '-o', 'rook.stl');
      native('slice', 'rook.stl', '--stats', 'rook.json', '--layer-height', '5');
      native('slice', 'lattice.stl', '--stats', 'lattice.json', '--layer-height', '1');
      const layersOf = (file) => JSON.parse(readFileSync(join(folder, file), 'utf8')).layers;
      const server = await serve(folder, headers);
      const leave = await visit(server.address);
      const result = JSON.parse(await server.result);
      await leave();
      server.close();
      const hash = execFileSync('sha256sum', ['lattice.cli'], { cwd: folder, encoding: 'utf8' }).split(' ')[0];
      assert.deepEqual(result, { isolated: threads === 2, threads, hash, hashes: layersOf('rook.json').map((layer) => layer.hash), layers: layersOf('lattice.json').length });
      rmSync(folder, { recursive: true, force: true });
    });

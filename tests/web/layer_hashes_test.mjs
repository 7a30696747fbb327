// The layers of all bodies, and of the meshes of public projects where they are, have the hashes of the table that holds on
// every system (tests/fixtures/layer_hashes.tsv), in Node.js and in a page. LAMELLA_PACKAGE is the package's folder.

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const packageFolder = process.env.LAMELLA_PACKAGE;
const shared = process.env.LAMELLA_SHARED;
const lines = readFileSync(process.env.LAMELLA_LAYER_HASHES, 'utf8').split('\n').filter((line) => line && !line.startsWith('#'));
const columns = lines.shift().split('\t');
const rows = lines.map((line) => Object.fromEntries(line.split('\t').map((field, i) => [columns[i], field])));
const isBody = (row) => !row.mesh.startsWith('meshes/');
const present = rows.filter((row) => isBody(row) || existsSync(join(shared, row.mesh)));

/** Returns "layers hash" of one row; it also runs in a page. */
async function hashOf({ makeBody, readMesh, slice }, row, bytes) {
  const words = row.options.split(' ');
  const options = words.length < 2 ? {} : { [words[0].slice(2)]: words[1].includes(',') ? words[1].split(',').map(Number) : Number(words[1]) };
  const mesh = bytes ? await readMesh(bytes, row.mesh.split('/').pop()) : await makeBody(row.mesh, options);
  const stack = await slice(mesh, { layerHeight: Number(row.height_mm), rotate: row.rotated.split(',').map(Number) });
  const result = `${stack.layers.length} ${stack.statistics.hash}`;
  stack.dispose();
  mesh.dispose();
  return result;
}

let browser, server;
before(async () => {
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
  const kinds = { '.js': 'text/javascript', '.wasm': 'application/wasm' };
  server = createServer((request, response) => {
    const [, root, name] = /^\/(lamella|meshes)\/(.*)$/.exec(decodeURIComponent(request.url)) ?? [];
    if (!root) return response.setHeader('content-type', 'text/html').end('<!doctype html><title>hashes</title>');
    const path = join(root === 'lamella' ? packageFolder : join(shared, 'meshes'), normalize(name));
    if (!existsSync(path)) return response.writeHead(404).end();
    response.setHeader('content-type', kinds[extname(path)] ?? 'application/octet-stream').end(readFileSync(path));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
});
after(async () => {
  await browser.close();
  server.close();
});

test('layers have the hashes of the table in Node.js', async () => {
  const lamella = await import(pathToFileURL(join(packageFolder, 'node.js')).href);
  for (const row of present) {
    const bytes = isBody(row) ? undefined : new Uint8Array(readFileSync(join(shared, row.mesh)));
    assert.equal(await hashOf(lamella, row, bytes), `${row.layers} ${row.hash}`, `${row.mesh} ${row.rotated}`);
  }
});

test('layers have the hashes of the table in a page', async () => {
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const found = await page.evaluate(async ([code, rows]) => {
    const hashOf = (0, eval)(`(${code})`);
    const lamella = await import('/lamella/browser.js');
    const results = [];
    for (const row of rows) {
      const url = `/${row.mesh.split('/').map(encodeURIComponent).join('/')}`;
      const bytes = row.mesh.startsWith('meshes/') ? new Uint8Array(await (await fetch(url)).arrayBuffer()) : undefined;
      results.push(await hashOf(lamella, row, bytes));
    }
    return results;
  }, [hashOf.toString(), present]);
  present.forEach((row, i) => assert.equal(found[i], `${row.layers} ${row.hash}`, `${row.mesh} ${row.rotated}`));
  await page.close();
});

// Seconds of slicing in Node.js: node measure.mjs SETTINGS (JSON; with manifold-3d beside it), JSON on standard output.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import loadManifold from 'manifold-3d';

const { program, package: packageFolder, folder, parts, rounds, manifoldLayers } = JSON.parse(process.argv[2]);
const { readMesh, slice, sliceToFile } = await import(pathToFileURL(join(packageFolder, 'node.js')).href);
const manifold = await loadManifold();
manifold.setup();

async function seconds(act) {
  const begin = performance.now();
  const result = await act();
  return [(performance.now() - begin) / 1000, result];
}

/** An indexed mesh of a binary STL file. */
function weldedMesh(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const triangles = view.getUint32(80, true);
  const [known, positions, corners] = [new Map(), [], new Uint32Array(3 * triangles)];
  for (let i = 0; i < 3 * triangles; ++i) {
    const at = 84 + 50 * Math.floor(i / 3) + 12 + 12 * (i % 3);
    const point = [0, 4, 8].map((offset) => view.getFloat32(at + offset, true));
    const key = point.join();
    if (!known.has(key)) {
      known.set(key, positions.length / 3);
      positions.push(...point);
    }
    corners[i] = known.get(key);
  }
  return new manifold.Mesh({ numProp: 3, vertProperties: Float32Array.from(positions), triVerts: corners });
}

/** Construction, and slices of some layers, whose areas are those of `layers`. */
function byManifold(mesh, layers) {
  const begin = performance.now();
  const body = new manifold.Manifold(mesh);
  const built = performance.now();
  const step = Math.max(1, Math.floor(layers.length / manifoldLayers));
  const chosen = layers.filter((_, i) => i % step === 0);
  for (const { z, areaMm2 } of chosen) {
    const section = body.slice(z);
    section.toPolygons();
    const area = section.area();
    section.delete();
    assert.ok(Math.abs(area - areaMm2) < 1e-4 * areaMm2 + 1e-3, `area ${area} at ${z}, expected ${areaMm2}`);
  }
  const sliced = performance.now();
  body.delete();
  return { build: (built - begin) / 1000, slice: ((sliced - built) / 1000 / chosen.length) * layers.length };
}

const rows = {};
for (const { name, path, height } of parts) {
  const bytes = readFileSync(path);
  const mesh = await readMesh(bytes, `${name}.stl`);
  const { layers } = await slice(mesh, { layerHeight: height });
  const indexed = weldedMesh(bytes);
  const output = join(folder, `${name}.cli`);
  const native = (threads) => {
    const [taken, { status, stderr }] = [performance.now(), spawnSync(program, ['slice', path, '-o', output, '--layer-height', `${height}`, '--threads', `${threads}`])];
    assert.equal(status, 0, String(stderr));
    return (performance.now() - taken) / 1000;
  };
  const row = (rows[name] = { triangles: mesh.triangles, layers: layers.length, native1: [], native: [], wasm1: [], wasm: [], arrays: [], manifoldBuild: [], manifoldSlice: [] });
  for (let round = 0; round < rounds; ++round) {
    row.native1.push(native(1));
    row.native.push(native(0));
    for (const [column, threads] of [['wasm1', 1], ['wasm', undefined]]) {
      const [taken, { bytes: file }] = await seconds(async () => sliceToFile(mesh, 'cli', { layerHeight: height, threads }));
      assert.equal(Buffer.compare(file, readFileSync(output)), 0, `${name}: other bytes than those of the program`);
      row[column].push(taken);
    }
    row.arrays.push((await seconds(() => slice(mesh, { layerHeight: height, threads: 1 })))[0]);
    if (round < 3) {
      const { build, slice } = byManifold(indexed, layers);
      row.manifoldBuild.push(build);
      row.manifoldSlice.push(slice);
    }
  }
}
console.log(JSON.stringify(rows));
process.exit(0);

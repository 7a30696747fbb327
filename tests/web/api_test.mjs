// The interface of the package with a stand-in for the program, which answers as each test says: LAMELLA_TREE, the sources.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const sources = join(process.env.LAMELLA_TREE, 'web/package');
const { Mesh, meshOf, run, sliceLayers, usePlatform } = await import(pathToFileURL(join(sources, 'api.js')).href);
const { holdBack } = await import(pathToFileURL(join(sources, 'flow.js')).href);
const { rawReader } = await import(pathToFileURL(join(sources, 'raw_layers.js')).href);

const nothing = { files: [], code: 0, refused: null };
let answer; // (request, post) => what the program does
let ended = 0; // workers
usePlatform({
  processors: 1,
  shared: false,
  loadModule: async () => null,
  startWorker: (_, onMessage) => ({
    post: (request) => setImmediate(() => answer(request, (message) => setImmediate(() => onMessage(message)))),
    hold() {},
    end: () => (ended += 1),
  }),
});

const mesh = new Mesh(new Uint8Array(3), { name: 'part.stl' }, []);
const line = (message) => ({ line: JSON.stringify(message) });

/** A file of the format `raw`. */
function rawFile(labels, layers) {
  const chunks = [];
  const number = (type, value) => {
    const bytes = Buffer.alloc(type === 'UInt32LE' ? 4 : 8);
    bytes[`write${type}`](value);
    chunks.push(bytes);
  };
  const text = JSON.stringify({ units: 'mm', layers: layers.length, parts: labels.map((label) => ({ label })), rule: 'section_above' });
  const header = Buffer.from(text);
  chunks.push(Buffer.from('lamella\n'));
  number('BigUInt64LE', BigInt(Math.ceil(header.length / 8) * 8));
  chunks.push(header, Buffer.alloc((8 - (header.length % 8)) % 8, ' '));
  for (const { index, z, contours, lines } of layers) {
    number('BigUInt64LE', BigInt(index));
    for (const height of [z, z - 0.5, z + 0.5]) number('DoubleLE', height);
    const points = contours.flatMap((contour) => contour.points);
    for (const count of [contours.length, points.length / 2, lines.length / 4]) number('BigUInt64LE', BigInt(count));
    for (const value of [...points, ...lines]) number('DoubleLE', value);
    let end = 0;
    for (const contour of contours) number('UInt32LE', (end += contour.points.length / 2));
    for (const { part } of contours) number('UInt32LE', part);
    for (let i = 0; i < lines.length / 4; ++i) number('UInt32LE', 1);
    const closed = Buffer.from(contours.map((contour) => contour.closed));
    const unpadded = chunks.reduce((sum, { length }) => sum + length, closed.length);
    chunks.push(closed, Buffer.alloc((8 - (unpadded % 8)) % 8));
  }
  return new Uint8Array(Buffer.concat(chunks));
}

const layers = [
  { index: 4, z: 0.5, contours: [{ points: [0, 0, 1, 0, 0, 1], part: 0, closed: 1 }, { points: [5, 5, 6, 0.25], part: 1, closed: 0 }], lines: [1, 2, 3, 4] },
  { index: 5, z: 1.5, contours: [], lines: [] },
  { index: 6, z: 2.5, contours: [{ points: [0, 0, 1 / 3, 0, 0, 1], part: 1, closed: 1 }], lines: [] },
];

const described = (layer) => ({
  index: layer.index,
  z: layer.z,
  contours: Array.from({ length: layer.contours }, (_, i) => ({ points: [...layer.contour(i)], part: layer.parts[i], closed: layer.closed[i] })),
  lines: [...layer.hatches],
});

test('layers come as they were written, in chunks of any size', async () => {
  const file = rawFile(['left', 'right "2"'], layers);
  assert.equal(file.length % 8, 0);
  for (const size of [1, 7, 8, 100, file.length]) {
    answer = (request, post) => {
      assert.deepEqual(request.words.slice(-4), ['-o', '-', '--format', 'raw']);
      for (let at = 0; at < file.length; at += size) post({ output: file.slice(at, at + size) });
      post(line({ warning: 'standard output: of the file' }));
      post({ result: nothing });
    };
    const stream = sliceLayers(mesh);
    const found = [];
    for await (const layer of stream) found.push(described(layer));
    assert.deepEqual(found, layers);
    assert.deepEqual(stream.labels, ['left', 'right "2"']);
    assert.deepEqual(stream.warnings, ['layers: of the file']);
  }
});

test('what has come and is not read is counted, so that the program can wait', async () => {
  const file = rawFile(['part'], layers);
  let counter;
  answer = (request, post) => {
    counter = new Int32Array(request.flow);
    for (let i = 0; i < 10; ++i) holdBack(request.flow, file.length);
    post({ output: file });
    for (let i = 1; i < 10; ++i) post({ output: rawFile([], layers).slice(rawFile([], []).length) });
    post({ result: nothing });
  };
  const stream = sliceLayers(mesh);
  await stream.next();
  const afterFirst = Atomics.load(counter, 0);
  assert.equal(afterFirst, 9 * file.length); // only the first chunk was taken
  for await (const layer of stream) assert.ok(layer.z > 0);
  assert.ok(Atomics.load(counter, 0) < file.length * 9);
});

test('an exception of a callback ends the worker and rejects the promise', async () => {
  answer = (_, post) => {
    post(line({ stage: 'read', done: 1, total: 2, seconds: 0 }));
    post({ output: new Uint8Array(1) });
    post({ result: nothing });
  };
  const failing = () => {
    throw new RangeError('of the callback');
  };
  for (const options of [{ onProgress: failing }, { onOutput: failing }]) {
    const before = ended;
    await assert.rejects(run(['slice'], {}, options), { name: 'RangeError', message: 'of the callback' });
    assert.equal(ended, before + 1);
  }
  assert.equal((await run(['slice'])).code, 0);
});

test('a file that became too large is a limit, whatever the program says', async () => {
  answer = (_, post) => {
    post(line({ error: "cannot write 'layers.npz': File too large" }));
    post({ result: { ...nothing, code: 6, refused: 'layers.npz' } });
  };
  await assert.rejects(run(['slice']), { kind: 'limit', message: /^cannot write 'layers\.npz': File too large: a file here has at most 2 GB in a browser and 4 GB in Node\.js/ });
});

test('a mesh of arrays is a file of the same numbers', async () => {
  let file;
  answer = (request, post) => {
    [file] = request.inputs;
    post({ output: new TextEncoder().encode('{"kind": "mesh"}') });
    post({ result: nothing });
  };
  const positions = [0, 0, 0, 0.1, 0, 0, 0, 1 / 3, 0];
  await meshOf(positions, [0, 2, 1], { name: 'triangle' });
  assert.equal(file.name, 'triangle.ply');
  const text = Buffer.from(file.bytes).toString('latin1');
  const begin = text.indexOf('end_header\n') + 11;
  assert.match(text, /element vertex 3\nproperty double x\n.*element face 1\n/s);
  const view = new DataView(file.bytes.buffer, file.bytes.byteOffset + begin);
  assert.deepEqual(positions.map((_, i) => view.getFloat64(8 * i, true)), positions);
  assert.deepEqual([view.getUint8(72), view.getUint32(73, true), view.getUint32(77, true), view.getUint32(81, true)], [3, 0, 2, 1]);
  assert.equal(view.byteLength, 85);
  await meshOf(Float32Array.from(positions));
  assert.equal(file.name, 'mesh.ply');
  assert.match(Buffer.from(file.bytes).toString('latin1'), /property float x/);
});

test('a reader of layers that are cut off has those that are complete', () => {
  const file = rawFile(['part'], layers);
  const found = [];
  const read = rawReader(() => {}, (arrays) => found.push(arrays.index[0]));
  read(file.slice(0, -1));
  assert.deepEqual(found, [4, 5]);
  read(file.slice(-1));
  assert.deepEqual(found, [4, 5, 6]);
});

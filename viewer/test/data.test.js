import assert from 'node:assert/strict';
import { Duplex } from 'node:stream';
import { createInflateRaw, deflateRawSync } from 'node:zlib';
import { test } from 'node:test';
import { NumberReader } from '../src/data/number_reader.js';
import { readLayer } from '../src/data/layer.js';
import { readMesh } from '../src/data/mesh.js';
import { bodiesOf, bodyOfParts, kindsOf, switchGroup } from '../src/data/exposures.js';
import { insideOutOf } from '../src/data/inside_out.js';
import { LayerShelf } from '../src/data/page.js';
import { unpack } from '../src/data/unpack.js';
import { jumpsTo, partOf, vectorsOf } from '../src/data/vectors.js';
import { Store } from '../src/store.js';

// Browsers unpack raw Deflate streams, and so does Node.js from 20.12 on. For older ones its zlib does.
try {
  new DecompressionStream('deflate-raw');
} catch {
  globalThis.DecompressionStream = class {
    constructor(format) {
      assert.equal(format, 'deflate-raw');
      return Duplex.toWeb(createInflateRaw());
    }
  };
}

/** Writes what NumberReader reads, in big integers: another way to the same bytes. */
function numbers(...values) {
  const bytes = [];
  for (const value of values) {
    let rest = BigInt(value);
    for (; rest >= 128n; rest >>= 7n) bytes.push(Number(rest & 127n) | 128);
    bytes.push(Number(rest));
  }
  return new Uint8Array(bytes);
}
const signed = (value) => (value >= 0 ? 2n * BigInt(value) : -2n * BigInt(value) - 1n);

test('numbers of any size and sign are read back', () => {
  const values = [0, 1, 63, 64, 127, 128, 300, 16383, 16384, 2 ** 21, 2 ** 30, 2 ** 31, 2 ** 32 + 5, 2 ** 50];
  const reader = new NumberReader(numbers(...values));
  for (const value of values) assert.equal(reader.next(), value);
  assert.ok(reader.atEnd);
  const both = values.flatMap((value) => [value, -value]).filter((value) => Math.abs(value) < 2 ** 51);
  const signs = new NumberReader(numbers(...both.map(signed)));
  for (const value of both) assert.equal(signs.nextSigned() + 0, value + 0);
});

test('data that end too early are an error', () => {
  assert.throws(() => new NumberReader(new Uint8Array([0x80, 0x80, 0x80])).next(), /too early/);
});

test('bytes are unpacked', async () => {
  const bytes = Uint8Array.from({ length: 5000 }, (_, i) => (i * i) % 251);
  const text = deflateRawSync(bytes).toString('base64');
  assert.deepEqual(await unpack(text), bytes);
});

/** Two rings, one inside the other, and a chain; a hatch line; a crossing. Steps of half a millimetre. */
const layerBytes = numbers(
  2, 1, 1,
  4, ...[0, 0, 20, 0, 0, 20, -20, 0].map(signed),
  3, ...[4, 4, 0, 6, 6, -6].map(signed),
  2, ...[26, 0, 2, 4].map(signed),
  ...[2, 2, 6, 0].map(signed),
  1, ...[8, 10].map(signed),
);

test('a layer is read: contours, hatches, crossings', () => {
  const layer = readLayer(layerBytes, 1, 0.5);
  const [part] = layer.parts;
  assert.equal(part.rings, 2);
  assert.deepEqual([...part.ends], [4, 7, 9]);
  assert.deepEqual([...part.points], [0, 0, 10, 0, 10, 10, 0, 10, 2, 2, 2, 5, 5, 2, 15, 2, 16, 4]);
  assert.deepEqual([...part.areas.slice(0, 2)], [100, -4.5]);
  assert.deepEqual([...part.boxes.slice(0, 8)], [0, 0, 10, 10, 2, 2, 5, 5]);
  assert.deepEqual([...part.hatches], [1, 1, 4, 1]);
  assert.deepEqual([...layer.crossings], [4, 5]);
});

test('data of another number of parts are an error', () => {
  assert.throws(() => readLayer(layerBytes, 2, 0.5));
  assert.throws(() => readLayer(numbers(0, 0, 0, 0, 7), 1, 0.5), /go on/);
});

test('a mesh is read', () => {
  const bytes = numbers(3, 2, ...[0, 0, 0, 4, 0, 0, -4, 2, 6].map(signed), ...[0, 0, 1, 1, 1, -2, 2, -1].map(signed));
  const mesh = readMesh(bytes, 2);
  assert.deepEqual([...mesh.vertices], [1, 1, 1, 9, 1, 1, 1, 5, 13]);
  assert.deepEqual([...mesh.triangles], [0, 1, 2, 0, 2, 1]);
  assert.deepEqual([...mesh.shells], [0, 1]);
});

/** A part as readLayer makes it: each ring a square from (left, bottom), clockwise where its edge is below 0. */
function squares(...rings) {
  const contours = rings.map(([left, bottom, edge]) => {
    const [right, top] = [left + Math.abs(edge), bottom + Math.abs(edge)];
    const points = [[left, bottom], [right, bottom], [right, top], [left, top]];
    return edge > 0 ? points : points.reverse();
  });
  return {
    points: new Float32Array(contours.flat(2)),
    ends: Uint32Array.from(rings, (_, i) => 4 * (i + 1)),
    rings: rings.length,
    boxes: new Float32Array(rings.flatMap(([left, bottom, edge]) => [left, bottom, left + Math.abs(edge), bottom + Math.abs(edge)])),
    areas: Float32Array.from(rings, ([, , edge]) => Math.sign(edge) * edge * edge),
  };
}

test('rings are inside out where they run clockwise and take no material away', () => {
  const find = (parts, bounds = () => true) => {
    const { rings, deepest } = insideOutOf(parts, bounds, 0.5);
    return [rings.map((set) => [...set]), deepest];
  };
  assert.deepEqual(find([squares([0, 0, 20], [5, 5, -4], [30, 0, 20])]), [[[]], 0]);
  assert.deepEqual(find([squares([0, 0, 20], [30, 0, -10])]), [[[1]], 1]);
  // Within a body inside out: one that is right, and one that is inside out, too.
  assert.deepEqual(find([squares([0, 0, -20], [2, 2, 5], [10, 10, -5])]), [[[0, 2]], 2]);
  // A hole of another part's material is one; a hole that touches its body from inside is one, too.
  assert.deepEqual(find([squares([0, 0, 20]), squares([0, 0, -5])]), [[[], []], 0]);
  // Scan vectors bound nothing.
  assert.deepEqual(find([squares([0, 0, -20])], () => false), [[[]], 0]);
});

test('the shelf decodes a layer once, and lets go of old ones', async () => {
  const text = deflateRawSync(layerBytes).toString('base64');
  let read = 0;
  const data = Array.from({ length: 5 }, () => ({
    get textContent() {
      ++read;
      return text;
    },
  }));
  const page = { head: { layers: 5, parts: [{}], step_mm: 0.5 }, table: { shown: [9, 9, 9, 9, 2e6], hatches_shown: [1, 1, 1, 1, 1e6], misoriented: [0, 0, 0, 0, 0], crossings: [0, 0, 0, 0, 0] }, data };
  const shelf = new LayerShelf(page);
  assert.equal(await shelf.layer(0), await shelf.layer(0));
  await shelf.layer(1);
  assert.equal(read, 2);
  await shelf.layer(4); // too much for the shelf together with the others
  await shelf.layer(0);
  assert.equal(read, 4);
});

const parameters = { name: 'a', power_w: 100, speed_mm_s: 500, jump_speed_mm_s: 5000, mark_delay_us: 200, jump_delay_us: 300 };
const exposure = (part, region, kind) => ({ label: `${part} ${region} ${kind}`, exposure: { part, region, kind, contour: 0, parameters } });

/** The contours of a part of a layer. */
const part = ({ rings = [], chains = [], hatches = [] } = {}) => {
  const contours = [...rings, ...chains];
  let end = 0;
  return {
    points: new Float32Array(contours.flat(2)),
    ends: new Uint32Array(contours.map((contour) => (end += contour.length))),
    rings: rings.length,
    hatches: new Float32Array(hatches),
  };
};

test('vectors are those that are executed, in their order and with their times', () => {
  // The same vectors as in tests/contour/measure_vectors_test.cpp, after a part of material and in two exposures.
  const layer = {
    parts: [
      part({ rings: [[[5, 5], [6, 5], [6, 6]]] }),
      part({ rings: [[[0, 0], [10, 0], [10, 10], [0, 10]]], chains: [[[20, 0], [23, 4]]], hatches: [23, 4, 23, 14, 33, 14, 33, 4] }),
      part(),
      part({ hatches: [33, 4, 33, 9] }),
    ],
  };
  assert.deepEqual(bodiesOf({ parts: [{ label: ' \t' }, { label: ' a' }] }).map(({ name }) => name), ['part', ' a']);
  const parts = [{ label: 'material' }, exposure('a', 'core', 'contour'), exposure('a', 'upskin', 'hatch'), exposure('a', 'core', 'hatch')];
  const vectors = vectorsOf(layer, parts);
  assert.equal(vectors.count, 4 + 1 + 2 + 1);
  assert.deepEqual([...vectors.lines.subarray(0, 20)], [0, 0, 10, 0, 10, 0, 10, 10, 10, 10, 0, 10, 0, 10, 0, 0, 20, 0, 23, 4]);
  assert.deepEqual([...vectors.ends], [0, 7, 7, 8]);
  assert.deepEqual([0, 1, 4, 5, 6, 7].map((i) => jumpsTo(vectors, i)), [false, false, true, false, true, false]);
  assert.deepEqual([0, 6, 7].map((i) => partOf(vectors, i)), [1, 1, 3]);
  const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-12, `${a}, ${b}`);
  near(vectors.seconds[0], 10 / 500);
  near(vectors.seconds[3], 40 / 500 + 200e-6);
  near(vectors.seconds[4], 45 / 500 + 200e-6 + 20 / 5000 + 300e-6); // the run goes on
  near(vectors.seconds[6], 65 / 500 + 30 / 5000 + 3 * 200e-6 + 2 * 300e-6);
  near(vectors.seconds[7], 70 / 500 + 30 / 5000 + 4 * 200e-6 + 2 * 300e-6); // no jump, but another exposure
  const none = vectorsOf({ parts: [part()] }, [exposure('a', 'core', 'hatch')]);
  assert.deepEqual([none.count, ...none.ends], [0, 0]);
});

test('exposures are told apart by region and kind, and belong to bodies', () => {
  const head = {
    parts: [exposure('a', 'downskin', 'hatch'), exposure('a', 'core', 'contour'), exposure('b', 'core', 'contour'), { label: 'material' }],
  };
  assert.deepEqual(kindsOf(head).map(({ name, parts }) => [name, parts]), [['core contour', [1, 2]], ['downskin hatch', [0]]]);
  assert.deepEqual(bodiesOf(head), [{ name: 'a', parts: [0, 1] }, { name: 'b', parts: [2] }, { name: 'material', parts: [3] }]);
  assert.deepEqual(bodyOfParts(head), [0, 0, 1, 2]);
  const store = new Store({ off: new Set(), hidden: new Set() });
  const [[contours], [a]] = [kindsOf(head), bodiesOf(head)];
  const hidden = () => [...store.state.hidden].sort();
  switchGroup(store, contours, false);
  switchGroup(store, a, false);
  assert.deepEqual(hidden(), [0, 1, 2]);
  switchGroup(store, contours, true);
  assert.deepEqual(hidden(), [0, 1]); // still hidden by its body
  switchGroup(store, a, true);
  assert.deepEqual(hidden(), []);
});

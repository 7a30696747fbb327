import assert from 'node:assert/strict';
import { test } from 'node:test';
import { layerInAddress } from '../src/address.js';
import { vectorsOf } from '../src/data/vectors.js';
import { rangeOf, runsOf, scaleColour, usefulColourings } from '../src/layer/colouring.js';
import { cornerNear, distanceText, pickAt, pickText } from '../src/layer/pick.js';
import { csvOf, stemOf, svgOf } from '../src/save.js';

/** Contours of a part, as readLayer gives them. */
function contoursOf(rings, chains = [], hatches = []) {
  const all = [...rings, ...chains];
  let at = 0;
  const ends = Uint32Array.from(all, (contour) => (at += contour.length));
  const boxes = Float32Array.from(all.flatMap((contour) => [0, 1].map((k) => Math.min(...contour.map((p) => p[k]))).concat([0, 1].map((k) => Math.max(...contour.map((p) => p[k]))))));
  const area = (ring) => ring.reduce((sum, [x, y], i) => sum + (x * ring[(i + 1) % ring.length][1] - ring[(i + 1) % ring.length][0] * y) / 2, 0);
  return { points: Float32Array.from(all.flat(2)), ends, rings: rings.length, boxes, areas: Float32Array.from(all, area), hatches: Float32Array.from(hatches.flat(2)) };
}
const square = (x, y, side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
const layer = { parts: [contoursOf([square(0, 0, 10), square(2, 2, 4).reverse()], [[[20, 0], [20, 7]]])] };
const options = { parts: [{ label: 'ring' }], hidden: new Set(), order: Infinity };

const parameters = (power_w, speed_mm_s) => ({ name: '', power_w, speed_mm_s, jump_speed_mm_s: 1000, mark_delay_us: 0, jump_delay_us: 0 });
const exposed = [
  { label: 'a core contour 1', exposure: { part: 'a', region: 'core', kind: 'contour', contour: 1, parameters: parameters(100, 500) } },
  { label: 'a core hatch', exposure: { part: 'a', region: 'core', kind: 'hatch', contour: 0, parameters: parameters(200, 1000) } },
];
const scanned = { parts: [contoursOf([square(0, 0, 10)]), contoursOf([], [], [[[1, 1], [9, 1]], [[9, 2], [1, 2]]])] };
const vectors = vectorsOf(scanned, exposed);

test('a click finds the nearest contour in its reach, with its figures', () => {
  const at = (x, y, reach) => pickAt(layer, null, x, y, reach, options);
  assert.equal(at(0.3, 5, 0.5).number, 0);
  assert.equal(at(2.3, 4, 0.5).number, 1);
  assert.equal(at(1.1, 4, 0.5), undefined);
  assert.equal(at(0, 12, 0.5), undefined, 'beside the end of a side');
  assert.equal(pickAt(layer, null, 0, 5, 1, { ...options, hidden: new Set([0]) }), undefined);
  const text = (x, y) => pickText(at(x, y, 0.5), layer, null, options.parts);
  assert.equal(text(0, 5), 'outer contour 1, 100 mm², 40 mm around, 4 points');
  assert.equal(text(2, 4), 'hole 2, 16 mm², 16 mm around, 4 points');
  assert.equal(text(20.1, 3), 'open contour 3, 7 mm long, 2 points');
});

test('a click finds vectors that are executed, with power, speed and time', () => {
  const at = (order) => pickAt(scanned, vectors, 5, 1.9, 0.5, { parts: exposed, hidden: new Set(), order });
  assert.deepEqual([at(Infinity).kind, at(Infinity).part, at(Infinity).number], ['vector', 1, 5]);
  assert.equal(at(5), undefined);
  assert.match(pickText(at(6), scanned, vectors, exposed), /^core hatch, vector 6, 8 mm long, 200 W, 1,000 mm\/s, ends at 0\.\d+ s$/);
});

test('distances are measured between corners that a click is near to', () => {
  assert.deepEqual(cornerNear(layer, 9.8, 0.1, 0.5, options), [10, 0]);
  assert.deepEqual(cornerNear(layer, 8, 1, 0.5, options), [8, 1]);
  assert.equal(distanceText([0, 0], [3, 4]), '5 mm (x 3, y 4), 53.1°');
});

test('colours divide vectors into runs that cover them and follow the value', () => {
  assert.deepEqual(usefulColourings({ parts: exposed }), ['power', 'speed', 'time', 'order']);
  assert.deepEqual(usefulColourings({ parts: [{ ...exposed[0], exposure: { ...exposed[0].exposure, parameters: parameters(0, 0) } }] }), ['order']);
  assert.deepEqual(rangeOf('power', vectors, exposed), [100, 200]);
  assert.deepEqual(runsOf('power', [100, 200], vectors, 0, 4, exposed, 0), [{ end: 4, colour: scaleColour(0) }]);
  assert.deepEqual(runsOf('power', [100, 200], vectors, 4, 6, exposed, 1), [{ end: 6, colour: scaleColour(1) }]);
  const n = 1000;
  const many = { count: n, seconds: Float64Array.from({ length: n }, (_, i) => (i / n) ** 2) };
  for (const key of ['time', 'order']) {
    const runs = runsOf(key, rangeOf(key, many, exposed), many, 0, n, exposed, 0);
    assert.equal(runs.at(-1).end, n);
    assert.ok(runs.every(({ end }, i) => end > (i === 0 ? 0 : runs[i - 1].end)));
    assert.equal(new Set(runs.map(({ colour }) => colour)).size, runs.length);
    assert.equal(runs.length, 24);
  }
});

test('the address names a layer by its number or its height', () => {
  const table = { index: [0, 1, 2], z: [0.05, 0.15, 0.25] };
  assert.equal(layerInAddress(table, '#layer=2'), 2);
  assert.equal(layerInAddress(table, '#z=0.16'), 1);
  assert.equal(layerInAddress(table, '#z=-5'), 0);
  for (const other of ['', '#z=', '#z=abc', '#layer=', '#x=1']) assert.equal(layerInAddress(table, other), undefined);
});

test('the table of layers is saved as CSV, a row for each layer', () => {
  const text = csvOf({ index: [0, 1], z: [0.5, 1.5], area_mm2: [1.25, 2], unit: 'mm' });
  assert.equal(text, 'index,z,area_mm2\r\n0,0.5,1.25\r\n1,1.5,2\r\n');
});

test('a layer is saved as SVG in mm, with the names of parts and without hidden ones', () => {
  const colours = { fills: ['red'], outer: 'black', open: 'blue', hatch: 'green', vectors: { 'core contour': 'cyan', 'core hatch': 'pink' } };
  const head = { title: 'a<b>.stl', box: [[100, 0, 0], [120, 10, 1]], parts: [{ label: 'ring & co' }] };
  const text = svgOf(layer, null, { head, origin: [100, 0], z: 0.5, hidden: new Set(), colours });
  assert.match(text, /^<svg [^>]*width="20.8mm" height="10.8mm" viewBox="99.6 -10.4 20.8 10.8"><title>a&#60;b&#62;.stl, z = 0.5 mm<\/title>/);
  assert.ok(text.includes('d="M100 0L110 0L110 -10L100 -10ZM102 -6L106 -6L106 -2L102 -2Z"'), text);
  assert.ok(text.includes('d="M120 0L120 -7"'), text);
  assert.ok(text.includes('ring &#38; co'));
  assert.ok(!svgOf(layer, null, { head, origin: [100, 0], z: 0.5, hidden: new Set([0]), colours }).includes('<path'));
  const lines = svgOf(scanned, vectors, { head: { ...head, parts: exposed }, origin: [0, 0], z: 1, hidden: new Set([0]), colours });
  assert.ok(lines.includes('stroke="pink"') && !lines.includes('stroke="cyan"') && lines.includes('d="M1 -1L9 -1M9 -2L1 -2"'), lines);
});

test('saved files are named after the part', () => {
  assert.equal(stemOf('rook.stl'), 'rook');
  assert.equal(stemOf('Jürgen/Teil 1.3mf'), 'Jürgen_Teil_1');
  assert.equal(stemOf('...'), '..');
});

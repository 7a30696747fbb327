import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Camera } from '../src/layer/camera.js';
import { trace } from '../src/layer/draw_layer.js';
import { drawVectors } from '../src/layer/draw_vectors.js';

/** What is drawn of a contour of mm, at so many pixels per mm. */
function drawn(contour, scale, closed = true) {
  const camera = Object.assign(new Camera(), { scale, width: 0, height: 0 });
  const line = [];
  const path = { moveTo: (x, y) => line.push([x, y]), lineTo: (x, y) => line.push([x, y]), closePath: () => line.push(line[0]) };
  const contours = { points: new Float32Array(contour.flat()), ends: [contour.length], rings: closed ? 1 : 0 };
  trace(path, contours, 0, camera);
  return { line, pixels: contour.map(([x, y]) => [camera.toPixelX(Math.fround(x)), camera.toPixelY(Math.fround(y))]) };
}

function distance([x, y], [ax, ay], [bx, by]) {
  const square = (bx - ax) ** 2 + (by - ay) ** 2;
  const t = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square)) : 0;
  return Math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay));
}

const toLine = (point, line) => Math.min(...line.slice(1).map((end, i) => distance(point, line[i], end)));
const circle = (n, radius, wobble = 0) =>
  Array.from({ length: n }, (_, i) => {
    const r = radius + wobble * Math.sin(37 * i);
    return [r * Math.cos((2 * Math.PI * i) / n), r * Math.sin((2 * Math.PI * i) / n)];
  });

test('what is drawn of a contour passes every point of it by a small part of a pixel', () => {
  const zigzag = Array.from({ length: 200 }, (_, i) => [i % 2 === 0 ? i / 10 : 20 - i / 20, Math.sin(i)]);
  const spike = [[0, 0], [5, 0], [10, 0], [7, 0], [3, 0], [3, 4]];
  for (const contour of [circle(512, 5), circle(300, 3, 0.3), zigzag, spike, [[1, 1]], [[1, 1], [1, 1], [2, 2]]])
    for (const scale of [0.01, 1, 7, 300])
      for (const closed of [true, false]) {
        const { line, pixels } = drawn(contour, scale, closed);
        for (const point of pixels) assert.ok(toLine(point, line) <= 0.11, `${toLine(point, line)} pixels at ${scale}`);
        for (const point of line) assert.ok(toLine(point, [...pixels, pixels[0]]) < 1e-9);
      }
});

test('a curve is drawn with as many points as its size asks for', () => {
  assert.ok(drawn(circle(512, 5), 1).line.length < 40);
  assert.ok(drawn(circle(512, 5), 1000).line.length > 300);
  assert.equal(drawn(circle(512, 5), 0.01).line.length, 3);
  assert.equal(drawn([[0, 0], [1, 0], [2, 0], [3, 0]], 10, false).line.length, 2);
});

/** What is drawn of scan vectors: each stroke with its colour and width, and its lines in mm. */
function strokesOf(vectors, from, to, options) {
  const camera = Object.assign(new Camera(), { scale: 10, width: 400, height: 400 });
  const strokes = [];
  const ctx = {
    beginPath: () => (ctx.lines = []),
    moveTo: (x, y) => ctx.lines.push([[x, y]]),
    lineTo: (x, y) => ctx.lines.at(-1).push([x, y]),
    stroke: () => ctx.lines.length > 0 && strokes.push({ colour: ctx.strokeStyle, width: ctx.lineWidth, lines: ctx.lines.map((line) => line.map(([x, y]) => camera.toPlane(x, y).map(Math.round))) }),
  };
  drawVectors(ctx, camera, vectors, from, to, { hidden: new Set(), jumps: true, colours: { jump: 'grey', vectors: { 'core contour': 'blue', 'upskin hatch': 'orange' } }, ...options });
  return strokes;
}

test('vectors are drawn as they are executed, jumps among them', () => {
  const parts = [{ exposure: { region: 'upskin', kind: 'hatch' } }, {}, { exposure: { region: 'core', kind: 'contour' } }];
  const vectors = {
    count: 5,
    lines: new Float32Array([0, 0, 5, 0, 5, 1, 0, 1, 1, 1, 4, 1, 4, 1, 4, 4, 4, 4, 1, 1]),
    ends: new Uint32Array([2, 2, 5]),
  };
  const hatch = { colour: 'orange', width: 1, lines: [[[0, 0], [5, 0]], [[5, 1], [0, 1]]] };
  const ring = { colour: 'blue', width: 2.2, lines: [[[1, 1], [4, 1], [4, 4], [1, 1]]] };
  const jump = (...line) => ({ colour: 'grey', width: 0.75, lines: [line] });
  const all = [jump([5, 0], [5, 1]), hatch, jump([0, 1], [1, 1]), ring];
  assert.deepEqual(strokesOf(vectors, 0, 5, { parts }), all);
  assert.deepEqual([...strokesOf(vectors, 0, 2, { parts }), ...strokesOf(vectors, 2, 5, { parts })], all);
  assert.deepEqual(strokesOf(vectors, 0, 3, { parts, jumps: false }), [hatch, { ...ring, lines: [[[1, 1], [4, 1]]] }]);
  assert.deepEqual(strokesOf(vectors, 0, 5, { parts, jumps: false, hidden: new Set([0]) }), [ring]);
  assert.deepEqual(strokesOf(vectors, 5, 5, { parts }), []);
});

test('vectors that are out of sight, or much shorter than a pixel, take no lines', () => {
  const parts = [{ exposure: { region: 'core', kind: 'contour' } }];
  const n = 1000; // along 1 mm, 10 pixels; then far outside
  const lines = new Float32Array(Array.from({ length: 2 * n }, (_, i) => (i < n ? [i / n, 0, (i + 1) / n, 0] : [500, i, 500, i + 1])).flat());
  const [stroke, ...others] = strokesOf({ count: 2 * n, lines, ends: new Uint32Array([2 * n]) }, 0, 2 * n, { parts, jumps: false });
  assert.equal(others.length, 0);
  assert.ok(stroke.lines[0].length < 40);
  assert.deepEqual([stroke.lines[0][0], stroke.lines[0].at(-1)], [[0, 0], [1, 0]]);
});

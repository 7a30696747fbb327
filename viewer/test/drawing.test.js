import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Camera } from '../src/layer/camera.js';
import { trace } from '../src/layer/draw_layer.js';

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

import { NumberReader } from './number_reader.js';

/**
 * The contours of one part in one plane. Coordinates are mm from the corner that the page names its origin.
 * @typedef {object} Contours
 * @property {Float32Array} points x and y in turn
 * @property {Uint32Array} ends one past the last point of each contour
 * @property {number} rings number of closed contours; the others are open chains
 * @property {Float32Array} boxes of each contour: left, bottom, right, top
 * @property {Float32Array} areas of each contour, mm2: above 0 for a ring that runs counter-clockwise
 * @property {Float32Array} hatches two points each
 *
 * @typedef {object} Layer
 * @property {Contours[]} parts
 * @property {Float32Array} crossings the positions of the first of them
 * @property {import('./inside_out.js').InsideOut} insideOut
 */

class PointReader {
  constructor(reader, step) {
    this.reader = reader;
    this.step = step;
    this.x = 0;
    this.y = 0;
  }

  /** Reads `count` points into `out` from number `at` on. */
  read(count, out, at) {
    for (let i = 2 * at; i < 2 * (at + count); i += 2) {
      this.x += this.reader.nextSigned();
      this.y += this.reader.nextSigned();
      out[i] = this.x * this.step;
      out[i + 1] = this.y * this.step;
    }
  }
}

/** @returns {Float32Array} */
function readPoints(reader, step, count) {
  const points = new Float32Array(2 * count);
  new PointReader(reader, step).read(count, points, 0);
  return points;
}

/** Twice the area is summed about the first point, so that rings far away lose no digits. */
function measure(points, begin, end, box, areas, i) {
  let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
  let twice = 0;
  const [x0, y0] = [points[2 * begin], points[2 * begin + 1]];
  let [ax, ay] = [0, 0];
  for (let p = begin; p < end; ++p) {
    const [x, y] = [points[2 * p], points[2 * p + 1]];
    left = Math.min(left, x);
    right = Math.max(right, x);
    bottom = Math.min(bottom, y);
    top = Math.max(top, y);
    const [bx, by] = [x - x0, y - y0];
    twice += ax * by - ay * bx;
    [ax, ay] = [bx, by];
  }
  box.set([left, bottom, right, top], 4 * i);
  areas[i] = twice / 2;
}

/** @returns {Contours} */
function readContours(reader, step) {
  const rings = reader.next();
  const contours = rings + reader.next();
  const hatches = reader.next();
  const ends = new Uint32Array(contours);
  const boxes = new Float32Array(4 * contours);
  const areas = new Float32Array(contours);
  // A point takes two bytes or more.
  let points = new Float32Array(Math.max(0, reader.bytes.length - reader.at));
  const walk = new PointReader(reader, step);
  let at = 0;
  for (let i = 0; i < contours; ++i) {
    const count = reader.next();
    walk.read(1, points, at);
    const [firstX, firstY] = [walk.x, walk.y];
    walk.read(count - 1, points, at + 1);
    [walk.x, walk.y] = [firstX, firstY];
    ends[i] = at + count;
    measure(points, at, ends[i], boxes, areas, i);
    at = ends[i];
  }
  points = points.slice(0, 2 * at);
  return { points, ends, rings, boxes, areas, hatches: readPoints(reader, step, 2 * hatches) };
}

/**
 * @param {Uint8Array} bytes unpacked
 * @param {number} parts how many there are
 * @param {number} step mm
 * @returns {Layer}
 */
export function readLayer(bytes, parts, step) {
  const reader = new NumberReader(bytes);
  const layer = { parts: [], crossings: new Float32Array() };
  for (let i = 0; i < parts; ++i) layer.parts.push(readContours(reader, step));
  layer.crossings = readPoints(reader, step, reader.next());
  if (!reader.atEnd) throw new Error('the data of a layer go on after its end');
  return layer;
}

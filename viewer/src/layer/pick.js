import { isVectors } from '../data/exposures.js';
import { partOf } from '../data/vectors.js';
import { brief, count, duration } from '../text.js';

/**
 * What lies under a click on a layer.
 * @typedef {object} Picked
 * @property {'contour'|'vector'} kind
 * @property {number} part of the page
 * @property {number} number of the contour in its part, or of the vector in the layer; both from 0
 * @property {number} distance mm
 */

/** The distance of (x, y) from the line from a to b, mm. */
export function distanceToLine(x, y, ax, ay, bx, by) {
  const [dx, dy] = [bx - ax, by - ay];
  const square = dx * dx + dy * dy;
  const t = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

/** The distance of (x, y) from contour i. */
function distanceToContour({ points, ends, rings }, i, x, y) {
  const begin = i === 0 ? 0 : ends[i - 1];
  const last = ends[i] - 1;
  let distance = Math.hypot(x - points[2 * begin], y - points[2 * begin + 1]);
  for (let p = begin; p <= (i < rings ? last : last - 1); ++p) {
    const q = p === last ? begin : p + 1;
    distance = Math.min(distance, distanceToLine(x, y, points[2 * p], points[2 * p + 1], points[2 * q], points[2 * q + 1]));
  }
  return distance;
}

const reaches = (boxes, i, x, y, reach) =>
  boxes[4 * i] - reach <= x && x <= boxes[4 * i + 2] + reach && boxes[4 * i + 1] - reach <= y && y <= boxes[4 * i + 3] + reach;

/**
 * The contour or vector nearest to (x, y), no farther than `reach` mm; undefined if there is none. Vectors that are not yet
 * executed and parts that are hidden are passed over.
 * @param {import('../data/layer.js').Layer} layer
 * @param {import('../data/vectors.js').Vectors|null} vectors of it
 * @param {{parts: object[], hidden: Set<number>, order: number}} options
 * @returns {Picked|undefined}
 */
export function pickAt(layer, vectors, x, y, reach, { parts, hidden, order }) {
  let picked;
  const consider = (kind, part, number, distance) => {
    if (distance <= reach && !(picked?.distance <= distance)) picked = { kind, part, number, distance };
  };
  layer.parts.forEach((contours, part) => {
    if (hidden.has(part) || isVectors(parts[part])) return;
    for (let i = 0; i < contours.ends.length; ++i)
      if (reaches(contours.boxes, i, x, y, reach)) consider('contour', part, i, distanceToContour(contours, i, x, y));
  });
  if (vectors === null) return picked;
  const { lines } = vectors;
  for (let i = 0; i < Math.min(order, vectors.count); ++i) {
    const distance = distanceToLine(x, y, lines[4 * i], lines[4 * i + 1], lines[4 * i + 2], lines[4 * i + 3]);
    if (distance > reach || picked?.distance <= distance) continue;
    const part = partOf(vectors, i);
    if (!hidden.has(part)) consider('vector', part, i, distance);
  }
  return picked;
}

/** The corner of a contour or the end of a vector nearest to (x, y), no farther than `reach`; else (x, y) itself. */
export function cornerNear(layer, x, y, reach, { hidden }) {
  let [found, distance] = [[x, y], reach];
  const consider = (px, py) => {
    const d = Math.hypot(px - x, py - y);
    if (d <= distance) [found, distance] = [[px, py], d];
  };
  layer.parts.forEach(({ points, ends, boxes, hatches }, part) => {
    if (hidden.has(part)) return;
    for (let i = 0; i < ends.length; ++i) {
      if (!reaches(boxes, i, x, y, reach)) continue;
      for (let p = i === 0 ? 0 : ends[i - 1]; p < ends[i]; ++p) consider(points[2 * p], points[2 * p + 1]);
    }
    for (let p = 0; p < hatches.length; p += 2) consider(hatches[p], hatches[p + 1]);
  });
  return found;
}

function lengthOf({ points, ends, rings }, i) {
  const begin = i === 0 ? 0 : ends[i - 1];
  let length = 0;
  for (let p = begin; p < ends[i]; ++p) {
    const q = p + 1 < ends[i] ? p + 1 : i < rings ? begin : p;
    length += Math.hypot(points[2 * q] - points[2 * p], points[2 * q + 1] - points[2 * p + 1]);
  }
  return length;
}

const named = (label, others) => (others ? `${label}: ` : '');

/** The figures of what was picked, in one line. */
export function pickText(picked, layer, vectors, parts) {
  if (picked.kind === 'vector') {
    const { lines, seconds } = vectors;
    const i = picked.number;
    const { part, region, kind, contour, parameters } = parts[picked.part].exposure;
    const bodies = new Set(parts.map(({ exposure }) => exposure?.part));
    const { power_w, speed_mm_s } = parameters;
    return [
      `${named(part, bodies.size > 1)}${region} ${kind}${contour > 0 ? ` ${contour}` : ''}, vector ${count(i + 1)}`,
      `${brief(Math.hypot(lines[4 * i + 2] - lines[4 * i], lines[4 * i + 3] - lines[4 * i + 1]))} mm long`,
      ...(power_w > 0 ? [`${brief(power_w)} W`] : []),
      ...(speed_mm_s > 0 ? [`${brief(speed_mm_s)} mm/s`, `ends at ${duration(seconds[i])}`] : []),
    ].join(', ');
  }
  const contours = layer.parts[picked.part];
  const i = picked.number;
  const points = contours.ends[i] - (i === 0 ? 0 : contours.ends[i - 1]);
  const kind = i >= contours.rings ? 'open contour' : contours.areas[i] < 0 ? 'hole' : 'outer contour';
  return [
    `${named(parts[picked.part].label, parts.length > 1)}${kind} ${count(i + 1)}`,
    ...(i < contours.rings ? [`${brief(Math.abs(contours.areas[i]))} mm²`] : []),
    `${brief(lengthOf(contours, i))} mm around`,
    `${count(points)} points`,
  ].join(', ').replace(/(open contour [^]*) mm around/, '$1 mm long');
}

/** "12.5 mm (x 10, y 7.5), 36.9°": from a to b. */
export function distanceText([ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const degrees = (Math.atan2(dy, dx) * 180) / Math.PI;
  return `${brief(Math.hypot(dx, dy))} mm (x ${brief(dx)}, y ${brief(dy)}), ${brief(Math.round(degrees * 10) / 10)}°`;
}

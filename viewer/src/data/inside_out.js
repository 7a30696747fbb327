/**
 * Which rings of a layer are inside out: they run clockwise where there is no material to take away.
 * @typedef {object} InsideOut
 * @property {Set<number>[]} rings of each part
 * @property {number} deepest how many times rings run the wrong way round one point; 0 where none do
 */

/** Calls meet(y, direction) where ring i crosses a vertical line through no vertex: direction 1 from left to right, else -1. */
function cross({ points, ends }, i, x, meet) {
  const begin = i === 0 ? 0 : ends[i - 1];
  let [ax, ay] = [points[2 * ends[i] - 2], points[2 * ends[i] - 1]];
  for (let p = begin; p < ends[i]; ++p) {
    const [bx, by] = [points[2 * p], points[2 * p + 1]];
    if (ax < x !== bx < x) meet(ay + ((by - ay) * (x - ax)) / (bx - ax), ax < x ? 1 : -1);
    [ax, ay] = [bx, by];
  }
}

/** A point within ring i, hard by its left end. */
function pointWithin(contours, i, step) {
  const x = contours.boxes[4 * i] + step / 2;
  const crossings = [];
  cross(contours, i, x, (y) => crossings.push(y));
  crossings.sort((a, b) => a - b);
  return [x, (crossings[0] + crossings[1]) / 2];
}

/**
 * As the library decides it, by the winding number of all other rings of material at a ring's left end.
 * @param {import('./layer.js').Contours[]} parts of a layer
 * @param {(part: number) => boolean} bounds whether the rings of a part bound material
 * @param {number} step mm: coordinates are multiples of it
 * @returns {InsideOut}
 */
export function insideOutOf(parts, bounds, step) {
  const bounding = parts.filter((_, part) => bounds(part));
  /** Times that other rings run counter-clockwise around ring i: their boxes hold its box. */
  const windingAround = (ring, i) => {
    const [left, bottom, right, top] = ring.boxes.subarray(4 * i, 4 * i + 4);
    const [x, y] = pointWithin(ring, i, step);
    let winding = 0;
    for (const contours of bounding) {
      const { boxes, rings } = contours;
      for (let k = 0; k < rings; ++k) {
        const holds = boxes[4 * k] <= left && boxes[4 * k + 1] <= bottom && boxes[4 * k + 2] >= right && boxes[4 * k + 3] >= top;
        if (holds && (contours !== ring || k !== i)) cross(contours, k, x, (at, direction) => (winding += at < y ? direction : 0));
      }
    }
    return winding;
  };
  let deepest = 0;
  const rings = parts.map((contours, part) => {
    const found = new Set();
    for (let i = 0; bounds(part) && i < contours.rings; ++i) {
      if (contours.areas[i] >= 0) continue;
      const winding = windingAround(contours, i);
      if (winding > 0) continue;
      found.add(i);
      deepest = Math.max(deepest, 1 - winding);
    }
    return found;
  });
  return { rings, deepest };
}

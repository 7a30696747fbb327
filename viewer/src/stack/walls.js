/**
 * The walls of layers: one standing rectangle for each line of a contour, from the bottom to the top of its
 * layer, for the graphics card to draw as instances.
 */

/** Lines that turn by less meet in a round edge. */
const roundCosine = Math.cos((40 * Math.PI) / 180);

/** Points of a contour, without those closer than `apart` to the one kept before. */
function keptPoints(contours, i, apart) {
  const { points, ends } = contours;
  const kept = [];
  let [x, y] = [NaN, NaN];
  for (let p = i === 0 ? 0 : ends[i - 1]; p < ends[i]; ++p) {
    const [nextX, nextY] = [points[2 * p], points[2 * p + 1]];
    if ((nextX - x) ** 2 + (nextY - y) ** 2 < apart * apart) continue;
    [x, y] = [nextX, nextY];
    kept.push(x, y);
  }
  return kept;
}

/** Grows; holds what the instances of one piece of the stack are made of. */
export class Walls {
  constructor() {
    this.ends = []; // two points
    this.heights = []; // bottom, top
    this.normals = []; // at the two points, outwards, -127 to 127
    this.info = []; // number of the layer; number of the part, 0.5 more where the contour is open
    this.counts = []; // instances up to the end of each layer
  }

  get size() {
    return this.heights.length / 2;
  }

  /**
   * @param {import('../data/layer.js').Layer} layer
   * @param {{number: number, bottom: number, top: number}} place
   * @param {number} apart mm: points closer than this to one another are left out
   */
  add(layer, place, apart) {
    layer.parts.forEach((contours, part) => {
      for (let i = 0; i < contours.ends.length; ++i) this.#addContour(keptPoints(contours, i, apart), i < contours.rings, place, part);
    });
    this.counts.push(this.size);
  }

  #addContour(points, closed, { number, bottom, top }, part) {
    const n = points.length / 2;
    if (n < (closed ? 3 : 2)) return;
    const lines = closed ? n : n - 1;
    const normals = new Float64Array(2 * lines);
    for (let i = 0; i < lines; ++i) {
      const j = (i + 1) % n;
      const [dx, dy] = [points[2 * j] - points[2 * i], points[2 * j + 1] - points[2 * i + 1]];
      const length = Math.hypot(dx, dy) || 1;
      normals[2 * i] = dy / length; // material lies to the left
      normals[2 * i + 1] = -dx / length;
    }
    /** The normal of line i at the point that it shares with line k. */
    const shared = (i, k) => {
      const [ax, ay] = [normals[2 * i], normals[2 * i + 1]];
      const known = closed || (k >= 0 && k < lines);
      const at = ((k % lines) + lines) % lines;
      const [bx, by] = known ? [normals[2 * at], normals[2 * at + 1]] : [ax, ay];
      if (ax * bx + ay * by < roundCosine) return [ax, ay];
      const length = Math.hypot(ax + bx, ay + by);
      return [(ax + bx) / length, (ay + by) / length];
    };
    for (let i = 0; i < lines; ++i) {
      const j = (i + 1) % n;
      this.ends.push(points[2 * i], points[2 * i + 1], points[2 * j], points[2 * j + 1]);
      this.heights.push(bottom, top);
      for (const k of [i - 1, i + 1]) for (const c of shared(i, k)) this.normals.push(Math.round(127 * c));
      this.info.push(number, closed ? part : part + 0.5);
    }
  }
}

/**
 * The least distance, of 0, `least`, 2 `least`, ..., at which a layer keeps no more points than `most`.
 */
export function spacingFor(layer, most, least) {
  let apart = 0;
  const kept = () =>
    layer.parts.reduce((all, contours) => {
      for (let i = 0; i < contours.ends.length; ++i) all += keptPoints(contours, i, apart).length / 2;
      return all;
    }, 0);
  const points = layer.parts.reduce((all, contours) => all + contours.points.length / 2, 0);
  if (points <= most) return 0;
  for (apart = least; kept() > most && apart < 64 * least; ) apart *= 2;
  return apart;
}

import { isVectors } from '../data/exposures.js';

/**
 * The walls of layers: one standing rectangle for each line of a contour, from the bottom to the top of its
 * layer. The graphics card reads them from a texture.
 */

/** What the contour of a line is: closed; a chain of scan vectors; or a fault: an open chain of material, or a ring inside out. */
export const lineKinds = { ring: 0, vectors: 1, fault: 2 };

/** Lines that turn by less meet in a round edge. */
const roundCosine = Math.cos((40 * Math.PI) / 180);

/** Numbers that each line takes: eight, two texels. */
const numbersOfLine = 8;
/** Lines in each row of the texture. */
export const linesOfRow = 1024;

/** Room for the points of one contour; grows. */
let kept = new Float32Array(2048);

/** Puts points of a contour into `kept`, without those closer than `apart` to the one before. @returns {number} how many */
function keepPoints({ points, ends }, i, apart) {
  const begin = i === 0 ? 0 : ends[i - 1];
  if (kept.length < 2 * (ends[i] - begin)) kept = new Float32Array(4 * (ends[i] - begin));
  let count = 0;
  let [x, y] = [NaN, NaN];
  for (let p = begin; p < ends[i]; ++p) {
    const nextX = points[2 * p];
    const nextY = points[2 * p + 1];
    if ((nextX - x) ** 2 + (nextY - y) ** 2 < apart * apart) continue;
    x = kept[2 * count] = nextX;
    y = kept[2 * count + 1] = nextY;
    ++count;
  }
  return count;
}

/** As GLSL's unpackSnorm2x16 takes it. */
const packed = (x, y) => (Math.round(32767 * x) & 0xffff) | (Math.round(32767 * y) << 16);

/**
 * Grows; holds the lines of one piece of the stack. Of each line: its two points, as bits of floats; the number of the
 * layer; four times the number of the part, and what the contour is, of `lineKinds`; and the normals at the two points,
 * outwards.
 */
export class Walls {
  #chains; // the kind of them, for each part
  #numbers = new Uint32Array(numbersOfLine * linesOfRow);
  #floats = new Float32Array(this.#numbers.buffer);
  size = 0;
  layers = []; // their numbers
  counts = []; // lines up to the end of each of these

  /** @param {object[]} parts of the head */
  constructor(parts) {
    this.#chains = parts.map((part) => (isVectors(part) ? lineKinds.vectors : lineKinds.fault));
  }

  /** The lines in whole rows. */
  get rows() {
    return this.#numbers.subarray(0, numbersOfLine * linesOfRow * Math.max(1, Math.ceil(this.size / linesOfRow)));
  }

  /**
   * @param {import('../data/layer.js').Layer} layer
   * @param {number} number of the layer
   * @param {number} apart mm: points closer than this to one another are left out
   */
  add(layer, number, apart) {
    layer.parts.forEach((contours, part) => {
      for (let i = 0; i < contours.ends.length; ++i) {
        const closed = i < contours.rings;
        const kind = !closed ? this.#chains[part] : layer.insideOut.rings[part].has(i) ? lineKinds.fault : lineKinds.ring;
        this.#addContour(keepPoints(contours, i, apart), closed, kind, number, part);
      }
    });
    this.layers.push(number);
    this.counts.push(this.size);
  }

  #makeRoom(lines) {
    const needed = numbersOfLine * (this.size + lines);
    if (needed <= this.#numbers.length) return;
    let length = this.#numbers.length;
    while (length < needed) length *= 2;
    const larger = new Uint32Array(length);
    larger.set(this.#numbers);
    this.#numbers = larger;
    this.#floats = new Float32Array(larger.buffer);
  }

  /** The first n points kept. */
  #addContour(n, closed, kind, number, part) {
    if (n < (closed ? 3 : 2)) return;
    const lines = closed ? n : n - 1;
    this.#makeRoom(lines);
    const numbers = this.#numbers;
    const floats = this.#floats;
    const normal = (i) => {
      const j = i + 1 === n ? 0 : i + 1;
      const dx = kept[2 * j] - kept[2 * i];
      const dy = kept[2 * j + 1] - kept[2 * i + 1];
      const length = Math.sqrt(dx * dx + dy * dy) || 1;
      return [dy / length, -dx / length]; // material lies to the left
    };
    /** Of two lines that meet: the one between them, or that of the first, where they meet in an edge. */
    const shared = (a, b) => {
      if (a[0] * b[0] + a[1] * b[1] < roundCosine) return packed(a[0], a[1]);
      const length = Math.hypot(a[0] + b[0], a[1] + b[1]);
      return packed((a[0] + b[0]) / length, (a[1] + b[1]) / length);
    };
    let own = normal(0);
    let before = closed ? normal(n - 1) : own;
    for (let i = 0; i < lines; ++i) {
      const j = i + 1 === n ? 0 : i + 1;
      const after = closed || i + 1 < lines ? normal(j) : own;
      const at = numbersOfLine * this.size++;
      floats[at] = kept[2 * i];
      floats[at + 1] = kept[2 * i + 1];
      floats[at + 2] = kept[2 * j];
      floats[at + 3] = kept[2 * j + 1];
      numbers[at + 4] = number;
      numbers[at + 5] = 4 * part + kind;
      numbers[at + 6] = shared(own, before);
      numbers[at + 7] = shared(own, after);
      [before, own] = [own, after];
    }
  }
}

/**
 * The least distance, of 0, `least`, 2 `least`, ..., at which a layer keeps no more points than `most`.
 */
export function spacingFor(layer, most, least) {
  let apart = 0;
  const count = () =>
    layer.parts.reduce((all, contours) => {
      for (let i = 0; i < contours.ends.length; ++i) all += keepPoints(contours, i, apart);
      return all;
    }, 0);
  const points = layer.parts.reduce((all, contours) => all + contours.points.length / 2, 0);
  if (points <= most) return 0;
  for (apart = least; count() > most && apart < 64 * least; ) apart *= 2;
  return apart;
}

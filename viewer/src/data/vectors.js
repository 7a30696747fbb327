import { isVectors } from './exposures.js';

/**
 * The scan vectors of one layer in the order in which they are executed.
 * @typedef {object} Vectors
 * @property {number} count
 * @property {Float32Array} lines of each: where it begins and where it ends
 * @property {Uint32Array} ends one past the last vector of each part of the page
 * @property {Float64Array} seconds from the begin of the layer to the end of each, by the parameters in the file: the same rule
 *     as measure_vectors of the library
 */

/** Whether the beam jumps to vector i. */
export const jumpsTo = ({ lines }, i) => i > 0 && (lines[4 * i] !== lines[4 * i - 2] || lines[4 * i + 1] !== lines[4 * i - 1]);

/** The part of the page that vector i belongs to. */
export const partOf = ({ ends }, i) => ends.findIndex((end) => i < end);

function countOf({ ends, rings, hatches }) {
  let lines = hatches.length / 4;
  for (let c = 0; c < ends.length; ++c) lines += ends[c] - (c === 0 ? 0 : ends[c - 1]) - (c < rings ? 0 : 1);
  return lines;
}

/** Puts the vectors of a part into `lines`, from vector `at` on. @returns {number} one past the last */
function put({ points, ends, rings, hatches }, lines, at) {
  const line = (from, to) => lines.set([points[2 * from], points[2 * from + 1], points[2 * to], points[2 * to + 1]], 4 * at++);
  let begin = 0;
  ends.forEach((end, c) => {
    for (let p = begin; p + 1 < end; ++p) line(p, p + 1);
    if (c < rings) line(end - 1, begin);
    begin = end;
  });
  lines.set(hatches, 4 * at);
  return at + hatches.length / 4;
}

/** What the parameters say of the time of each vector. */
function timed(vectors, parts) {
  const { lines, ends, seconds } = vectors;
  let now = 0;
  let i = 0;
  let delay = 0; // after the run of lines that goes on
  /** For the way at numbers k of `lines`; none where the speed is unknown. */
  const secondsOf = (k, speed) => (speed > 0 ? Math.hypot(lines[k + 2] - lines[k], lines[k + 3] - lines[k + 1]) / speed : 0);
  const endRun = () => {
    now += delay;
    if (i > 0) seconds[i - 1] = now;
  };
  parts.forEach(({ exposure }, part) => {
    if (i === ends[part]) return;
    const { speed_mm_s, jump_speed_mm_s, mark_delay_us, jump_delay_us } = exposure.parameters;
    const first = i;
    for (; i < ends[part]; ++i) {
      const jumps = jumpsTo(vectors, i);
      if (jumps || i === first) {
        endRun();
        delay = 1e-6 * mark_delay_us;
      }
      if (jumps) now += secondsOf(4 * i - 2, jump_speed_mm_s) + 1e-6 * jump_delay_us;
      now += secondsOf(4 * i, speed_mm_s);
      seconds[i] = now;
    }
  });
  endRun();
}

/**
 * @param {import('./layer.js').Layer} layer
 * @param {{exposure?: object}[]} parts of the head
 * @returns {Vectors}
 */
export function vectorsOf(layer, parts) {
  const exposed = (part) => isVectors(parts[part]);
  const count = layer.parts.reduce((sum, contours, part) => sum + (exposed(part) ? countOf(contours) : 0), 0);
  const vectors = { count, lines: new Float32Array(4 * count), ends: new Uint32Array(parts.length), seconds: new Float64Array(count) };
  let at = 0;
  layer.parts.forEach((contours, part) => {
    if (exposed(part)) at = put(contours, vectors.lines, at);
    vectors.ends[part] = at;
  });
  timed(vectors, parts);
  return vectors;
}

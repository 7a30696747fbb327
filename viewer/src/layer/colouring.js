import { isVectors } from '../data/exposures.js';
import { brief, count, duration } from '../text.js';

/**
 * How scan vectors are coloured: by their region and kind, or by a value on a scale. Vectors between two steps of the scale have
 * one colour, so that many can be drawn in one stroke.
 */

const steps = 24;
// From dark to light blue, green and yellow; lightness rises all the way, so it can be read without colour, too.
const stops = [[0.27, 0.0, 0.33], [0.23, 0.32, 0.55], [0.13, 0.57, 0.55], [0.37, 0.79, 0.38], [0.99, 0.91, 0.14]];

/** The colour at t from 0 to 1. */
export function scaleColour(t) {
  const at = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  return `rgb(${stops[i].map((low, k) => Math.round(255 * (low + (at - i) * (stops[i + 1][k] - low)))).join(' ')})`;
}

/**
 * @typedef {object} Colouring
 * @property {string} name
 * @property {boolean} byVector whether vectors of one part differ
 * @property {(vectors: object, i: number, parts: object[], part: number) => number} value of vector i
 * @property {(value: number) => string} text
 */

/** @type {Record<string, Colouring>} */
export const colourings = {
  power: { name: 'Power', byVector: false, value: (_, __, parts, part) => parts[part].exposure.parameters.power_w, text: (value) => `${brief(value)} W` },
  speed: { name: 'Speed', byVector: false, value: (_, __, parts, part) => parts[part].exposure.parameters.speed_mm_s, text: (value) => `${brief(value)} mm/s` },
  time: { name: 'Time', byVector: true, value: ({ seconds }, i) => seconds[i], text: duration },
  order: { name: 'Order', byVector: true, value: (_, i) => i + 1, text: count },
};

/** The colourings that tell something: parts without powers and speeds have none. */
export function usefulColourings({ parts }) {
  const exposed = parts.filter(isVectors).map(({ exposure }) => exposure.parameters);
  const known = { power: exposed.some(({ power_w }) => power_w > 0), speed: exposed.some(({ speed_mm_s }) => speed_mm_s > 0), order: exposed.length > 0 };
  known.time = known.speed;
  return Object.keys(colourings).filter((key) => known[key]);
}

/** The values at both ends of the scale: of the whole page for parameters, of the layer for time and order. */
export function rangeOf(key, vectors, parts) {
  const { byVector, value } = colourings[key];
  if (byVector) return vectors.count === 0 ? [0, 0] : [key === 'order' ? 1 : 0, value(vectors, vectors.count - 1)];
  const values = parts.flatMap((each, part) => (isVectors(each) ? [value(vectors, 0, parts, part)] : []));
  return [Math.min(...values), Math.max(...values)];
}

/**
 * Divides vectors from..to of one part into runs of one colour.
 * @returns {{end: number, colour: string}[]}
 */
export function runsOf(key, range, vectors, from, to, parts, part) {
  const { byVector, value } = colourings[key];
  const [low, high] = range;
  const step = (i) => (high > low ? Math.round(((value(vectors, i, parts, part) - low) / (high - low)) * (steps - 1)) : steps - 1);
  if (!byVector) return [{ end: to, colour: scaleColour(step(from) / (steps - 1)) }];
  const runs = [];
  for (let i = from; i < to; ) {
    const now = step(i);
    // Times and numbers rise: the end of the run is found by halving.
    let [below, above] = [i, to];
    while (above - below > 1) {
      const middle = (below + above) >> 1;
      if (step(middle) === now) below = middle;
      else above = middle;
    }
    runs.push({ end: above, colour: scaleColour(now / (steps - 1)) });
    i = above;
  }
  return runs;
}

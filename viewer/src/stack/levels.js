/**
 * The order in which layers are put up: every `stride`-th, then those in the middle between two of them, and so on, so
 * that a few of them already show the whole stack.
 * @param {number} count of layers
 * @param {number} stride a power of two
 * @returns {number[][]} numbers of the layers of each level; with the levels below it, they are evenly spaced
 */
export function levelsOf(count, stride) {
  const every = (first, step) => Array.from({ length: Math.max(0, Math.ceil((count - first) / step)) }, (_, i) => first + i * step);
  const levels = [every(0, stride)];
  for (let step = stride; step > 1; step /= 2) levels.push(every(step / 2, step));
  return levels;
}

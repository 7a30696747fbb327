import { colourOfVectors } from '../data/exposures.js';
import { jumpsTo, partOf } from '../data/vectors.js';
import { rangeOf, runsOf } from './colouring.js';

/** Draws scan vectors as they are executed: contours strong, hatches thin, the ways between them faint. */

const linesOfPath = 1000; // strokes of longer paths take more time for each line
const least = 0.4; // pixels: lines of a run that go less far are drawn together
const widths = { contour: 2.2, hatch: 1 };

/** Whether the box about a line reaches into the canvas. */
function seen(camera, ax, ay, bx, by) {
  return Math.max(ax, bx) >= 0 && Math.min(ax, bx) <= camera.width && Math.max(ay, by) >= 0 && Math.min(ay, by) <= camera.height;
}

/** The lines from..to, none of them of another part; runs without a jump are one line through several points. */
function traceVectors(path, { lines }, from, to, camera) {
  let [atX, atY] = [NaN, NaN]; // where the path is
  let [endX, endY] = [NaN, NaN]; // of the line before
  for (let i = from; i < to; ++i) {
    const bx = camera.toPixelX(lines[4 * i + 2]);
    const by = camera.toPixelY(lines[4 * i + 3]);
    const goesOn = i > from && lines[4 * i] === lines[4 * i - 2] && lines[4 * i + 1] === lines[4 * i - 1];
    const ax = goesOn ? endX : camera.toPixelX(lines[4 * i]);
    const ay = goesOn ? endY : camera.toPixelY(lines[4 * i + 1]);
    [endX, endY] = [bx, by];
    if (!seen(camera, ax, ay, bx, by)) {
      atX = NaN;
      continue;
    }
    const ends = i + 1 === to || lines[4 * i + 4] !== lines[4 * i + 2] || lines[4 * i + 5] !== lines[4 * i + 3];
    if (!goesOn || Number.isNaN(atX)) {
      path.moveTo(ax, ay);
      [atX, atY] = [ax, ay];
    }
    if (!ends && Math.abs(bx - atX) + Math.abs(by - atY) < least) continue;
    path.lineTo(bx, by);
    [atX, atY] = [bx, by];
  }
}

function traceJumps(path, vectors, from, to, camera) {
  const { lines } = vectors;
  for (let i = from; i < to; ++i) {
    if (!jumpsTo(vectors, i)) continue;
    const [ax, ay] = [camera.toPixelX(lines[4 * i - 2]), camera.toPixelY(lines[4 * i - 1])];
    const [bx, by] = [camera.toPixelX(lines[4 * i]), camera.toPixelY(lines[4 * i + 1])];
    if (!seen(camera, ax, ay, bx, by)) continue;
    path.moveTo(ax, ay);
    path.lineTo(bx, by);
  }
}

/**
 * Draws vectors from..to; those before are there already.
 * @param {CanvasRenderingContext2D} ctx in CSS pixels
 * @param {import('./camera.js').Camera} camera
 * @param {import('../data/vectors.js').Vectors} vectors
 * @param {{parts: object[], hidden: Set<number>, jumps: boolean, colours: object, colouring: string}} options `colouring` is a key of
 *     colourings, or 'kind'
 */
export function drawVectors(ctx, camera, vectors, from, to, { parts, hidden, jumps, colours, colouring = 'kind' }) {
  ctx.lineJoin = 'round';
  const range = colouring === 'kind' ? null : rangeOf(colouring, vectors, parts);
  for (let at = from, part = partOf(vectors, from); at < to; part += at === vectors.ends[part] ? 1 : 0) {
    const end = Math.min(to, vectors.ends[part], at + linesOfPath);
    if (jumps) {
      ctx.beginPath();
      traceJumps(ctx, vectors, at, end, camera);
      ctx.strokeStyle = colours.jump;
      ctx.lineWidth = 0.75;
      ctx.stroke();
    }
    if (!hidden.has(part) && at < end) {
      const runs = range === null ? [{ end, colour: colourOfVectors(parts[part], colours) }] : runsOf(colouring, range, vectors, at, end, parts, part);
      let begin = at;
      for (const { end: stop, colour } of runs) {
        ctx.beginPath();
        traceVectors(ctx, vectors, begin, stop, camera);
        ctx.strokeStyle = colour;
        ctx.lineWidth = widths[parts[part].exposure.kind];
        ctx.stroke();
        begin = stop;
      }
    }
    at = end;
  }
}

/** The contours of the layer, hardly to be seen: where vectors are to come. */
export function drawOutline(ctx, camera, vectors, { parts, hidden, colours }) {
  ctx.strokeStyle = colours.outline;
  ctx.lineWidth = 1.2;
  vectors.ends.forEach((end, part) => {
    if (hidden.has(part) || parts[part].exposure?.kind !== 'contour') return;
    for (let at = part === 0 ? 0 : vectors.ends[part - 1]; at < end; at += linesOfPath) {
      ctx.beginPath();
      traceVectors(ctx, vectors, at, Math.min(end, at + linesOfPath), camera);
      ctx.stroke();
    }
  });
}

/** Arrow heads along the first `to` vectors, no two of them close together. */
export function drawVectorDirections(ctx, camera, vectors, to, { parts, hidden, colours }) {
  const cell = 30; // pixels; no two arrows are in neighbouring ones
  const head = 4.5;
  const across = Math.ceil(camera.width / cell) + 2;
  const taken = new Uint8Array(across * (Math.ceil(camera.height / cell) + 2));
  ctx.lineWidth = 1.6;
  let from = 0;
  vectors.ends.forEach((end, part) => {
    const { lines } = vectors;
    if (!hidden.has(part) && parts[part].exposure) {
      ctx.beginPath();
      for (let i = from; i < Math.min(end, to); ++i) {
        const [dx, dy] = [lines[4 * i + 2] - lines[4 * i], lines[4 * i + 1] - lines[4 * i + 3]];
        const length = Math.sqrt(dx * dx + dy * dy);
        if (length * camera.scale < 2 * head) continue;
        const x = camera.toPixelX((lines[4 * i] + lines[4 * i + 2]) / 2);
        const y = camera.toPixelY((lines[4 * i + 1] + lines[4 * i + 3]) / 2);
        if (!seen(camera, x, y, x, y)) continue;
        const at = Math.floor(x / cell) + 1 + across * (Math.floor(y / cell) + 1);
        if (taken[at]) continue;
        for (const row of [at - across, at, at + across]) taken.fill(1, row - 1, row + 2);
        const [ux, uy] = [(dx / length) * head, (dy / length) * head];
        ctx.moveTo(x - ux - uy, y - uy + ux);
        ctx.lineTo(x + ux, y + uy);
        ctx.lineTo(x - ux + uy, y - uy - ux);
      }
      ctx.strokeStyle = colours.vectors[`${parts[part].exposure.region} contour`];
      ctx.stroke();
    }
    from = end;
  });
}

/** Where the beam is after the first `to` vectors. */
export function drawBeam(ctx, camera, { lines }, to, colours) {
  const [x, y] = to === 0 ? [lines[0], lines[1]] : [lines[4 * to - 2], lines[4 * to - 1]];
  ctx.beginPath();
  ctx.arc(camera.toPixelX(x), camera.toPixelY(y), 6, 0, 7);
  ctx.fillStyle = colours.paper;
  ctx.fill();
  ctx.strokeStyle = colours.accent;
  ctx.lineWidth = 3;
  ctx.stroke();
  ctx.beginPath();
  ctx.arc(camera.toPixelX(x), camera.toPixelY(y), 2, 0, 7);
  ctx.fillStyle = colours.accent;
  ctx.fill();
}

import { roundStep } from './round_step.js';

/**
 * Draws what one plane yields. Contours out of sight are passed over, and so are points that lie within a
 * fraction of a pixel of the one before: a layer of a million points takes a frame or two.
 */

const closestPixels = 0.5;

/** Adds contour i of `contours` to the path. */
function trace(path, contours, i, camera) {
  const { points, ends, rings } = contours;
  const begin = i === 0 ? 0 : ends[i - 1];
  const last = ends[i] - 1;
  let x = camera.toPixelX(points[2 * begin]);
  let y = camera.toPixelY(points[2 * begin + 1]);
  path.moveTo(x, y);
  for (let p = begin + 1; p <= last; ++p) {
    const nextX = camera.toPixelX(points[2 * p]);
    const nextY = camera.toPixelY(points[2 * p + 1]);
    if (Math.abs(nextX - x) + Math.abs(nextY - y) < closestPixels && p < last) continue;
    [x, y] = [nextX, nextY];
    path.lineTo(x, y);
  }
  if (i < rings) path.closePath();
}

/** The contours from..to that chosen(i) says, as one path. */
export function pathOf(contours, from, to, camera, chosen = () => true) {
  const path = new Path2D();
  for (let i = from; i < to; ++i) if (camera.sees(contours.boxes, 4 * i) && chosen(i)) trace(path, contours, i, camera);
  return path;
}

function drawGrid(ctx, camera, origin, colours) {
  const step = roundStep(56 / camera.scale);
  const [left, top] = camera.toPlane(0, 0);
  const [right, bottom] = camera.toPlane(camera.width, camera.height);
  for (const [every, colour] of [[step, colours.grid], [5 * step, colours.gridStrong]]) {
    ctx.beginPath();
    for (let x = Math.ceil((left + origin[0]) / every) * every; x <= right + origin[0]; x += every) {
      const at = Math.round(camera.toPixelX(x - origin[0])) + 0.5;
      ctx.moveTo(at, 0);
      ctx.lineTo(at, camera.height);
    }
    for (let y = Math.ceil((bottom + origin[1]) / every) * every; y <= top + origin[1]; y += every) {
      const at = Math.round(camera.toPixelY(y - origin[1])) + 0.5;
      ctx.moveTo(0, at);
      ctx.lineTo(camera.width, at);
    }
    ctx.strokeStyle = colour;
    ctx.lineWidth = 1;
    ctx.stroke();
  }
}

function drawHatches(ctx, contours, camera, colour) {
  const { hatches } = contours;
  ctx.beginPath();
  for (let i = 0; i < hatches.length; i += 4) {
    ctx.moveTo(camera.toPixelX(hatches[i]), camera.toPixelY(hatches[i + 1]));
    ctx.lineTo(camera.toPixelX(hatches[i + 2]), camera.toPixelY(hatches[i + 3]));
  }
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1;
  ctx.stroke();
}

/** An arrow head in the middle of a line's way, every so many pixels along a contour. */
function drawDirections(ctx, contours, camera, colours) {
  const every = 90;
  const head = 4.5;
  const most = 1500; // on a canvas; beyond it nobody sees where they point
  let left = most;
  const { points, ends, rings, boxes, areas } = contours;
  for (let i = 0; i < ends.length && left > 0; ++i) {
    if (!camera.sees(boxes, 4 * i)) continue;
    const span = Math.max(boxes[4 * i + 2] - boxes[4 * i], boxes[4 * i + 3] - boxes[4 * i + 1]) * camera.scale;
    if (span < 22) continue;
    const begin = i === 0 ? 0 : ends[i - 1];
    const length = ends[i] - begin;
    const steps = i < rings ? length : length - 1;
    ctx.beginPath();
    let until = Math.min(every / 2, span / 2);
    for (let s = 0; s < steps && left > 0; ++s) {
      const a = 2 * (begin + s);
      const b = 2 * (begin + ((s + 1) % length));
      const ax = camera.toPixelX(points[a]);
      const ay = camera.toPixelY(points[a + 1]);
      const dx = camera.toPixelX(points[b]) - ax;
      const dy = camera.toPixelY(points[b + 1]) - ay;
      const way = Math.hypot(dx, dy);
      for (; until < way && left > 0; until += every) {
        const [x, y] = [ax + (dx * until) / way, ay + (dy * until) / way];
        if (x < -10 || y < -10 || x > camera.width + 10 || y > camera.height + 10) {
          // Far outside, a long line would keep us busy for nothing.
          until += Math.floor(Math.max(0, Math.max(-x, -y, x - camera.width, y - camera.height) - 10) / every) * every;
          continue;
        }
        const [ux, uy] = [(dx / way) * head, (dy / way) * head];
        ctx.moveTo(x - ux - uy, y - uy + ux);
        ctx.lineTo(x + ux, y + uy);
        ctx.lineTo(x - ux + uy, y - uy - ux);
        --left;
      }
      until -= way;
    }
    ctx.strokeStyle = i >= rings ? colours.open : areas[i] > 0 ? colours.outer : colours.hole;
    ctx.lineWidth = 1.6;
    ctx.stroke();
  }
}

function drawOpenChains(ctx, contours, camera, colours) {
  const { points, ends, rings, boxes } = contours;
  ctx.strokeStyle = colours.open;
  ctx.lineWidth = 3;
  ctx.stroke(pathOf(contours, rings, ends.length, camera));
  for (let i = rings; i < ends.length; ++i) {
    if (!camera.sees(boxes, 4 * i)) continue;
    const begin = i === 0 ? 0 : ends[i - 1];
    for (const [p, filled] of [[begin, true], [ends[i] - 1, false]]) {
      ctx.beginPath();
      ctx.arc(camera.toPixelX(points[2 * p]), camera.toPixelY(points[2 * p + 1]), 5, 0, 7);
      ctx.fillStyle = filled ? colours.open : colours.paper;
      ctx.fill();
      ctx.lineWidth = 2;
      ctx.stroke();
    }
  }
}

/** Crosses in circles. @param {Float32Array|number[]} places x and y in turn */
function drawMarks(ctx, places, camera, colour) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = 2;
  ctx.beginPath();
  for (let i = 0; i < places.length; i += 2) {
    const x = camera.toPixelX(places[i]);
    const y = camera.toPixelY(places[i + 1]);
    ctx.moveTo(x + 9, y);
    ctx.arc(x, y, 9, 0, 2 * Math.PI);
    ctx.moveTo(x - 4, y - 4);
    ctx.lineTo(x + 4, y + 4);
    ctx.moveTo(x + 4, y - 4);
    ctx.lineTo(x - 4, y + 4);
  }
  ctx.stroke();
}

/**
 * @param {CanvasRenderingContext2D} ctx in CSS pixels
 * @param {import('./camera.js').Camera} camera
 * @param {import('../data/layer.js').Layer} layer
 * @param {{origin: number[], colours: object, partColours: string[], hidden: Set<number>, marks: number[],
 *          fill: boolean, lines: boolean, directions: boolean, hatches: boolean}} options
 */
export function drawLayer(ctx, camera, layer, options) {
  const { colours } = options;
  ctx.fillStyle = colours.paper;
  ctx.fillRect(0, 0, camera.width, camera.height);
  drawGrid(ctx, camera, options.origin, colours);
  ctx.lineJoin = 'round';
  ctx.lineCap = 'round';
  layer.parts.forEach((contours, part) => {
    if (options.hidden.has(part)) return;
    const all = contours.ends.length;
    if (options.fill) {
      ctx.fillStyle = options.partColours[part % options.partColours.length];
      ctx.fill(pathOf(contours, 0, contours.rings, camera), 'nonzero');
    }
    if (options.hatches) drawHatches(ctx, contours, camera, colours.hatch);
    if (options.lines) {
      ctx.lineWidth = 1.5;
      ctx.strokeStyle = colours.outer;
      ctx.stroke(pathOf(contours, 0, contours.rings, camera, (i) => contours.areas[i] > 0));
      ctx.strokeStyle = colours.hole;
      ctx.stroke(pathOf(contours, 0, contours.rings, camera, (i) => !(contours.areas[i] > 0)));
    }
    if (options.directions) drawDirections(ctx, contours, camera, colours);
    if (all > contours.rings) drawOpenChains(ctx, contours, camera, colours);
  });
  drawMarks(ctx, layer.crossings, camera, colours.crossing);
  drawMarks(ctx, options.marks, camera, colours.place);
}

import { roundStep } from './round_step.js';

/**
 * Draws what one plane yields. Contours out of sight are passed over, and so are points where the line is as good as
 * straight: a layer of a million points takes a frame or two.
 */

const tolerance = 0.1; // pixels that a line may be beside the points left out
const pointsOfPath = 1000; // strokes of longer paths take more time for each point

/**
 * Adds contour i of `contours` to the path, in pixels. From the point drawn last on, each further one leaves a cone of
 * directions that pass by it closely enough; the line goes on while they have one in common.
 * @returns {number} points drawn
 */
export function trace(path, contours, i, camera) {
  const { points, ends, rings } = contours;
  const begin = i === 0 ? 0 : ends[i - 1];
  let [fromX, fromY] = [camera.toPixelX(points[2 * begin]), camera.toPixelY(points[2 * begin + 1])];
  let [lastX, lastY] = [fromX, fromY];
  let [leftX, leftY, rightX, rightY] = [0, 0, 0, 0]; // the sides of the cone
  let farthest = 0; // 0: every direction will do
  let drawn = 1;
  path.moveTo(fromX, fromY);
  for (let p = begin + 1; p < ends[i]; ++p) {
    const x = camera.toPixelX(points[2 * p]);
    const y = camera.toPixelY(points[2 * p + 1]);
    let [dx, dy] = [x - fromX, y - fromY];
    let distance = Math.sqrt(dx * dx + dy * dy);
    const beyond = farthest > 0 && (dx * leftY - dy * leftX < 0 || rightX * dy - rightY * dx < 0);
    if (beyond || distance < farthest - tolerance) {
      path.lineTo(lastX, lastY);
      ++drawn;
      [fromX, fromY] = [lastX, lastY];
      [dx, dy] = [x - fromX, y - fromY];
      distance = Math.sqrt(dx * dx + dy * dy);
      farthest = 0;
    }
    if (distance > tolerance) {
      const sine = tolerance / distance;
      const cosine = Math.sqrt(1 - sine * sine);
      const [ax, ay] = [dx * cosine - dy * sine, dx * sine + dy * cosine];
      const [bx, by] = [dx * cosine + dy * sine, dy * cosine - dx * sine];
      if (farthest === 0 || ax * leftY - ay * leftX > 0) [leftX, leftY] = [ax, ay];
      if (farthest === 0 || rightX * by - rightY * bx > 0) [rightX, rightY] = [bx, by];
      farthest = Math.max(farthest, distance);
    }
    [lastX, lastY] = [x, y];
  }
  path.lineTo(lastX, lastY);
  if (i < rings) path.closePath();
  return drawn + 1;
}

/** Paths that hold the contours from..to that chosen(i) says. */
function pathsOf(contours, from, to, camera, chosen) {
  const paths = [];
  let room = 0;
  for (let i = from; i < to; ++i) {
    if (!camera.sees(contours.boxes, 4 * i) || !chosen(i)) continue;
    if (room <= 0) {
      paths.push(new Path2D());
      room = pointsOfPath;
    }
    room -= trace(paths.at(-1), contours, i, camera);
  }
  return paths;
}

/** All rings, to be filled. */
export function pathOf(contours, camera) {
  return joined(pathsOf(contours, 0, contours.rings, camera, () => true));
}

/** Diagonal lines with nothing between them. */
function stripes(ctx, colour) {
  const size = 8;
  const tile = document.createElement('canvas');
  [tile.width, tile.height] = [size, size];
  const tileCtx = tile.getContext('2d');
  tileCtx.strokeStyle = colour;
  tileCtx.lineWidth = 2;
  for (const x of [-size, 0, size]) {
    tileCtx.moveTo(x - 1, size + 1);
    tileCtx.lineTo(x + size + 1, -1);
  }
  tileCtx.stroke();
  return ctx.createPattern(tile, 'repeat');
}

/**
 * Fills a path where its rings run counter-clockwise around a point once or more; where they run clockwise around it, up to
 * `deepest` times, there are stripes.
 */
export function fillMaterial(ctx, path, { width, height }, colour, deepest, faultColour) {
  ctx.save();
  if (deepest > 0) {
    ctx.fillStyle = stripes(ctx, faultColour);
    ctx.fill(path, 'nonzero');
  }
  // A path is filled where its winding number is not 0. With n frames around the canvas, that is where it was not -n.
  const framed = new Path2D(path);
  for (let frames = 1; frames <= deepest; ++frames) {
    framed.moveTo(-1, -1);
    framed.lineTo(-1, height + 1);
    framed.lineTo(width + 1, height + 1);
    framed.lineTo(width + 1, -1);
    framed.closePath();
    ctx.clip(framed, 'nonzero');
  }
  ctx.fillStyle = colour;
  ctx.fill(path, 'nonzero');
  ctx.restore();
}

function joined(paths) {
  const all = new Path2D();
  for (const path of paths) all.addPath(path);
  return all;
}

function stroke(ctx, paths, colour) {
  ctx.strokeStyle = colour;
  for (const path of paths) ctx.stroke(path);
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

/** An arrow head in the middle of a line's way, at equal distances along a contour. */
function drawDirections(ctx, contours, camera, colours, colourOf) {
  const every = 90;
  const head = 4.5;
  const most = 1500; // on a canvas; beyond it nobody sees where they point
  let left = most;
  const { points, ends, rings, boxes } = contours;
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
    ctx.strokeStyle = i >= rings ? colours.open : colourOf(i);
    ctx.lineWidth = 1.6;
    ctx.stroke();
  }
}

function drawOpenChains(ctx, contours, camera, colours) {
  const { points, ends, rings, boxes } = contours;
  ctx.lineWidth = 3;
  stroke(ctx, pathsOf(contours, rings, ends.length, camera, () => true), colours.open);
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

/** A cross in a circle. */
function addCrossing(ctx, x, y) {
  ctx.moveTo(x + 9, y);
  ctx.arc(x, y, 9, 0, 2 * Math.PI);
  ctx.moveTo(x - 4, y - 4);
  ctx.lineTo(x + 4, y + 4);
  ctx.moveTo(x + 4, y - 4);
  ctx.lineTo(x - 4, y + 4);
}

/** A square on its corner. */
function addDefect(ctx, x, y) {
  ctx.moveTo(x, y - 10);
  ctx.lineTo(x + 10, y);
  ctx.lineTo(x, y + 10);
  ctx.lineTo(x - 10, y);
  ctx.closePath();
}

/** @param {Float32Array|number[]} positions x and y in turn @param {(ctx, x: number, y: number) => void} add a mark there */
function drawMarks(ctx, positions, camera, colour, add) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = 2;
  ctx.beginPath();
  for (let i = 0; i < positions.length; i += 2) add(ctx, camera.toPixelX(positions[i]), camera.toPixelY(positions[i + 1]));
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
    const { rings, areas, ends } = contours;
    const insideOut = layer.insideOut.rings[part];
    const colourOf = (i) => (insideOut.has(i) ? colours.open : areas[i] > 0 ? colours.outer : colours.hole);
    const lines = [colours.outer, colours.hole, colours.open].map((colour) => [colour, pathsOf(contours, 0, rings, camera, (i) => colourOf(i) === colour)]);
    if (options.fill) {
      const colour = options.partColours[part % options.partColours.length];
      fillMaterial(ctx, joined(lines.flatMap(([, paths]) => paths)), camera, colour, layer.insideOut.deepest, colours.open);
    }
    if (options.hatches) drawHatches(ctx, contours, camera, colours.hatch);
    if (options.lines) {
      ctx.lineWidth = 1.5;
      for (const [colour, paths] of lines) stroke(ctx, paths, colour);
    }
    if (options.directions) drawDirections(ctx, contours, camera, colours, colourOf);
    if (ends.length > rings) drawOpenChains(ctx, contours, camera, colours);
  });
}

/** Marks crossings of contours, and defects of the mesh: over all else. The options are those of drawLayer. */
export function drawFaults(ctx, camera, layer, { colours, marks }) {
  drawMarks(ctx, layer.crossings, camera, colours.crossing, addCrossing);
  drawMarks(ctx, marks, camera, colours.place, addDefect);
}

import { largest, least } from '../extremes.js';

/** Where layers lie along an axis as wide as a slider's track: in the middle of its thumb. */
export class LayerAxis {
  static thumb = 16; // pixels, as in styles.css

  constructor(count, width) {
    this.count = count;
    this.width = width;
  }

  /** Pixels from the left. */
  at(layer) {
    const inset = LayerAxis.thumb / 2;
    return inset + (this.count < 2 ? 0 : layer / (this.count - 1)) * (this.width - 2 * inset);
  }

  /** The layer nearest to a pixel. */
  layerAt(pixel) {
    const inset = LayerAxis.thumb / 2;
    const t = (pixel - inset) / Math.max(1, this.width - 2 * inset);
    return Math.min(this.count - 1, Math.max(0, Math.round(t * (this.count - 1))));
  }
}

/**
 * The least and the largest value of those layers that share a pixel: no peak is lost, however many layers.
 * @returns {{x: number, low: number, high: number}[]} from left to right
 */
export function columnsOf(values, axis) {
  const columns = [];
  values.forEach((value, i) => {
    const x = Math.round(axis.at(i));
    const last = columns.at(-1);
    if (last?.x === x) {
      last.low = Math.min(last.low, value);
      last.high = Math.max(last.high, value);
    } else {
      columns.push({ x, low: value, high: value });
    }
  });
  return columns;
}

/** Draws one quantity over the layers. */
export function drawPlot(ctx, values, axis, height, { line, fill }) {
  const columns = columnsOf(values, axis);
  if (columns.length === 1) columns.push({ ...columns[0], x: columns[0].x + 2 }); // so that there is something to see
  const top = Math.max(largest(values), 0);
  const low = Math.min(least(values), 0);
  const margin = 3;
  const y = (value) => height - margin - ((value - low) / (top - low || 1)) * (height - 2 * margin);
  ctx.clearRect(0, 0, axis.width, height);
  const outline = new Path2D();
  for (const column of columns) {
    outline.lineTo(column.x, y(column.high));
    if (column.low !== column.high) {
      outline.lineTo(column.x, y(column.low));
      outline.lineTo(column.x, y(column.high));
    }
  }
  const body = new Path2D();
  body.moveTo(columns[0].x, y(0));
  for (const column of columns) body.lineTo(column.x, y(column.high));
  body.lineTo(columns.at(-1).x, y(0));
  ctx.fillStyle = fill;
  ctx.fill(body);
  ctx.strokeStyle = line;
  ctx.lineWidth = 1.5;
  ctx.lineJoin = 'round';
  ctx.stroke(outline);
}

/** A tick for each layer that has some: rare peaks stay to be seen. */
export function drawTicks(ctx, values, axis, height, colour) {
  const top = Math.max(largest(values), 0);
  ctx.clearRect(0, 0, axis.width, height);
  ctx.fillStyle = colour;
  for (const column of columnsOf(values, axis))
    if (column.high > 0) {
      const tall = 3 + (column.high / top) * (height - 6);
      ctx.fillRect(column.x - 1, height - 3 - tall, 2, tall);
    }
}

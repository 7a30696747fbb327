// Draws layers on a canvas while they come, seen from above: each covers those below it. They come as a binary Common
// Layer file (docs/formats.md).

const mostLayers = 150; // drawn, of all that come
const mostPoints = 20000; // of a layer; a picture shows no more
const [endOfHeader, layerCommand, contourCommand, hatchCommand] = ['$$HEADEREND', 127, 130, 132];

/** Bytes that have come and are not read. Taking them costs their number, whatever the sizes of chunks. */
class Bytes {
  #chunks = [];
  #at = 0; // in the first chunk
  length = 0;

  add(chunk) {
    this.#chunks.push(chunk);
    this.length += chunk.length;
  }

  /** The next bytes, as one array. @param {number} count no more than there are */
  take(count) {
    const taken = new Uint8Array(count);
    for (let filled = 0; filled < count; ) {
      const part = this.#chunks[0].subarray(this.#at, this.#at + count - filled);
      taken.set(part, filled);
      filled += part.length;
      this.#at += part.length;
      if (this.#at === this.#chunks[0].length) {
        this.#chunks.shift();
        this.#at = 0;
      }
    }
    this.length -= count;
    return taken;
  }

  /** Passes over the next bytes. @returns {number} how many there were, at most `count` */
  skip(count) {
    const skipped = Math.min(count, this.length);
    for (let left = skipped; left > 0; ) {
      const there = Math.min(left, this.#chunks[0].length - this.#at);
      left -= there;
      this.#at += there;
      if (this.#at === this.#chunks[0].length) {
        this.#chunks.shift();
        this.#at = 0;
      }
    }
    this.length -= skipped;
    return skipped;
  }
}

/** Reads some of the layers, at equal distances, from chunks of a file. */
export class LayerReader {
  #bytes = new Bytes();
  #header = null;
  #text = ''; // of the header
  #layer = null; // that is read, if it is drawn
  #come = 0; // layers
  #command = null; // whose length is read: { head, length }
  #unwanted = 0; // bytes of a contour that is not drawn

  /** @returns {{header: object, layers: {z: number, contours: Float32Array[]}[]}} layers that have become complete */
  take(chunk) {
    const layers = [];
    if (!this.#header) {
      const rest = this.#takeHeader(chunk);
      if (!rest) return { header: null, layers };
      this.#bytes.add(rest);
    } else {
      this.#bytes.add(chunk);
    }
    while (this.#step(layers));
    return { header: this.#header, layers };
  }

  /** Returns what follows the header, if that has come. It may be long: it has a line for each part. */
  #takeHeader(chunk) {
    const begin = Math.max(0, this.#text.length - endOfHeader.length);
    const before = this.#text.length;
    this.#text += latin1(chunk);
    const end = this.#text.indexOf(endOfHeader, begin);
    if (end < 0) return null;
    const values = (name) => new RegExp(`\\$\\$${name}/([^\\n\\r]*)`).exec(this.#text)[1].split(',').map(Number);
    this.#header = { unit: values('UNITS')[0], box: values('DIMENSION'), layers: values('LAYERS')[0] };
    this.#text = '';
    return chunk.subarray(end + endOfHeader.length - before);
  }

  /** Reads a part of a command. Returns whether there was enough of it. */
  #step(layers) {
    const bytes = this.#bytes;
    if (this.#unwanted > 0) {
      this.#unwanted -= bytes.skip(this.#unwanted);
      return this.#unwanted === 0;
    }
    if (!this.#command) {
      if (bytes.length < 2) return false;
      const id = new DataView(bytes.take(2).buffer).getUint16(0, true);
      this.#command = { id, head: { [layerCommand]: 4, [contourCommand]: 12, [hatchCommand]: 8 }[id] ?? Infinity };
    }
    const { id, head, points } = this.#command;
    if (points !== undefined) {
      if (bytes.length < points) return false;
      this.#layer.contours.push(new Float32Array(bytes.take(points).buffer));
      this.#command = null;
      return true;
    }
    if (bytes.length < head) return false;
    const view = new DataView(bytes.take(head).buffer);
    this.#command = null;
    if (id === layerCommand) {
      if (this.#layer) layers.push(this.#layer);
      const isDrawn = this.#come++ % Math.ceil(this.#header.layers / mostLayers) === 0;
      this.#layer = isDrawn ? { z: view.getFloat32(0, true) * this.#header.unit, contours: [] } : null;
    } else if (id === contourCommand && this.#layer) {
      this.#command = { id, head, points: 8 * view.getInt32(8, true) };
    } else {
      this.#unwanted = id === contourCommand ? 8 * view.getInt32(8, true) : 16 * view.getInt32(4, true);
    }
    return true;
  }
}

const latin1 = (bytes) => new TextDecoder('latin1').decode(bytes);

/** Draws on `canvas`, which `show` makes visible as soon as there is something to see. */
export function previewOn(canvas, show) {
  const reader = new LayerReader();
  let draw = null;
  return (bytes) => {
    const { header, layers } = reader.take(bytes);
    for (const layer of layers) {
      if (!draw) show();
      draw ??= drawingOn(canvas, header);
      draw(layer);
    }
  };
}

function drawingOn(canvas, { unit, box: [x0, y0, z0, x1, y1, z1] }) {
  const scale = window.devicePixelRatio || 1;
  // What is not shown at the moment has no size.
  canvas.width = (canvas.clientWidth || innerWidth) * scale;
  canvas.height = (canvas.clientHeight || innerHeight) * scale;
  const context = canvas.getContext('2d');
  const style = getComputedStyle(canvas);
  context.fillStyle = style.getPropertyValue('--layer');
  context.strokeStyle = style.getPropertyValue('--accent');
  // The plate is seen from a corner, and so is larger to the right and less high than in plan.
  const seen = (x, y, z) => [0.87 * (x - y), -0.35 * (x + y) - 0.94 * z];
  const corners = [x0, x1].flatMap((x) => [y0, y1].flatMap((y) => [z0, z1].map((z) => seen(x, y, z))));
  const range = (axis) => [Math.min(...corners.map((corner) => corner[axis])), Math.max(...corners.map((corner) => corner[axis]))];
  const [left, right] = range(0);
  const [top, bottom] = range(1);
  const zoom = 0.86 * Math.min(canvas.width / (right - left), canvas.height / (bottom - top));
  const [middleX, middleY] = [canvas.width / 2 - (zoom * (left + right)) / 2, canvas.height / 2 - (zoom * (top + bottom)) / 2];
  return ({ z, contours }) => {
    const stride = Math.ceil(contours.reduce((sum, points) => sum + points.length / 2, 0) / mostPoints);
    const path = new Path2D();
    for (const points of contours) {
      for (let i = 0; i < points.length; i += 2 * stride) {
        const [u, v] = seen(points[i] * unit, points[i + 1] * unit, z);
        if (i === 0) path.moveTo(middleX + zoom * u, middleY + zoom * v);
        else path.lineTo(middleX + zoom * u, middleY + zoom * v);
      }
    }
    context.fill(path, 'evenodd');
    context.stroke(path);
  };
}

// Draws layers on a canvas while they come, seen from above: each covers those below it. They come as a binary Common
// Layer file (docs/formats.md).

const mostLayers = 150; // drawn, of all that come
const mostPoints = 20000; // of a layer; a picture shows no more
const [endOfHeader, layerCommand, contourCommand, hatchCommand] = ['$$HEADEREND', 127, 130, 132];

/** Reads some of the layers, at equal distances, from chunks of a file. */
class Reader {
  #rest = new Uint8Array();
  #header = null;
  #layer = null; // that is read
  #come = 0; // layers

  /** @returns {{header: object, layers: {z: number, contours: Float32Array[]}[]} | undefined} layers that have become complete */
  take(bytes) {
    const all = new Uint8Array(this.#rest.length + bytes.length);
    all.set(this.#rest);
    all.set(bytes, this.#rest.length);
    let at = 0;
    const layers = [];
    if (!this.#header) {
      const text = new TextDecoder('latin1').decode(all.subarray(0, 1 << 16));
      const end = text.indexOf(endOfHeader);
      if (end < 0) return void (this.#rest = all);
      const values = (name) => new RegExp(`\\$\\$${name}/([^\\n\\r]*)`).exec(text)[1].split(',').map(Number);
      this.#header = { unit: values('UNITS')[0], box: values('DIMENSION'), layers: values('LAYERS')[0] };
      at = end + endOfHeader.length;
    }
    const view = new DataView(all.buffer);
    for (; at + 14 <= all.length; ) {
      const command = view.getUint16(at, true);
      let next = at + 6;
      if (command === layerCommand) {
        if (this.#layer) layers.push(this.#layer);
        const isDrawn = this.#come++ % Math.ceil(this.#header.layers / mostLayers) === 0;
        this.#layer = isDrawn ? { z: view.getFloat32(at + 2, true) * this.#header.unit, contours: [] } : null;
      } else if (command === contourCommand) {
        next = at + 14 + 8 * view.getInt32(at + 10, true);
        if (next > all.length) break;
        this.#layer?.contours.push(new Float32Array(all.slice(at + 14, next).buffer));
      } else if (command === hatchCommand) {
        next = at + 10 + 16 * view.getInt32(at + 6, true);
      } else {
        break;
      }
      if (next > all.length) break;
      at = next;
    }
    this.#rest = all.slice(at);
    return { header: this.#header, layers };
  }
}

/** Draws on `canvas`, which `show` makes visible as soon as there is something to see. */
export function previewOn(canvas, show) {
  const reader = new Reader();
  let draw = null;
  return (bytes) => {
    const { header, layers } = reader.take(bytes) ?? {};
    for (const layer of layers ?? []) {
      if (!draw) show();
      draw ??= drawingOn(canvas, header);
      draw(layer);
    }
  };
}

function drawingOn(canvas, { unit, box: [x0, y0, z0, x1, y1, z1] }) {
  const scale = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * scale;
  canvas.height = canvas.clientHeight * scale;
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

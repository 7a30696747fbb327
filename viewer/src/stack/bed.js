import { BufferGeometry, CanvasTexture, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry, Sprite, SpriteMaterial, Vector3 } from 'three';
import { roundStep } from '../layer/round_step.js';

const margin = 0.12; // of the longer edge, around the part
const letter = 0.07; // of the part's diagonal: the height of the square around the name of an axis
const arrow = 1.6; // of that height: the length of an axis

/** The name of an axis, always facing the eye. */
function nameOf(text, size) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 64;
  const ctx = canvas.getContext('2d');
  ctx.font = '600 46px system-ui, "DejaVu Sans", sans-serif';
  ctx.textAlign = 'center';
  ctx.textBaseline = 'middle';
  ctx.fillStyle = '#ffffff'; // the material gives it its colour
  ctx.fillText(text, 32, 34);
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), alphaTest: 0.5 }));
  sprite.scale.setScalar(size);
  return sprite;
}

function segments(points) {
  const lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  lines.geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return lines;
}

/** The plate under the part with lines every 1, 2, 5, 10, ... mm, seen from above only, and the axes x and y along its edges. */
export class Bed extends Group {
  #plane;
  #lines;
  #axes;

  /** @param {Vector3} size of the part, mm, which begins at 0, 0, 0 */
  constructor(size) {
    super();
    const longer = Math.max(size.x, size.y, 1e-6);
    const step = roundStep(longer / 8);
    const begin = -Math.ceil((margin * longer) / step) * step;
    const end = (length) => Math.ceil((length + margin * longer) / step) * step;
    const [left, right, front, back] = [begin, end(size.x), begin, end(size.y)];
    const z = -0.0015 * Math.max(size.x, size.y, size.z);
    this.#plane = new Mesh(new PlaneGeometry(right - left, back - front), new MeshBasicMaterial({ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    this.#plane.position.set((left + right) / 2, (front + back) / 2, z);
    const points = [];
    for (let x = left; x <= right + step / 2; x += step) points.push(x, front, z, x, back, z);
    for (let y = front; y <= back + step / 2; y += step) points.push(left, y, z, right, y, z);
    this.#lines = segments(points);

    const height = letter * Math.max(size.length(), 1e-6);
    const length = arrow * height;
    const away = height / 2; // from the edge of the plate
    const [head, x0, y0] = [length / 6, left - away, front - away];
    const [x1, y1] = [x0 + length, y0 + length];
    const arrows = segments([
      ...[x0, y0, z, x1, y0, z, x1, y0, z, x1 - head, y0 - head / 2, z, x1, y0, z, x1 - head, y0 + head / 2, z],
      ...[x0, y0, z, x0, y1, z, x0, y1, z, x0 - head / 2, y1 - head, z, x0, y1, z, x0 + head / 2, y1 - head, z],
    ]);
    const names = [['x', x1 + away, y0], ['y', x0, y1 + away]].map(([text, x, y]) => {
      const name = nameOf(text, height);
      name.position.set(x, y, z);
      return name;
    });
    this.#axes = [arrows, ...names];
    this.add(this.#plane, this.#lines, ...this.#axes);
    /** Corners of all that is drawn here. */
    this.corners = [[x0 - away, y0 - away], [right, y0 - away], [x0 - away, back], [right, back]].map(([x, y]) => new Vector3(x, y, z));
  }

  paint(theme) {
    this.#plane.material.color.set(theme.bed);
    this.#lines.material.color.set(theme.bedLine);
    for (const { material } of this.#axes) material.color.set(theme.soft);
  }
}

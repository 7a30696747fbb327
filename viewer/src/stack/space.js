import {
  BufferGeometry,
  Color,
  ColorManagement,
  Float32BufferAttribute,
  Group,
  LinearSRGBColorSpace,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { element } from '../element.js';
import { roundStep } from '../layer/round_step.js';

// Colours are those of the style sheet and go to the screen as they are.
ColorManagement.enabled = false;

/** Directions to look from, by the names of their buttons. */
const views = {
  Aslant: [0.62, -1, 0.62],
  Top: [0, -0.001, 1],
  Front: [0, -1, 0.001],
  Right: [1, 0, 0.001],
};

/** A bed with a part on it, a camera around it, and a canvas that is drawn when something changed. */
export class Space {
  #asked = false;
  #fine = false;
  #refining = 0;
  #bed;
  #listeners = [];

  /** @param {number[][]} box low and high corner of the part, mm; the scene counts from the low one */
  constructor(box, label) {
    this.size = new Vector3(...box[0].map((low, k) => box[1][k] - low));
    this.middle = this.size.clone().multiplyScalar(0.5);
    this.reach = Math.max(this.size.length(), 1e-6);
    this.canvas = element('canvas', { className: 'drawing', tabIndex: 0, role: 'img', 'aria-label': label });
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.secondsOfPicture = 0; // what the last one took
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, this.reach / 200, this.reach * 40);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.redraw());
    this.scene.add((this.#bed = bedOf(this.size)));
    this.tools = Object.keys(views).map((name) =>
      element('button', { type: 'button', className: 'toggle', onclick: () => this.look(name) }, name),
    );
    this.zoomTools = [
      ['Zoom in', '+', 1.4],
      ['Zoom out', '−', 1 / 1.4],
    ].map(([label, sign, factor]) =>
      element('button', { type: 'button', className: 'icon', title: label, 'aria-label': label, onclick: () => this.zoomBy(factor) }, sign),
    );
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    this.look('Aslant');
  }

  look(name) {
    this.#lookFrom(new Vector3(...views[name]).normalize(), this.middle, this.reach);
  }

  /** @param {number} reach mm around the place that shall be seen */
  lookAt(place, reach) {
    this.#lookFrom(this.camera.position.clone().sub(this.controls.target).normalize(), place, reach);
  }

  #lookFrom(direction, target, reach) {
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.54 * reach) / Math.tan((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.update();
    this.redraw();
  }

  /** Turns around the part, by radians. */
  turnBy(sideways, upwards) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const up = new Vector3(0, 0, 1);
    away.applyAxisAngle(up, sideways);
    const axis = new Vector3().crossVectors(up, away).normalize();
    const tilt = Math.min(Math.PI - 0.01, Math.max(0.01, away.angleTo(up) - upwards)) - away.angleTo(up);
    away.applyAxisAngle(axis, tilt);
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.redraw();
  }

  zoomBy(factor) {
    this.camera.position.lerp(this.controls.target, 1 - 1 / factor);
    this.controls.update();
    this.redraw();
  }

  paint(theme) {
    this.renderer.setClearColor(new Color(theme.paper));
    this.#bed.children[0].material.color.set(theme.bed);
    this.#bed.children[1].material.color.set(theme.bedLine);
    this.redraw();
  }

  /** listen(up) is called before each picture; up is the build direction as the eye sees it. */
  beforeDrawing(listen) {
    this.#listeners.push(listen);
  }

  redraw() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => this.draw());
  }

  /** Finer, once nothing has moved for a while and where the card is quick: thin layers flicker less. */
  #refineLater() {
    clearTimeout(this.#refining);
    if (this.secondsOfPicture < 0.05 && !this.#fine)
      this.#refining = setTimeout(() => {
        this.#fine = true;
        this.draw();
      }, 200);
  }

  draw() {
    const start = performance.now();
    this.#fine &&= !this.#asked;
    this.#asked = false;
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0 || height === 0) return;
    const density = Math.min(2, window.devicePixelRatio || 1) * (this.#fine ? 1.5 : 1);
    if (canvas.width !== Math.round(width * density) || canvas.height !== Math.round(height * density)) {
      const first = canvas.dataset.ready === undefined;
      this.renderer.setPixelRatio(density);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      if (first) this.look('Aslant');
    }
    this.camera.updateMatrixWorld();
    const up = new Vector3(0, 0, 1).transformDirection(this.camera.matrixWorldInverse);
    for (const listen of this.#listeners) listen(up);
    this.renderer.render(this.scene, this.camera);
    this.renderer.getContext().finish();
    if (canvas.dataset.ready === undefined) performance.mark('first picture of the stack');
    canvas.dataset.ready = '';
    this.secondsOfPicture = (performance.now() - start) / 1000;
    this.#refineLater();
  }
}

/** A plane under the part with lines every 1, 2, 5, 10, ... mm; seen from above only. */
function bedOf(size) {
  const step = roundStep(Math.max(size.x, size.y, 1e-6) / 8);
  const margin = 0.25 * Math.max(size.x, size.y);
  const begin = -Math.ceil(margin / step) * step;
  const end = (length) => Math.ceil((length + margin) / step) * step;
  const [left, right, front, back] = [begin, end(size.x), begin, end(size.y)];
  const z = -0.0015 * Math.max(size.x, size.y, size.z);
  const plane = new Mesh(new PlaneGeometry(right - left, back - front), new MeshBasicMaterial({ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
  plane.position.set((left + right) / 2, (front + back) / 2, z);
  const points = [];
  for (let x = left; x <= right + step / 2; x += step) points.push(x, front, z, x, back, z);
  for (let y = front; y <= back + step / 2; y += step) points.push(left, y, z, right, y, z);
  const lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  lines.geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return new Group().add(plane, lines);
}

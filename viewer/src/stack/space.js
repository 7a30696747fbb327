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
  ShaderMaterial,
  Vector3,
  WebGLRenderer,
  WebGLRenderTarget,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { element } from '../element.js';
import { iconButton } from '../icon.js';
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

const millisecondsOfSlice = 80; // that whoever draws shall be busy before the page has its turn
const leastOfSlice = 2000; // lines or triangles; the first slice has so many, to measure by
const slicesInMotion = 3; // that a picture may take while something moves
const millisecondsOfTurn = 8;
const millisecondsOfRest = 200; // until something is taken to rest

/**
 * What takes long to draw.
 * @typedef {object} Bulk
 * @property {Mesh} mesh in the group `bulk`
 * @property {number} first of its lines or triangles to be drawn
 * @property {number} count of them
 * @property {number} vertices of each of them
 */

/**
 * A bed with a part on it, a camera around it, and a canvas that is drawn when something changed.
 *
 * Where there is no graphics card, a picture of everything may take many seconds, and the page would stand still for as
 * long. So a picture is drawn in slices beside the one that is on the screen, one after the other; how much a slice
 * holds is measured with each of them. What does not fit into one is drawn with less detail as long as something
 * moves, and in full once it rests.
 */
export class Space {
  #bulkOf;
  #frame = 0;
  #changed = false; // since the last picture was begun
  #awaited = 0; // changes that are on their way
  #rested = null; // which better picture than the last one is wanted: 'full' or 'finer'
  #resting = 0;
  #picture = null; // that is being drawn
  #slice = null; // that is being drawn
  #room = leastOfSlice; // of a slice
  #compiled = false;
  #target = new WebGLRenderTarget(1, 1, { samples: 4 });
  #copy = copyOf(this.#target.texture);
  #bed;
  #listeners = [];

  /**
   * @param {number[][]} box low and high corner of the part, mm; the scene counts from the low one
   * @param {(most: number) => Bulk[]} bulkOf what there is to draw; no more than `most` lines or triangles if it can be
   *     shown with less detail. Called when a picture is begun.
   */
  constructor(box, label, bulkOf) {
    this.#bulkOf = bulkOf;
    this.size = new Vector3(...box[0].map((low, k) => box[1][k] - low));
    this.middle = this.size.clone().multiplyScalar(0.5);
    this.reach = Math.max(this.size.length(), 1e-6);
    this.canvas = element('canvas', { className: 'drawing', tabIndex: 0, role: 'img', 'aria-label': label });
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: false, depth: false });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.debug.checkShaderErrors = false; // it would wait for the compiler
    this.under = new Group(); // drawn first
    this.bulk = new Group();
    this.over = new Group(); // drawn last
    this.scene = new Scene().add(this.under, this.bulk, this.over);
    this.camera = new PerspectiveCamera(32, 1, this.reach / 200, this.reach * 40);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.redraw());
    this.under.add((this.#bed = bedOf(this.size)));
    this.tools = Object.keys(views).map((name) =>
      element('button', { type: 'button', className: 'toggle', onclick: () => this.look(name) }, name),
    );
    this.zoomTools = element(
      'span',
      { className: 'zoom' },
      iconButton('Zoom in', 'plus', () => this.zoomBy(1.4)),
      iconButton('Zoom out', 'minus', () => this.zoomBy(1 / 1.4)),
    );
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    this.look('Aslant');
  }

  look(name) {
    this.#lookFrom(new Vector3(...views[name]).normalize(), this.middle, this.reach);
  }

  /**
   * @param {number} reach mm around the place that shall be seen
   * @param {Vector3} [from] direction to look from; as now unless given
   */
  lookAt(place, reach, from = this.camera.position.clone().sub(this.controls.target)) {
    const direction = from.clone().normalize();
    if (Math.hypot(direction.x, direction.y) < 0.001) direction.y -= 0.001; // what is up on the screen must be known
    this.#lookFrom(direction, place, reach);
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
    this.#announceChange();
    this.#wake();
  }

  /** What is on the screen is not to stay: redraw() follows when what comes is there. */
  async awaitChange(coming) {
    this.#awaited += 1;
    this.#announceChange();
    try {
      return await coming;
    } finally {
      this.#awaited -= 1;
    }
  }

  #announceChange() {
    this.#changed = true;
    delete this.canvas.dataset.settled;
  }

  #wake() {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#turn());
  }

  /** One turn of the browser: some steps, until they took long or whoever draws has to be waited for. */
  #turn() {
    this.#frame = 0;
    const since = performance.now();
    while (this.#goOn() && performance.now() - since < millisecondsOfTurn);
    if (this.#picture !== null || this.#slice !== null || this.#changed) this.#wake();
  }

  /** One step. Returns whether there was one to take. */
  #goOn() {
    if (this.#slice !== null && !this.#isDone()) return false;
    if (this.#picture?.better && this.#changed) this.#picture = null; // nobody waits for it any more
    if (!this.#compiled) this.#compile();
    else if (this.#picture !== null && this.#picture.slices > 0 && this.#picture.bulk.length === 0) this.#show();
    else if (this.#picture !== null) this.#drawSlice();
    else if (this.#changed || this.#rested) this.#begin();
    else return false;
    return true;
  }

  #compile() {
    this.renderer.compile(this.scene, this.camera);
    this.renderer.compile(this.#copy, this.camera);
    this.#compiled = true;
    this.#send(0);
  }

  #begin() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const better = this.#changed ? null : this.#rested;
    this.#changed = false;
    this.#rested = null;
    clearTimeout(this.#resting);
    if (width === 0 || height === 0) return; // what is not seen now is drawn when its size changes
    if (this.camera.aspect !== width / height) {
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      if (this.canvas.dataset.ready === undefined) this.look('Aslant');
    }
    this.camera.updateMatrixWorld();
    const up = new Vector3(0, 0, 1).transformDirection(this.camera.matrixWorldInverse);
    for (const listen of this.#listeners) listen(up);
    let bulk = this.#bulkOf(Infinity);
    const quick = totalOf(bulk) <= this.#room;
    if (!quick && !better) bulk = this.#bulkOf(slicesInMotion * this.#room);
    const screen = quick || better ? Math.min(2, window.devicePixelRatio || 1) : 1;
    // Thin layers flicker less in finer pictures.
    const density = screen * (better === 'finer' ? 1.5 : 1);
    this.#target.setSize(Math.round(width * density), Math.round(height * density));
    const [since, camera] = [performance.now(), this.camera.clone()];
    this.#picture = { bulk, quick, better, width, height, density, camera, since, slices: 0 };
  }

  #drawSlice() {
    const { renderer } = this;
    const picture = this.#picture;
    let drawn = 0;
    for (const mesh of this.bulk.children) mesh.visible = false;
    while (drawn < this.#room && picture.bulk.length > 0) {
      const { mesh, first, count, vertices } = picture.bulk.shift();
      const now = Math.min(count, this.#room - drawn);
      mesh.visible = true;
      mesh.geometry.setDrawRange(first * vertices, now * vertices);
      drawn += now;
      if (now < count) picture.bulk.unshift({ mesh, first: first + now, count: count - now, vertices });
    }
    this.under.visible = picture.slices === 0;
    this.over.visible = picture.bulk.length === 0;
    renderer.autoClear = picture.slices++ === 0;
    renderer.setRenderTarget(this.#target);
    renderer.render(this.scene, picture.camera);
    renderer.setRenderTarget(null);
    this.#send(drawn);
  }

  #send(drawn) {
    const gl = this.renderer.getContext();
    this.#slice = { drawn, since: performance.now(), fence: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0) };
    gl.flush();
  }

  /** Whether all that was sent is done; does not wait for it. If so, measures how much the next slice may hold. */
  #isDone() {
    const { renderer } = this;
    const gl = renderer.getContext();
    const { drawn, since, fence } = this.#slice;
    const done = gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED && renderer.info.programs.every((program) => program.isReady());
    if (!done && !gl.isContextLost()) return false;
    gl.deleteSync(fence);
    this.#slice = null;
    const share = millisecondsOfSlice / (performance.now() - since);
    // What had room to spare and was quick tells nothing of more.
    if (share < 1 || drawn === this.#room) this.#room = Math.max(leastOfSlice, Math.round(this.#room * Math.min(4, Math.max(0.25, share))));
    return true;
  }

  /** Brings the picture to the screen. */
  #show() {
    const { canvas, renderer } = this;
    const { quick, better, width, height, density, since } = this.#picture;
    this.#picture = null;
    if (canvas.width !== this.#target.width || canvas.height !== this.#target.height) {
      renderer.setPixelRatio(density);
      renderer.setSize(width, height, false);
    }
    renderer.autoClear = true;
    renderer.render(this.#copy, this.camera);
    if (canvas.dataset.ready === undefined) performance.mark('first picture of the stack');
    canvas.dataset.ready = '';
    const seconds = (performance.now() - since) / 1000;
    if (this.#changed || this.#awaited > 0) return;
    if (quick || better) canvas.dataset.settled = '';
    if (better || (quick && seconds > 0.05)) return;
    this.#resting = setTimeout(() => {
      this.#rested = quick ? 'finer' : 'full';
      this.#wake();
    }, millisecondsOfRest);
  }
}

const totalOf = (bulk) => bulk.reduce((sum, { count }) => sum + count, 0);

/** A scene that shows a texture all over the canvas, whatever the camera. */
function copyOf(texture) {
  const material = new ShaderMaterial({
    vertexShader: 'varying vec2 place; void main() { place = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: 'uniform sampler2D picture; varying vec2 place; void main() { gl_FragColor = texture2D(picture, place); }',
    uniforms: { picture: { value: texture } },
    depthTest: false,
    depthWrite: false,
  });
  const mesh = new Mesh(new PlaneGeometry(2, 2), material);
  mesh.frustumCulled = false;
  return new Scene().add(mesh);
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

import { Color, ColorManagement, Group, LinearSRGBColorSpace, Mesh, PerspectiveCamera, PlaneGeometry, Scene, ShaderMaterial, Vector3, WebGLRenderer, WebGLRenderTarget } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { element } from '../element.js';
import { iconButton } from '../icon.js';
import { scrollOrPinch } from '../touch.js';
import { Bed } from './bed.js';

// Colours are those of the style sheet and go to the screen as they are.
ColorManagement.enabled = false;

/** Directions to look from, by the names of their buttons. */
const views = {
  '3D': [0.62, -1, 0.62],
  Top: [0, -0.001, 1],
  Front: [0, -1, 0.001],
  Right: [1, 0, 0.001],
};

const margin = 1.04; // of what is shown as a whole, at the edges of the canvas
const millisecondsOfSlice = 80; // that whoever draws shall be busy before the page has its turn
const leastOfSlice = 2000; // lines or triangles; the first slice has this many, to measure by
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
  #view = '3D'; // that all of the scene is shown from; null once somebody moved
  #before = [];
  #after = [];

  /**
   * @param {number[][]} box low and high corner of the part, mm; the scene counts from the low one
   * @param {(most: number) => {bulk: Bulk[], coarse: boolean}} bulkOf what there is to draw; no more than `most` lines or
   *     triangles if it can be shown with less detail, `coarse`. Called when a picture is begun.
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
    this.controls.addEventListener('start', () => (this.#view = null));
    scrollOrPinch(this.canvas, () => {
      const [view, position, target] = [this.#view, this.camera.position.clone(), this.controls.target.clone()];
      return () => {
        this.#view = view;
        this.camera.position.copy(position);
        this.controls.target.copy(target);
        this.controls.update();
      };
    });
    this.under.add((this.#bed = new Bed(this.size)));
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
    this.fit();
  }

  /** Shows the part and the plate, from where one looks at first. */
  fit() {
    this.look('3D');
  }

  /** Shows the part and the plate. */
  look(name) {
    this.#view = name;
    const from = new Vector3(...views[name]).normalize();
    this.#lookFrom(from, this.middle, this.#distanceOfAll(from));
  }

  /** From where an eye that looks at the middle sees the part and the plate. */
  #distanceOfAll(from) {
    const { camera, middle, size } = this;
    const right = new Vector3(0, 0, 1).cross(from).normalize();
    const up = from.clone().cross(right);
    const tangent = Math.tan((camera.fov * Math.PI) / 360) / margin;
    const corners = [...this.#bed.corners];
    for (let i = 0; i < 8; ++i) corners.push(new Vector3(i & 1 ? size.x : 0, i & 2 ? size.y : 0, i & 4 ? size.z : 0));
    const distances = corners.map((corner) => {
      const offset = corner.clone().sub(middle);
      const aside = Math.max(Math.abs(offset.dot(right)) / camera.aspect, Math.abs(offset.dot(up)));
      return aside / tangent + offset.dot(from);
    });
    return Math.max(...distances);
  }

  /**
   * @param {number} reach mm around the place that shall be seen
   * @param {Vector3} [from] direction to look from; as now unless given
   */
  lookAt(place, reach, from = this.camera.position.clone().sub(this.controls.target)) {
    const direction = from.clone().normalize();
    if (Math.hypot(direction.x, direction.y) < 0.001) direction.y -= 0.001; // what is up on the screen must be known
    this.#view = null;
    this.#lookFrom(direction, place, (0.54 * reach) / Math.tan((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect));
  }

  #lookFrom(direction, target, distance) {
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.update();
    this.redraw();
  }

  /** From where one looks: the name of a direction from which all is seen, or points in coordinates in which the scene begins at `origin`. */
  outlookFrom(origin) {
    if (this.#view !== null) return { view: this.#view };
    const inPart = ({ x, y, z }) => [x + origin[0], y + origin[1], z + origin[2]];
    return { position: inPart(this.camera.position), target: inPart(this.controls.target) };
  }

  /** Looks as `outlookFrom` of another scene tells. */
  lookAsFrom({ view, position, target }, origin) {
    if (view !== undefined) return this.look(view);
    const inScene = (point) => new Vector3(...point.map((value, axis) => value - origin[axis]));
    this.#view = null;
    this.controls.target.copy(inScene(target));
    this.camera.position.copy(inScene(position));
    this.controls.update();
    this.redraw();
  }

  /** Turns around the part, by radians. */
  turnBy(sideways, upwards) {
    this.#view = null;
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
    this.#view = null;
    this.camera.position.lerp(this.controls.target, 1 - 1 / factor);
    this.controls.update();
    this.redraw();
  }

  paint(theme) {
    this.renderer.setClearColor(new Color(theme.paper));
    this.#bed.paint(theme);
    this.redraw();
  }

  /** listen(up) is called before each picture; up is the build direction as the eye sees it. */
  beforeDrawing(listen) {
    this.#before.push(listen);
  }

  /** listen(coarse) is called after each picture that comes to the screen. */
  afterDrawing(listen) {
    this.#after.push(listen);
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
      if (this.#view !== null) this.look(this.#view);
    }
    this.camera.updateMatrixWorld();
    const up = new Vector3(0, 0, 1).transformDirection(this.camera.matrixWorldInverse);
    for (const listen of this.#before) listen(up);
    let { bulk, coarse } = this.#bulkOf(Infinity);
    const quick = totalOf(bulk) <= this.#room;
    if (!quick && !better) ({ bulk, coarse } = this.#bulkOf(slicesInMotion * this.#room));
    const screen = quick || better ? Math.min(2, window.devicePixelRatio || 1) : 1;
    // Thin layers flicker less in finer pictures.
    const density = screen * (better === 'finer' ? 1.5 : 1);
    this.#target.setSize(Math.round(width * density), Math.round(height * density));
    const [since, camera] = [performance.now(), this.camera.clone()];
    this.#picture = { bulk, coarse, quick, better, width, height, density, camera, since, slices: 0 };
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
    const { coarse, quick, better, width, height, density, since } = this.#picture;
    this.#picture = null;
    if (canvas.width !== this.#target.width || canvas.height !== this.#target.height) {
      renderer.setPixelRatio(density);
      renderer.setSize(width, height, false);
    }
    renderer.autoClear = true;
    renderer.render(this.#copy, this.camera);
    if (canvas.dataset.ready === undefined) performance.mark('first picture of the stack');
    canvas.dataset.ready = '';
    for (const listen of this.#after) listen(coarse);
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

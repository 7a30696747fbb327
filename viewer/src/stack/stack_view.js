import {
  DataTexture,
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  RedFormat,
  Vector3,
} from 'three';
import { element } from '../element.js';
import { brief } from '../text.js';
import { Cap } from './cap.js';
import { placeMarks } from './place_marks.js';
import { Space } from './space.js';
import { topBrightness, wallMaterial } from './wall_material.js';
import { Walls, spacingFor } from './walls.js';

const mostLines = 1.5e6; // in the whole stack
const linesOfPiece = 6e4;
const millisecondsAtWork = 14; // then the browser has its turn

/**
 * What is put up for each line of a contour: a wall, and on its top a ledge inwards. position.x goes along the line,
 * position.y upwards, position.z inwards.
 */
const corners = new Float32BufferAttribute([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1, 1, 1, 0, 1, 1], 3);
const ledges = new Float32BufferAttribute([0, 0, 0, 0, 1, 1, 1, 1], 1);

const attributesOf = (walls) => ({
  ends: new InstancedBufferAttribute(new Float32Array(walls.ends), 4),
  heights: new InstancedBufferAttribute(new Float32Array(walls.heights), 2),
  normals: new InstancedBufferAttribute(new Int8Array(walls.normals), 4, true),
  info: new InstancedBufferAttribute(new Float32Array(walls.info), 2),
});

/** Geometries of the same attributes share them on the graphics card. */
function geometryOf(attributes, instances) {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', corners);
  geometry.setAttribute('ledge', ledges);
  geometry.setIndex([0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
  for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
  geometry.instanceCount = instances;
  return geometry;
}

const afterNextPaint = (act) => requestAnimationFrame(() => setTimeout(act));

/** Lets the browser draw and answer; without the waiting that it puts on chains of timers. */
const nextTurn = () =>
  new Promise((resolve) => {
    const channel = new MessageChannel();
    channel.port1.onmessage = resolve;
    channel.port2.postMessage(null);
  });

/** All layers up to the one that is shown, in space, with the ghosts of those above. */
export class StackView {
  #page;
  #shelf;
  #store;
  #space;
  #hidden;
  #walls;
  #ghosts;
  #pieces = []; // { first, last, counts, solid, ghost }
  #origin;
  #top;
  #floor;
  #marks;
  #begun = false;
  #goOn = () => {};

  /** @param {Promise} first all that takes a while waits for this, unless the stack is all that is to be seen */
  constructor(page, shelf, store, first) {
    this.#page = page;
    this.#shelf = shelf;
    this.#store = store;
    this.caption = element('p', { className: 'caption' });
    this.node = element('section', { className: 'pane', 'aria-label': 'The stack in space' }, this.caption);
    store.on(['view'], ({ view }) => {
      if (view !== 'layer') this.#goOn();
      if (view === 'stack') afterNextPaint(() => this.#begin());
      if (view === 'both') first.then(() => this.#begin());
    });
  }

  #begin() {
    if (this.#begun || this.#store.state.view === 'layer') return;
    this.#begun = true;
    const { head, table, notes } = this.#page;
    const bottom = Math.min(...table.bottom);
    this.#origin = [head.origin[0] * head.step_mm, head.origin[1] * head.step_mm, bottom];
    const box = [this.#origin, [head.box[1][0], head.box[1][1], Math.max(...table.top)]];
    try {
      this.#space = new Space(box, 'The stack of layers in space. Buttons look at it from several sides.');
    } catch {
      this.caption.textContent = 'This browser draws nothing in space: WebGL is missing or switched off.';
      return;
    }
    this.#hidden = new DataTexture(new Uint8Array(head.parts.length), head.parts.length, 1, RedFormat);
    this.#walls = wallMaterial(false, this.#hidden);
    this.#ghosts = wallMaterial(true, this.#hidden);
    this.#top = new Cap(this.#space.size);
    this.#floor = new Cap(this.#space.size);
    this.#marks = placeMarks(notes.places, this.#origin);
    this.#space.scene.add(this.#top.mesh, this.#floor.mesh, this.#marks);
    const tools = element('div', { className: 'tools', role: 'toolbar', 'aria-label': 'How the stack is seen' }, ...this.#tools());
    this.node.prepend(this.#space.canvas, tools);
    this.#space.beforeDrawing((up) => this.#shine(up));
    this.#store.on(['theme'], ({ theme }) => this.#paint(theme));
    this.#store.on(['hidden'], ({ hidden }) => this.#hide(hidden));
    this.#store.on(['layer', 'ghosts', 'view'], () => this.#follow());
    this.#store.on(['layer', 'hidden', 'theme', 'view'], () => this.#paintTop());
    this.#store.on(['hidden', 'theme'], () => this.#paintFloor());
    this.#build();
  }

  #tools() {
    const ghosts = element('button', { type: 'button', className: 'toggle' }, 'Layers above');
    ghosts.addEventListener('click', () => this.#store.set({ ghosts: !this.#store.state.ghosts }));
    this.#store.on(['ghosts'], (state) => ghosts.setAttribute('aria-pressed', state.ghosts));
    return [...this.#space.tools, ghosts, element('span', { className: 'gap' }), ...this.#space.zoomTools];
  }

  #paint(theme) {
    for (const { uniforms } of [this.#walls, this.#ghosts]) {
      uniforms.parts.value.forEach((colour, i) => colour.set(theme.walls[i]));
      uniforms.current.value.set(theme.wallCut);
      uniforms.open.value.set(theme.open);
    }
    this.#marks.paint(theme);
    this.#space.paint(theme);
  }

  #hide(hidden) {
    this.#hidden.image.data.forEach((_, part, data) => (data[part] = hidden.has(part) ? 255 : 0));
    this.#hidden.needsUpdate = true;
    this.#space.redraw();
  }

  #shine(up) {
    this.#walls.uniforms.up.value.copy(up);
    for (const cap of [this.#top, this.#floor]) cap.mesh.material.color.setScalar(topBrightness(up));
  }

  #follow() {
    const { layer, ghosts, view } = this.#store.state;
    if (view === 'layer') return;
    for (const { uniforms } of [this.#walls, this.#ghosts]) uniforms.layer.value = layer;
    for (const piece of this.#pieces) {
      const { first, last, counts, solid, ghost } = piece;
      solid.visible = first <= layer;
      solid.geometry.instanceCount = counts[Math.min(layer, last) - first] ?? 0;
      ghost.visible = ghosts && last > layer;
    }
    this.#space.redraw();
  }

  async #paintTop() {
    const { layer: number, hidden, theme, view } = this.#store.state;
    if (view === 'layer') return;
    const { table } = this.#page;
    const layer = await this.#shelf.layer(number);
    if (this.#store.state.layer !== number) return;
    this.#top.show(layer, table.top[number] - this.#origin[2], theme.walls, hidden, theme.wallCut);
    this.#space.redraw();
  }

  async #paintFloor() {
    const layer = await this.#shelf.decode(0);
    const { hidden, theme } = this.#store.state;
    this.#floor.show(layer, 0, theme.walls, hidden);
    this.#space.redraw();
  }

  /** Puts up the walls piece by piece, with a break after each few milliseconds, and one as long as nobody sees them. */
  async #build() {
    const { table, head } = this.#page;
    const total = table.shown.reduce((sum, n) => sum + n, 0);
    const least = this.#space.reach / 4000;
    let widest = 0;
    let walls = new Walls();
    let first = 0;
    let since = performance.now();
    let shown = since;
    for (let number = 0; number < head.layers; ++number) {
      const layer = await this.#shelf.decode(number);
      const apart = total <= mostLines ? 0 : spacingFor(layer, (mostLines * table.shown[number]) / total, least);
      widest = Math.max(widest, apart);
      walls.add(layer, { number, bottom: table.bottom[number] - this.#origin[2], top: table.top[number] - this.#origin[2] }, apart);
      if (walls.size >= linesOfPiece || number + 1 === head.layers) {
        this.#putUp(walls, first, number);
        walls = new Walls();
        first = number + 1;
        // Where pictures take long, most of the time shall go into the work.
        if (performance.now() - shown > 4000 * this.#space.secondsOfPicture || first === head.layers) {
          this.#follow();
          shown = performance.now();
        }
      }
      if (performance.now() - since > millisecondsAtWork) {
        this.caption.textContent = `Building the stack: ${Math.floor((100 * number) / head.layers)} %`;
        await nextTurn();
        while (this.#store.state.view === 'layer') await new Promise((resolve) => (this.#goOn = resolve));
        since = performance.now();
      }
    }
    this.caption.textContent = widest > 0 ? `Without points that are closer than ${brief(widest)} mm to one another.` : '';
    this.#space.canvas.dataset.built = '';
  }

  #putUp(walls, first, last) {
    const attributes = attributesOf(walls);
    const [solid, ghost] = [this.#walls, this.#ghosts].map((material) => {
      const mesh = new Mesh(geometryOf(attributes, walls.size), material);
      mesh.frustumCulled = false;
      this.#space.scene.add(mesh);
      return mesh;
    });
    ghost.renderOrder = 5;
    solid.visible = ghost.visible = false;
    this.#pieces.push({ first, last, counts: walls.counts, solid, ghost });
  }

  /** @param {number[]} place mm of the part's coordinates */
  lookAt(place) {
    this.#space?.lookAt(new Vector3(...place.map((value, k) => value - this.#origin[k])), this.#space.reach / 6);
  }

  turnBy(sideways, upwards) {
    this.#space?.turnBy(sideways, upwards);
  }

  zoomBy(factor) {
    this.#space?.zoomBy(factor);
  }

  fit() {
    this.#space?.look('Aslant');
  }
}

import { BufferAttribute, BufferGeometry, Color, DataTexture, Mesh, RGBAIntegerFormat, UnsignedIntType, Vector3 } from 'three';
import { bodyOfParts, colourOfVectors, isVectors } from '../data/exposures.js';
import { element } from '../element.js';
import { largest, least } from '../extremes.js';
import { brief } from '../text.js';
import { nextTurn } from '../turn.js';
import { Cap } from './cap.js';
import { levelsOf } from './levels.js';
import { placeMarks } from './place_marks.js';
import { Space } from './space.js';
import { heightsTexture, partsTexture, topBrightness, wallMaterial } from './wall_material.js';
import { Walls, linesOfRow, spacingFor } from './walls.js';

const mostLines = 1.5e6; // in the whole stack
const linesOfPiece = 6e4;
const linesOfFirstLevel = 16e3; // about
const millisecondsAtWork = 14; // then the browser has its turn
const millisecondsUnseen = 500; // until what was put up meanwhile is drawn

const verticesOfLine = 12;
let shared = new BufferAttribute(new Uint32Array(), 1);

/** The vertices of this many lines or more, four triangles each; all geometries use them. */
function verticesOf(lines) {
  if (shared.count < verticesOfLine * lines) {
    const indices = new Uint32Array(verticesOfLine * Math.max(linesOfPiece, lines));
    const corners = [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7];
    for (let i = 0; i < indices.length; ++i) indices[i] = 8 * Math.floor(i / verticesOfLine) + corners[i % verticesOfLine];
    shared = new BufferAttribute(indices, 1);
  }
  return shared;
}

function textureOf(walls) {
  const { rows } = walls;
  const texture = new DataTexture(rows.slice(), 2 * linesOfRow, rows.length / (8 * linesOfRow), RGBAIntegerFormat, UnsignedIntType);
  texture.needsUpdate = true;
  return texture;
}

/** A mesh of lines of a texture: Space says of which. */
function meshOf(texture, lines, material) {
  const mesh = new Mesh(new BufferGeometry().setIndex(verticesOf(lines)), material);
  mesh.frustumCulled = false;
  mesh.onBeforeRender = () => {
    material.uniforms.lines.value = texture;
    material.uniformsNeedUpdate = true;
  };
  return mesh;
}

const afterNextPaint = (act) => requestAnimationFrame(() => setTimeout(act));

/** How many lines layers up to `last` have; of numbers of layers that grow, and the lines up to the end of each. */
function countUpTo(layers, counts, last) {
  let [low, high] = [0, layers.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (layers[middle] <= last) low = middle + 1;
    else high = middle;
  }
  return counts[low - 1] ?? 0;
}

/** All layers up to the one that is shown, in space, with the ghosts of those above. */
export class StackView {
  #page;
  #shelf;
  #store;
  #space;
  #bodies; // of each part
  #parts;
  #walls;
  #ghosts;
  #leftOut = ''; // for good, in words
  #levels = []; // those that are complete, each a list of pieces { layers, counts, solid, ghost }
  #built = false; // all of them are
  #coarse = true; // what is on the screen
  #progress = ''; // of the building
  #stride = 1; // of the first level
  #capsToPaint = new Map(); // by what paints them
  #origin;
  #top;
  #floor;
  #marks;
  #begun = false;
  #before; // the outlook, until there is a space
  #failed = false; // nothing can be drawn in space
  #goOn = () => {};

  /** @param {Promise} first all that takes a while waits for this, unless the stack is all that is to be seen */
  constructor(page, shelf, store, first) {
    this.#page = page;
    this.#shelf = shelf;
    this.#store = store;
    this.caption = element('p', { className: 'caption', role: 'note' });
    this.node = element('section', { className: 'pane', 'aria-label': 'The stack in space' }, this.caption);
    store.on(['view'], ({ view }) => {
      if (view === 'both' && this.#failed) return void store.set({ view: 'layer' });
      if (view !== 'layer') this.#goOn();
      if (view === 'stack') afterNextPaint(() => this.#begin());
      if (view === 'both') first.then(() => this.#begin());
    });
  }

  #begin() {
    if (this.#begun || this.#store.state.view === 'layer') return;
    this.#begun = true;
    const { head, table, notes } = this.#page;
    const bottom = least(table.bottom);
    this.#origin = [head.origin[0] * head.step_mm, head.origin[1] * head.step_mm, bottom];
    const box = [this.#origin, [head.box[1][0], head.box[1][1], largest(table.top)]];
    try {
      this.#space = new Space(box, 'The stack of layers in space. Buttons look at it from several sides.', (most) => this.#bulkOf(most));
    } catch {
      this.#failed = true;
      this.caption.textContent = 'This browser draws nothing in space: WebGL is missing or switched off.';
      if (this.#store.state.view === 'both') this.#store.set({ view: 'layer' });
      return;
    }
    if (this.#before) this.outlook = this.#before;
    this.#bodies = bodyOfParts(head);
    this.#parts = partsTexture(head.parts.length);
    const heights = heightsTexture(table.bottom.map((z) => z - bottom), table.top.map((z) => z - bottom));
    this.#walls = wallMaterial(false, heights, head.layers - 1, this.#parts);
    this.#ghosts = wallMaterial(true, heights, head.layers - 1, this.#parts);
    this.#top = new Cap(this.#space.size);
    this.#floor = new Cap(this.#space.size);
    this.#marks = placeMarks(notes.places, this.#origin);
    this.#space.under.add(this.#top.mesh, this.#floor.mesh);
    this.#space.over.add(this.#marks);
    // Empty, so that their programs are made before the first lines are there.
    for (const material of [this.#walls, this.#ghosts]) this.#space.bulk.add(meshOf(null, 0, material));
    const tools = element('div', { className: 'tools', role: 'toolbar', 'aria-label': 'How the stack is seen' }, ...this.#tools());
    this.node.prepend(this.#space.canvas, tools);
    this.#space.beforeDrawing((up) => {
      this.#paintCap();
      this.#shine(up);
    });
    this.#space.afterDrawing((coarse) => {
      this.#coarse = coarse;
      this.#note();
    });
    this.#store.on(['theme'], ({ theme }) => this.#paint(theme));
    this.#store.on(['theme', 'hidden'], ({ theme, hidden }) => this.#paintParts(theme, hidden));
    this.#store.on(['ghosts'], () => this.#space.redraw());
    this.#store.on(['layer', 'hidden', 'theme', 'view'], () => this.#follow());
    this.#store.on(['hidden', 'theme'], () => this.#followFloor());
    this.#build();
  }

  #tools() {
    const ghosts = element('button', { type: 'button', className: 'toggle' }, 'Layers above');
    ghosts.addEventListener('click', () => this.#store.set({ ghosts: !this.#store.state.ghosts }));
    this.#store.on(['ghosts'], (state) => ghosts.setAttribute('aria-pressed', state.ghosts));
    return [...this.#space.tools, ghosts, this.#space.zoomTools];
  }

  #paint(theme) {
    for (const { uniforms } of [this.#walls, this.#ghosts]) {
      uniforms.current.value.set(theme.wallCut);
      uniforms.fault.value.set(theme.open);
    }
    this.#marks.paint(theme);
    this.#space.paint(theme);
  }

  #paintParts(theme, hidden) {
    this.#wallsOf(theme).forEach((colour, part) => {
      const { r, g, b } = new Color(colour);
      this.#parts.image.data.set([r, g, b, hidden.has(part) ? 0 : 1].map((value) => Math.round(255 * value)), 4 * part);
    });
    this.#parts.needsUpdate = true;
    this.#space.redraw();
  }

  /** The colour of each part: that which its scan vectors have in the layer, or that of its body. */
  #wallsOf(theme) {
    return this.#page.head.parts.map((part, i) =>
      isVectors(part) ? colourOfVectors(part, theme) : theme.walls[this.#bodies[i] % theme.walls.length],
    );
  }

  #shine(up) {
    this.#walls.uniforms.up.value.copy(up);
    for (const cap of [this.#top, this.#floor]) cap.mesh.material.color.setScalar(topBrightness(up));
  }

  async #follow() {
    const { layer: number, view } = this.#store.state;
    if (view === 'layer') return;
    const layer = await this.#space.awaitChange(this.#shelf.layer(number));
    if (this.#store.state.layer !== number) return;
    this.#capToPaint('top', (theme, hidden) =>
      this.#top.show(layer, this.#page.table.top[number] - this.#origin[2], this.#wallsOf(theme), hidden, theme.open, theme.wallCut),
    );
  }

  async #followFloor() {
    const layer = await this.#shelf.decode(0);
    this.#capToPaint('floor', (theme, hidden) => this.#floor.show(layer, 0, this.#wallsOf(theme), hidden, theme.open));
  }

  #capToPaint(name, paint) {
    this.#capsToPaint.set(name, paint);
    this.#space.redraw();
  }

  /** One for each picture: it takes a while, with the way to the card. */
  #paintCap() {
    for (const [name, paint] of this.#capsToPaint) {
      const { theme, hidden } = this.#store.state;
      paint(theme, hidden);
      this.#capsToPaint.delete(name);
      if (this.#capsToPaint.size > 0) this.#space.redraw();
      return;
    }
  }

  /** What there is to know of the picture on the screen. */
  #note() {
    const unfinished = 'The picture is coarse for now: some layers stand for those between them.';
    this.caption.textContent = !this.#built ? this.#progress : this.#coarse ? unfinished : this.#leftOut;
  }

  /** The walls up to the layer that is shown, then the ghosts above it; of fewer levels where that is too much. */
  #bulkOf(most) {
    const { layer, ghosts } = this.#store.state;
    const linesOf = (levels) => levels.flat().reduce((sum, { layers, counts }) => sum + countUpTo(layers, counts, ghosts ? Infinity : layer), 0);
    let levels = this.#levels;
    while (levels.length > 1 && linesOf(levels) > most) levels = levels.slice(0, -1);
    for (const { uniforms } of [this.#walls, this.#ghosts]) {
      uniforms.layer.value = layer;
      uniforms.stride.value = this.#stride / 2 ** Math.max(0, levels.length - 1);
    }
    const [solids, others] = [[], []];
    for (const { layers, counts, solid, ghost } of levels.flat()) {
      const below = countUpTo(layers, counts, layer);
      const all = countUpTo(layers, counts, Infinity);
      if (below > 0) solids.push({ mesh: solid, first: 0, count: below, vertices: verticesOfLine });
      if (ghosts && all > below) others.push({ mesh: ghost, first: below, count: all - below, vertices: verticesOfLine });
    }
    return { bulk: [...solids, ...others], coarse: !this.#built || levels.length < this.#levels.length };
  }

  /**
   * Puts up the walls piece by piece, with a break after each few milliseconds, and one as long as nobody sees them.
   * First some layers all over the height, then those between.
   */
  async #build() {
    const { table, head } = this.#page;
    const total = table.shown.reduce((sum, n) => sum + n, 0);
    const leastApart = this.#space.reach / 4000;
    while (this.#stride < head.layers && Math.min(total, mostLines) / this.#stride > linesOfFirstLevel) this.#stride *= 2;
    let widest = 0;
    let done = 0;
    let since = performance.now();
    let seen = -Infinity;
    for (const numbers of levelsOf(head.layers, this.#stride)) {
      const pieces = [];
      let walls = new Walls(head.parts);
      for (const number of numbers) {
        const layer = await this.#shelf.decode(number);
        const apart = total <= mostLines ? 0 : spacingFor(layer, (mostLines * table.shown[number]) / total, leastApart);
        widest = Math.max(widest, apart);
        walls.add(layer, number, apart);
        ++done;
        if (walls.size >= linesOfPiece || number === numbers.at(-1)) {
          pieces.push(this.#pieceOf(walls));
          walls = new Walls(head.parts);
        }
        if (performance.now() - since > millisecondsAtWork) {
          this.#progress = `Building the stack: ${Math.floor((100 * done) / head.layers)} %`;
          this.#note();
          await nextTurn();
          while (this.#store.state.view === 'layer') await new Promise((resolve) => (this.#goOn = resolve));
          since = performance.now();
        }
      }
      this.#levels = [...this.#levels, pieces];
      this.#built = done === head.layers;
      if (performance.now() - seen > millisecondsUnseen || done === head.layers) {
        this.#space.redraw();
        seen = performance.now();
      }
    }
    if (widest > 0) this.#leftOut = `Points closer than ${brief(widest)} mm to one another are left out.`;
    this.#note();
    this.#space.canvas.dataset.built = '';
  }

  #pieceOf(walls) {
    const texture = textureOf(walls);
    const [solid, ghost] = [this.#walls, this.#ghosts].map((material) => meshOf(texture, walls.size, material));
    ghost.renderOrder = 5;
    this.#space.bulk.add(solid, ghost);
    return { layers: walls.layers, counts: walls.counts, solid, ghost };
  }

  /** @param {number[]} place mm of the part's coordinates */
  lookAt(place) {
    this.#space?.lookAt(new Vector3(...place.map((value, k) => value - this.#origin[k])), this.#space.reach / 6);
  }

  /** From where one looks, in the part's coordinates; see Space. */
  get outlook() {
    return this.#space?.outlookFrom(this.#origin) ?? this.#before;
  }

  set outlook(given) {
    this.#before = given;
    this.#space?.lookAsFrom(given, this.#origin);
  }

  turnBy(sideways, upwards) {
    this.#space?.turnBy(sideways, upwards);
  }

  zoomBy(factor) {
    this.#space?.zoomBy(factor);
  }

  fit() {
    this.#space?.fit();
  }
}

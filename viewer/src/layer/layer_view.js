import { hasMaterial, hasVectors, isVectors, kindsOf, switchGroup } from '../data/exposures.js';
import { vectorsOf } from '../data/vectors.js';
import { element } from '../element.js';
import { hasHatches, layerText } from '../findings.js';
import { iconButton } from '../icon.js';
import { saveFile, csvOf, stemOf, svgOf } from '../save.js';
import { coordinate, layerNumber, layerNumbers, mm } from '../text.js';
import { scrollOrPinch } from '../touch.js';
import { Camera } from './camera.js';
import { colourings, rangeOf, scaleColour, usefulColourings } from './colouring.js';
import { drawFaults, drawLayer, trace } from './draw_layer.js';
import { drawBeam, drawOutline, drawVectorDirections, drawVectors } from './draw_vectors.js';
import { OrderBar } from './order_bar.js';
import { cornerNear, distanceText, pickAt, pickText } from './pick.js';
import { roundStep } from './round_step.js';

/** Where lines of the notes' places pass through the plane at z, x and y in turn. */
export function marksAt(places, z, tolerance, origin) {
  const marks = [];
  for (const { points, closed } of places) {
    if (points.length === 1 && Math.abs(points[0][2] - z) <= tolerance)
      marks.push(points[0][0] - origin[0], points[0][1] - origin[1]);
    const lines = closed ? points.length : points.length - 1;
    for (let i = 0; i < lines; ++i) {
      const [a, b] = [points[i], points[(i + 1) % points.length]];
      if (a[2] <= z === b[2] <= z) continue;
      const t = (z - a[2]) / (b[2] - a[2]);
      marks.push(a[0] + t * (b[0] - a[0]) - origin[0], a[1] + t * (b[1] - a[1]) - origin[1]);
    }
  }
  return marks;
}

const nearClick = 8; // pixels: what is no farther from a click is meant by it
const stillClick = 4; // pixels that a pointer may move between down and up in a click

/** Called in a frame; acts when the browser has painted that. */
const afterPaint = (act) => setTimeout(act);

/** A piece of a line as vectors of a region and kind, or jumps, are drawn. */
function sample(colour, width) {
  const [svg, path] = ['svg', 'path'].map((tag) => document.createElementNS('http://www.w3.org/2000/svg', tag));
  svg.setAttribute('viewBox', '0 0 22 12');
  svg.setAttribute('aria-hidden', true);
  path.setAttribute('d', width > 2 ? 'M1 6H21' : 'M1 2H21M1 6H21M1 10H21');
  path.setAttribute('style', `stroke: var(--${colour}); stroke-width: ${width}`);
  svg.append(path);
  return svg;
}

/** One layer, seen from above: a canvas to zoom and pan, with its tools. */
export class LayerView {
  #page;
  #shelf;
  #store;
  #camera = new Camera();
  #layer = null; // what is drawn
  #vectors = null; // of it, where there are any
  #executed = { canvas: document.createElement('canvas'), count: Infinity }; // a picture of the first of them
  #shown = -1;
  #picked; // what was clicked
  #ends = []; // of the distance that is measured, mm
  #asked = false;
  #tellDrawn;
  /** Resolved when the first layer is on the screen. */
  drawn = new Promise((resolve) => (this.#tellDrawn = resolve));

  /** @param {import('../player.js').Player} orderPlayer of the vectors */
  constructor(page, shelf, store, orderPlayer) {
    this.#page = page;
    this.#shelf = shelf;
    this.#store = store;
    this.origin = page.head.origin.map((steps) => steps * page.head.step_mm);
    this.canvas = element('canvas', {
      className: 'drawing',
      tabIndex: 0,
      role: 'img',
      'aria-describedby': 'keys-of-layer',
    });
    this.order = hasVectors(page.head) ? new OrderBar(page, store, orderPlayer) : null;
    this.tools = this.#tools();
    this.readout = element('output', { className: 'readout', 'aria-hidden': true });
    this.answer = element('output', { className: 'answer', 'aria-live': 'polite', hidden: true });
    this.legend = element('div', { className: 'legend', hidden: true });
    this.scaleText = element('span');
    this.scale = element('div', { className: 'scale', 'aria-hidden': true }, this.scaleText, element('i'));
    this.node = element(
      'section',
      { className: `pane${this.order ? ' ordered' : ''}`, 'aria-label': 'The layer, seen from above' },
      this.canvas,
      this.tools,
      this.scale,
      this.legend,
      this.answer,
      this.readout,
      ...(this.order ? [this.order.node] : []),
      element('p', { id: 'keys-of-layer', className: 'unseen' }, 'Plus and minus zoom, shift and arrows move, 0 shows all.'),
    );
    const [low, high] = page.head.box;
    this.#camera.frame([low[0] - this.origin[0], low[1] - this.origin[1], high[0] - this.origin[0], high[1] - this.origin[1]]);
    this.#listen();
    store.on(['layer'], (state) => this.#show(state.layer));
    store.on(['theme', 'fill', 'lines', 'directions', 'hatches', 'jumps', 'hidden'], () => this.redraw());
    store.on(['order'], () => this.#drawSoon());
    store.on(['colouring'], () => this.redraw());
    store.on(['measuring'], ({ measuring }) => {
      this.canvas.classList.toggle('measuring', measuring);
      this.forget();
    });
  }

  get camera() {
    return this.#camera;
  }

  /** This many vectors are on the layer that is shown. */
  get vectors() {
    return this.#vectors?.count ?? 0;
  }

  #tools() {
    const { head, table } = this.#page;
    const toggle = (key, ...label) => {
      const node = element('button', { type: 'button', className: 'toggle' }, ...label);
      node.addEventListener('click', () => this.#store.set({ [key]: !this.#store.state[key] }));
      this.#store.on([key], (state) => node.setAttribute('aria-pressed', state[key]));
      return node;
    };
    const toggles = hasMaterial(head) ? [toggle('fill', 'Fill'), toggle('lines', 'Contours')] : [];
    if (hasMaterial(head) && hasHatches(table)) toggles.push(toggle('hatches', 'Hatches'));
    toggles.push(...kindsOf(head).map((kind) => this.#kindToggle(kind)));
    if (hasVectors(head)) toggles.push(toggle('jumps', sample('jump', 1), 'jumps'));
    toggles.push(toggle('directions', 'Direction'), ...this.#colouringChoice(), toggle('measuring', 'Measure'), this.#saveMenu());
    return element(
      'div',
      { className: 'tools', role: 'toolbar', 'aria-label': 'How the layer is drawn' },
      ...toggles,
      element(
        'span',
        { className: 'zoom' },
        iconButton('Zoom in (+)', 'plus', () => this.zoomBy(1.5)),
        iconButton('Zoom out (−)', 'minus', () => this.zoomBy(1 / 1.5)),
        iconButton('Show all (0)', 'all', () => this.fit()),
      ),
    );
  }

  /** The choice of the colours of vectors, if there is any. */
  #colouringChoice() {
    const keys = usefulColourings(this.#page.head);
    if (keys.length === 0) return [];
    const choice = element('select', { className: 'toggle', 'aria-label': 'Colour of the vectors' });
    choice.append(element('option', { value: 'kind' }, 'Colour: kind'), ...keys.map((key) => element('option', { value: key }, `Colour: ${colourings[key].name.toLowerCase()}`)));
    choice.addEventListener('change', () => this.#store.set({ colouring: choice.value }));
    this.#store.on(['colouring'], ({ colouring }) => (choice.value = colouring));
    return [choice];
  }

  #saveMenu() {
    const { head, table } = this.#page;
    const stem = stemOf(head.title);
    const name = () => `${stem}_layer_${layerNumber(table, this.#shown)}`;
    const menu = element('details', { className: 'menu' }, element('summary', { className: 'toggle' }, 'Save'));
    const entry = (text, act) => {
      const save = () => {
        menu.open = false;
        act();
      };
      return element('button', { type: 'button', onclick: save }, text);
    };
    menu.append(
      element(
        'div',
        {},
        entry('Layer as shown (PNG)', () => this.canvas.toBlob((blob) => saveFile(`${name()}.png`, blob))),
        entry('Layer as drawing (SVG)', () => saveFile(`${name()}.svg`, this.svg(), 'image/svg+xml')),
        entry('Table of all layers (CSV)', () => saveFile(`${stem}_layers.csv`, csvOf(table), 'text/csv')),
      ),
    );
    return menu;
  }

  /** The layer that is shown, as SVG. */
  svg() {
    const { hidden, theme } = this.#store.state;
    const { head, table } = this.#page;
    return svgOf(this.#layer, this.#vectors, { head, origin: this.origin, z: table.z[this.#shown], hidden, colours: theme });
  }

  /** Of the legend: shows what is drawn in that colour and stroke. */
  #kindToggle(kind) {
    const line = sample(`${kind.region}-${kind.kind}`, kind.kind === 'contour' ? 3 : 1.5);
    const node = element('button', { type: 'button', className: 'toggle' }, line, kind.name);
    node.addEventListener('click', () => switchGroup(this.#store, kind, this.#store.state.off.has(kind)));
    this.#store.on(['off'], ({ off }) => node.setAttribute('aria-pressed', !off.has(kind)));
    return node;
  }

  async #show(number) {
    const layer = await this.#shelf.layer(number);
    if (this.#store.state.layer !== number) return; // another one was asked for meanwhile
    this.#layer = layer;
    this.#shown = number;
    this.#picked = undefined;
    this.#tellPicked();
    const { head, table } = this.#page;
    if (this.order) {
      this.#vectors = vectorsOf(layer, head.parts);
      this.order.show(this.#vectors, number);
    }
    const text =
      `Layer ${layerNumber(table, number)} ${layerNumbers(table)} at z = ${mm(table.z[number])} mm, seen from above: ${layerText(this.#page, number)}` +
      (table.open_chains[number] > 0 ? `, ${table.open_chains[number]} of the contours open` : '');
    this.canvas.setAttribute('aria-label', text);
    this.redraw();
  }

  #listen() {
    const { canvas } = this;
    new ResizeObserver(() => {
      this.#camera.top = this.tools.offsetTop + this.tools.offsetHeight;
      this.#camera.resize(canvas.clientWidth, canvas.clientHeight);
      this.#executed.count = Infinity;
      this.draw();
    }).observe(canvas);
    canvas.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        const unit = event.deltaMode === 1 ? 30 : 1;
        this.#camera.zoomBy(Math.exp(-event.deltaY * unit * (event.ctrlKey ? 0.01 : 0.002)), event.offsetX, event.offsetY);
        this.redraw();
      },
      { passive: false },
    );
    scrollOrPinch(canvas, () => {
      const { x, y, scale, fitted } = this.#camera;
      return () => {
        Object.assign(this.#camera, { x, y, scale, fitted });
        this.redraw();
      };
    });
    const fingers = new Map();
    let down = null; // where a pointer came down that may be a click
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      down = fingers.size === 1 ? [event.offsetX, event.offsetY] : null;
    });
    canvas.addEventListener('pointerup', (event) => {
      if (down !== null && Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) <= stillClick) this.#click(event.offsetX, event.offsetY);
      down = null;
    });
    canvas.addEventListener('pointermove', (event) => {
      this.#tell(event.offsetX, event.offsetY);
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const now = [event.offsetX, event.offsetY];
      const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const spread = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        const middle = (p) => [(p[0] + other[0]) / 2, (p[1] + other[1]) / 2];
        this.#camera.zoomBy(spread(now) / Math.max(1, spread(before)), ...middle(before));
        this.#camera.moveBy((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
      } else {
        this.#camera.moveBy(now[0] - before[0], now[1] - before[1]);
      }
      fingers.set(event.pointerId, now);
      this.redraw();
    });
    for (const kind of ['pointerup', 'pointercancel']) canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener('pointerleave', () => (this.readout.value = ''));
    canvas.addEventListener('dblclick', (event) => {
      if (this.#store.state.measuring) return;
      this.#camera.zoomBy(2.5, event.offsetX, event.offsetY);
      this.redraw();
    });
  }

  #tell(pixelX, pixelY) {
    const [x, y] = this.#camera.toPlane(pixelX, pixelY);
    const [atX, atY] = [x + this.origin[0], y + this.origin[1]].map((value) => coordinate(value, 1 / this.#camera.scale));
    this.readout.value = `x ${atX}   y ${atY} mm`;
  }

  /** A click tells what is there, or is an end of the distance that is measured. */
  #click(pixelX, pixelY) {
    if (this.#layer === null) return;
    const { state } = this.#store;
    const [x, y] = this.#camera.toPlane(pixelX, pixelY);
    const reach = nearClick / this.#camera.scale;
    const options = { ...state, parts: this.#page.head.parts };
    if (state.measuring) {
      if (this.#ends.length === 2) this.#ends = [];
      this.#ends.push(cornerNear(this.#layer, x, y, reach, options));
    } else {
      this.#picked = pickAt(this.#layer, this.#vectors, x, y, reach, options);
    }
    this.#tellPicked();
    this.#drawSoon();
  }

  /** Forgets what was clicked and measured. */
  forget() {
    this.#picked = undefined;
    this.#ends = [];
    this.#tellPicked();
    this.#drawSoon();
  }

  #tellPicked() {
    const { measuring } = this.#store.state;
    let text = '';
    if (measuring) text = ['Click where the distance begins', 'Click where it ends'][this.#ends.length] ?? distanceText(...this.#ends);
    else if (this.#picked) text = pickText(this.#picked, this.#layer, this.#vectors, this.#page.head.parts);
    this.answer.value = text;
    this.answer.hidden = text === '';
  }

  zoomBy(factor) {
    this.#camera.zoomBy(factor);
    this.redraw();
  }

  moveBy(x, y) {
    this.#camera.moveBy(x, y);
    this.redraw();
  }

  fit() {
    this.#camera.fit();
    this.redraw();
  }

  /** Shows the surroundings of a place, mm of the part's coordinates. */
  lookAt(x, y) {
    const { fitScale } = this.#camera;
    this.#camera.x = x - this.origin[0];
    this.#camera.y = y - this.origin[1];
    this.#camera.scale = Math.max(this.#camera.scale, 4 * fitScale);
    this.#camera.fitted = false;
    this.redraw();
  }

  /** Where one looks, mm of the part's coordinates; undefined as long as all is shown. */
  get outlook() {
    const { x, y, scale, fitted } = this.#camera;
    return fitted ? undefined : { x: x + this.origin[0], y: y + this.origin[1], scale };
  }

  set outlook({ x, y, scale }) {
    Object.assign(this.#camera, { x: x - this.origin[0], y: y - this.origin[1], scale, fitted: false });
    this.redraw();
  }

  /** In the next frame, all of it. */
  redraw() {
    this.#executed.count = Infinity;
    this.#drawSoon();
  }

  #drawSoon() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.#asked = false;
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (this.#layer === null || width === 0) return;
    this.#camera.resize(width, height);
    const density = window.devicePixelRatio || 1;
    const [pixelsX, pixelsY] = [Math.round(width * density), Math.round(height * density)];
    if (canvas.width !== pixelsX || canvas.height !== pixelsY) {
      [canvas.width, canvas.height] = [pixelsX, pixelsY];
      this.#executed.count = Infinity;
    }
    const ctx = canvas.getContext('2d');
    ctx.setTransform(density, 0, 0, density, 0, 0);
    const { state } = this.#store;
    const { head, table, notes } = this.#page;
    const z = table.z[this.#shown];
    const half = (table.top[this.#shown] - table.bottom[this.#shown]) / 2;
    const options = {
      ...state,
      parts: head.parts,
      origin: this.origin,
      colours: state.theme,
      partColours: state.theme.fills,
      marks: marksAt(notes.places, z, half, this.origin),
    };
    if (this.#vectors === null) drawLayer(ctx, this.#camera, this.#layer, options);
    else this.#drawExecuted(ctx, density, options);
    drawFaults(ctx, this.#camera, this.#layer, options);
    this.#drawPicked(ctx, state.theme);
    this.#drawLegend(state.colouring);
    this.#drawScale();
    if (canvas.dataset.layer === undefined) {
      performance.mark('first picture');
      afterPaint(this.#tellDrawn);
    }
    canvas.dataset.layer = this.#shown;
  }

  /** The vectors that are executed, on a picture of those drawn before: to go on takes as long as what is new. */
  #drawExecuted(ctx, density, options) {
    const [camera, vectors, executed] = [this.#camera, this.#vectors, this.#executed];
    const order = Math.min(options.order, vectors.count);
    const kept = executed.canvas.getContext('2d');
    if (executed.count > order) {
      [executed.canvas.width, executed.canvas.height] = [this.canvas.width, this.canvas.height];
      kept.setTransform(density, 0, 0, density, 0, 0);
      const exposed = options.parts.flatMap((each, part) => (isVectors(each) ? [part] : []));
      drawLayer(kept, camera, this.#layer, { ...options, hidden: new Set([...options.hidden, ...exposed]) });
      if (order < vectors.count) drawOutline(kept, camera, vectors, options);
      executed.count = 0;
    }
    drawVectors(kept, camera, vectors, executed.count, order, options);
    executed.count = order;
    ctx.drawImage(executed.canvas, 0, 0, camera.width, camera.height);
    if (options.directions) drawVectorDirections(ctx, camera, vectors, order, options);
    if (order < vectors.count) drawBeam(ctx, camera, vectors, order, options.colours);
  }

  /** The contour or vector that was clicked, and the distance that is measured. */
  #drawPicked(ctx, colours) {
    const [camera, picked] = [this.#camera, this.#picked];
    ctx.strokeStyle = colours.accent;
    ctx.fillStyle = colours.accent;
    ctx.lineWidth = 3;
    ctx.lineJoin = 'round';
    ctx.beginPath();
    if (picked?.kind === 'contour') trace(ctx, this.#layer.parts[picked.part], picked.number, camera);
    if (picked?.kind === 'vector') {
      const [ax, ay, bx, by] = this.#vectors.lines.subarray(4 * picked.number, 4 * picked.number + 4);
      ctx.moveTo(camera.toPixelX(ax), camera.toPixelY(ay));
      ctx.lineTo(camera.toPixelX(bx), camera.toPixelY(by));
    }
    ctx.stroke();
    ctx.lineWidth = 2;
    ctx.beginPath();
    this.#ends.forEach(([x, y], i) => (i === 0 ? ctx.moveTo(camera.toPixelX(x), camera.toPixelY(y)) : ctx.lineTo(camera.toPixelX(x), camera.toPixelY(y))));
    ctx.stroke();
    for (const [x, y] of this.#ends) {
      ctx.beginPath();
      ctx.arc(camera.toPixelX(x), camera.toPixelY(y), 4, 0, 7);
      ctx.fill();
    }
  }

  /** The scale of the colours, with the values at its ends. */
  #drawLegend(colouring) {
    this.legend.hidden = colouring === 'kind' || this.#vectors === null;
    if (this.legend.hidden) return;
    const { name, text } = colourings[colouring];
    const range = rangeOf(colouring, this.#vectors, this.#page.head.parts);
    const bar = element('i', { 'aria-hidden': true, style: `background: linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map(scaleColour).join(', ')})` });
    this.legend.replaceChildren(`${name} ${text(range[0])} `, bar, ` ${text(range[1])}`);
  }

  #drawScale() {
    const length = roundStep(70 / this.#camera.scale);
    this.scale.lastChild.style.width = `${length * this.#camera.scale}px`;
    this.scaleText.textContent = `${mm(length)} mm`;
  }
}

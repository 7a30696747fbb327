import { hasMaterial, hasVectors } from '../data/exposures.js';
import { element } from '../element.js';
import { largest, least, nearest } from '../extremes.js';
import { faultText } from '../findings.js';
import { iconButton } from '../icon.js';
import { brief, count, layerNumber, layerNumbers, mm } from '../text.js';
import { LayerAxis, drawPlot, drawTicks } from './plot.js';

const rowsOfMaterial = [
  { column: 'area_mm2', name: 'Area', unit: 'mm²', tell: brief },
  { column: 'perimeter_mm', name: 'Perimeter', unit: 'mm', tell: brief },
  { column: 'contours', name: 'Contours', unit: '', tell: count },
  { column: 'points', name: 'Points', unit: '', tell: count },
  { column: 'open_chains', name: 'Open', unit: '', tell: count, fault: true },
  { column: 'crossings', name: 'Crossings', unit: '', tell: count, fault: true, extra: true },
  { column: 'misoriented', name: 'Inside out', unit: '', tell: count, fault: true, extra: true },
  { column: 'longest_gap_mm', name: 'Gap', unit: 'mm', tell: brief, fault: true, extra: true },
  { column: 'rings_dropped', name: 'Dropped', unit: '', tell: count, extra: true },
];
const rowsOfVectors = [
  { column: 'build_seconds', name: 'Time', unit: 's', tell: brief, extra: true },
  { column: 'vectors', name: 'Vectors', unit: '', tell: count },
  { column: 'marked_mm', name: 'Marked', unit: 'mm', tell: brief },
  { column: 'jumped_mm', name: 'Jumped', unit: 'mm', tell: brief },
];

/** Rows of what not all stacks have are there for those alone. */
const rowsFor = ({ head, table }) =>
  [...(hasVectors(head) ? rowsOfVectors : []), ...(hasMaterial(head) ? rowsOfMaterial : [])].filter(
    ({ column, extra }) => !extra || table[column]?.some((value) => value > 0),
  );

/** A height for a field: digits and a point, without the last digits that sums leave. */
const plain = (z) => mm(z).replaceAll(',', '');

/** The slider over all layers, and under it what they measure, on the same axis. */
export class Timeline {
  #page;
  #store;
  #player;

  constructor(page, store, player) {
    this.#page = page;
    this.#store = store;
    this.#player = player;
    this.slider = element('input', {
      type: 'range',
      id: 'layer',
      min: 0,
      max: Math.max(0, page.head.layers - 1),
      step: 1,
      'aria-label': 'Layer',
    });
    this.slider.addEventListener('input', () => player.go(Number(this.slider.value)));
    this.number = element('input', {
      type: 'number',
      className: 'number',
      min: page.table.index[0],
      max: page.table.index.at(-1),
      'aria-label': 'Number of the layer',
    });
    this.number.addEventListener('change', () => {
      if (this.number.value !== '') player.go(nearest(page.table.index, Number(this.number.value)));
      this.number.value = page.table.index[store.state.layer];
    });
    this.height = element('input', { type: 'number', className: 'number', step: 'any', 'aria-label': 'Height of the cut, mm' });
    this.height.addEventListener('change', () => {
      if (this.height.value !== '') player.go(nearest(page.table.z, Number(this.height.value)));
      this.height.value = plain(page.table.z[store.state.layer]);
    });
    this.cursor = element('i', { className: 'cursor', 'aria-hidden': true });
    this.plots = rowsFor(page).map((row) => this.#plot(row));
    this.node = element(
      'section',
      { className: 'timeline', 'aria-label': 'Layers' },
      element(
        'div',
        { className: 'transport' },
        iconButton('First layer (Home)', 'first', () => player.go(0)),
        iconButton('Layer below (←)', 'back', () => player.step(-1)),
        this.#playButton(),
        iconButton('Layer above (→)', 'forth', () => player.step(1)),
        iconButton('Last layer (End)', 'last', () => player.go(page.head.layers - 1)),
        element('label', { className: 'chosen' }, 'Layer ', this.number),
        element('span', { className: 'of' }, layerNumbers(page.table)),
        element('label', { className: 'height' }, 'z ', this.height, ' mm'),
      ),
      element('div', { className: 'track' }, this.slider),
      element('div', { className: 'plots' }, ...this.plots.map((plot) => plot.node), this.cursor),
    );
    new ResizeObserver(() => this.#draw()).observe(this.plots[0].canvas);
    store.on(['layer'], (state) => this.#follow(state.layer));
    store.on(['theme'], () => this.#draw());
  }

  #playButton() {
    const button = element('button', { type: 'button', className: 'play', title: 'Play (space)', onclick: () => this.#player.toggle() });
    this.#store.on(['playing'], ({ playing }) => {
      button.textContent = playing ? 'Pause' : 'Play';
      button.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    });
    return button;
  }

  #plot(row) {
    const values = this.#page.table[row.column];
    const value = element('span', { className: 'value' });
    const low = values.length > 0 ? least(values) : 0;
    const high = values.length > 0 ? largest(values) : 0;
    const text = `${row.name} of the layers, from ${row.tell(low)} to ${row.tell(high)} ${row.unit}`;
    const canvas = element('canvas', { className: 'plot', role: 'img', 'aria-label': text });
    const go = (event) => {
      const axis = new LayerAxis(this.#page.head.layers, canvas.clientWidth);
      this.#player.go(axis.layerAt(event.offsetX));
    };
    let finger = null; // where one came down that may be about to scroll the page: it has to move sideways, or to leave there
    canvas.addEventListener('pointerdown', (event) => {
      finger = event.pointerType === 'touch' ? event : null;
      if (finger) return;
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) return;
      if (finger && Math.abs(event.clientX - finger.clientX) <= Math.abs(event.clientY - finger.clientY)) return;
      finger = null;
      go(event);
    });
    canvas.addEventListener('click', go);
    const quiet = row.fault && high === 0;
    const node = element(
      'div',
      { className: `row${row.fault ? ' fault' : ''}${quiet ? ' quiet' : ''}` },
      element('span', { className: 'name' }, row.name),
      value,
      canvas,
    );
    return { ...row, values, canvas, value, node };
  }

  #follow(layer) {
    const { table } = this.#page;
    this.slider.value = layer;
    const faults = faultText(table, layer);
    this.slider.setAttribute('aria-valuetext', `Layer ${layerNumber(table, layer)} ${layerNumbers(table)}, z = ${mm(table.z[layer])} mm${faults && `, ${faults}`}`);
    if (document.activeElement !== this.number) this.number.value = table.index[layer];
    if (document.activeElement !== this.height) this.height.value = plain(table.z[layer]);
    for (const plot of this.plots) plot.value.textContent = `${plot.tell(plot.values[layer])} ${plot.unit}`;
    this.#place();
  }

  #place() {
    const { canvas } = this.plots[0];
    const axis = new LayerAxis(this.#page.head.layers, canvas.clientWidth);
    this.cursor.style.transform = `translateX(${canvas.offsetLeft + axis.at(this.#store.state.layer)}px)`;
  }

  #draw() {
    const { theme } = this.#store.state;
    const density = window.devicePixelRatio || 1;
    for (const { canvas, values, fault } of this.plots) {
      const [width, height] = [canvas.clientWidth, canvas.clientHeight];
      if (width === 0 || values.length === 0) continue;
      canvas.width = Math.round(width * density);
      canvas.height = Math.round(height * density);
      const ctx = canvas.getContext('2d');
      ctx.setTransform(density, 0, 0, density, 0, 0);
      const axis = new LayerAxis(values.length, width);
      if (fault) drawTicks(ctx, values, axis, height, theme.fault);
      else drawPlot(ctx, values, axis, height, { line: theme.plot, fill: theme.plotFill });
    }
    this.#place();
  }
}

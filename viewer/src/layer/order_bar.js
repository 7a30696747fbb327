import { partOf } from '../data/vectors.js';
import { element } from '../element.js';
import { icon, iconButton } from '../icon.js';
import { brief, count, duration } from '../text.js';

/** The bar under a layer of scan vectors: how far they are executed, and what the beam does there. */
export class OrderBar {
  #page;
  #store;
  #vectors = null;
  #number = 0;

  /** @param {import('../player.js').Player} player of the order */
  constructor(page, store, player) {
    this.#page = page;
    this.#store = store;
    this.slider = element('input', { type: 'range', id: 'order', min: 0, step: 1, 'aria-label': 'Vectors, as they are executed' });
    this.slider.addEventListener('input', () => player.go(Number(this.slider.value)));
    // Arrows and the like are for the layers elsewhere on the page.
    this.slider.addEventListener('keydown', (event) => /^(Arrow|Page|Home|End)/.test(event.key) && event.stopPropagation());
    const play = iconButton('Execute (O)', 'forth', () => player.toggle());
    store.on(['executing'], ({ executing }) => {
      play.replaceChildren(icon(executing ? 'pause' : 'forth'));
      play.setAttribute('aria-pressed', executing);
    });
    this.place = element('b');
    this.what = element('span', { className: 'what' });
    this.time = element('span', { className: 'time' });
    this.node = element(
      'div',
      { className: 'order', role: 'group', 'aria-label': 'Order of the vectors' },
      play,
      this.slider,
      element('p', { className: 'beam' }, this.place, this.what, this.time),
    );
    store.on(['order'], () => this.#tell());
  }

  /** @param {import('../data/vectors.js').Vectors} vectors of the layer with that number */
  show(vectors, number) {
    this.#vectors = vectors;
    this.#number = number;
    this.slider.max = vectors.count;
    this.#tell();
  }

  #tell() {
    if (this.#vectors === null) return;
    const { count: all, seconds } = this.#vectors;
    const order = Math.min(this.#store.state.order, all);
    this.slider.value = order;
    this.place.textContent = all === 0 ? 'No vectors' : `Vector ${count(order)} of ${count(all)}`;
    this.what.textContent = order === 0 ? '' : this.#whatOf(order - 1);
    this.time.textContent = this.#leftOut() || this.#timeText(order === 0 ? 0 : seconds[order - 1]);
    this.slider.setAttribute('aria-valuetext', [this.place, this.what, this.time].map((node) => node.textContent).filter(Boolean).join(', '));
  }

  #whatOf(vector) {
    const { part, region, kind, contour, parameters } = this.#page.head.parts[partOf(this.#vectors, vector)].exposure;
    const name = `${region} ${kind}${contour > 0 ? ` ${contour}` : ''}`;
    const body = new Set(this.#page.head.parts.map(({ exposure }) => exposure?.part)).size > 1 ? `${part}, ` : '';
    const { power_w, speed_mm_s } = parameters;
    const stated = [...(power_w > 0 ? [`${brief(power_w)} W`] : []), ...(speed_mm_s > 0 ? [`${brief(speed_mm_s)} mm/s`] : [])].join(', ');
    return `${body}${name}${parameters.name ? `, “${parameters.name}”` : ''}${stated ? `: ${stated}` : ''}`;
  }

  #timeText(seconds) {
    const all = this.#page.table.build_seconds[this.#number];
    // Sums of rounded times may be a little more than all.
    return all > 0 ? `${duration(Math.min(seconds, all))} of ${duration(all)}` : '';
  }

  /** Where vectors are missing, nobody knows when the others are executed. */
  #leftOut() {
    const { hatches, hatches_shown, tolerance_mm } = this.#page.table;
    if (hatches[this.#number] > hatches_shown[this.#number]) return `without ${count(hatches[this.#number])} hatch lines: see Diagnosis`;
    return tolerance_mm[this.#number] > 0 ? 'thinned out: see Diagnosis' : '';
  }
}

import { isVectors } from './exposures.js';
import { insideOutOf } from './inside_out.js';
import { readLayer } from './layer.js';
import { readMesh } from './mesh.js';
import { unpack } from './unpack.js';

const json = (document, id) => JSON.parse(document.getElementById(id)?.textContent ?? 'null');

/**
 * What the page holds. Geometry stays text until somebody asks for it.
 * @param {Document} document
 */
export function readPage(document) {
  const head = json(document, 'head');
  if (head === null) throw new Error('this page holds no data: it was not written to its end');
  const data = [...document.querySelectorAll('script.data')];
  return { head, table: json(document, 'table'), notes: json(document, 'notes'), data };
}

/** @returns {Promise<import('./mesh.js').Mesh>} */
export async function meshOf(page) {
  return readMesh(await unpack(page.data[0].textContent), page.head.step_mm);
}

/** Layers, decoded when they are first asked for; those not asked for longest are let go. */
export class LayerShelf {
  static #mostPoints = 4e6;
  #page;
  #kept = new Map(); // number -> promise of the layer; the order is that of the last use
  #points = 0;

  constructor(page) {
    this.#page = page;
  }

  get count() {
    return this.#page.head.layers;
  }

  /** @returns {Promise<import('./layer.js').Layer>} */
  layer(i) {
    const kept = this.#kept.get(i);
    if (kept) {
      this.#kept.delete(i);
      this.#kept.set(i, kept);
      return kept;
    }
    const made = this.decode(i);
    this.#kept.set(i, made);
    this.#points += this.#pointsOf(i);
    for (const old of this.#kept.keys()) {
      if (this.#points <= LayerShelf.#mostPoints || old === i) break;
      this.#kept.delete(old);
      this.#points -= this.#pointsOf(old);
    }
    return made;
  }

  #pointsOf(i) {
    const { shown, hatches_shown } = this.#page.table;
    return shown[i] + 2 * hatches_shown[i];
  }

  /** The same without being kept. */
  async decode(i) {
    const { head, table, data } = this.#page;
    const layer = readLayer(await unpack(data[i].textContent), head.parts.length, head.step_mm);
    const bounds = (part) => table.misoriented[i] + table.crossings[i] > 0 && !isVectors(head.parts[part]);
    layer.insideOut = insideOutOf(layer.parts, bounds, head.step_mm);
    if (table.crossings[i] > 0) layer.insideOut.deepest += 1; // a ring that crosses itself runs both ways
    return layer;
  }
}

/**
 * What the page shows at the moment, and who wants to know when that changes.
 * @template {object} State
 */
export class Store {
  #state;
  #listeners = [];

  /** @param {State} state */
  constructor(state) {
    this.#state = state;
  }

  /** @returns {Readonly<State>} */
  get state() {
    return this.#state;
  }

  /** @param {Partial<State>} changes listeners hear of those that are any */
  set(changes) {
    const changed = Object.keys(changes).filter((key) => changes[key] !== this.#state[key]);
    if (changed.length === 0) return;
    this.#state = { ...this.#state, ...changes };
    for (const { keys, listen } of this.#listeners)
      if (keys.some((key) => changed.includes(key))) listen(this.#state);
  }

  /** Calls listen(state) now and whenever one of these keys changes. */
  on(keys, listen) {
    this.#listeners.push({ keys, listen });
    listen(this.#state);
  }
}

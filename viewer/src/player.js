/** Goes from layer to layer: by steps, or by itself. */
export class Player {
  static #secondsForAll = 12;
  #store;
  #count;
  #frame = 0;

  constructor(store, count) {
    this.#store = store;
    this.#count = count;
    store.on(['playing'], ({ playing }) => (playing ? this.#run() : cancelAnimationFrame(this.#frame)));
  }

  /** To the layer, or the nearest one that there is. */
  go(layer) {
    this.#store.set({ layer: Math.min(this.#count - 1, Math.max(0, layer)), playing: false });
  }

  step(by) {
    this.go(this.#store.state.layer + by);
  }

  toggle() {
    this.#store.set({ playing: !this.#store.state.playing });
  }

  /** Three layers a second at least, and through all of them in some seconds. */
  #run() {
    const perSecond = Math.max(3, this.#count / Player.#secondsForAll);
    const { layer } = this.#store.state;
    const first = layer >= this.#count - 1 ? 0 : layer;
    const start = performance.now();
    const frame = (now) => {
      const at = Math.min(this.#count - 1, first + Math.max(0, Math.floor(((now - start) / 1000) * perSecond)));
      this.#store.set({ layer: at });
      if (at === this.#count - 1) this.#store.set({ playing: false });
      else if (this.#store.state.playing) this.#frame = requestAnimationFrame(frame);
    };
    this.#frame = requestAnimationFrame(frame);
  }
}

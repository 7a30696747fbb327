/** Goes from number to number of what the store has, such as from layer to layer: by steps, or by itself. */
export class Player {
  static #secondsForAll = 12;
  #store;
  #key;
  #playing;
  #last;
  #frame = 0;

  /**
   * @param {string} key of the number in the store
   * @param {string} playing the key of whether it goes on by itself
   * @param {() => number} last number that there is; the first one is 0
   */
  constructor(store, key, playing, last) {
    this.#store = store;
    this.#key = key;
    this.#playing = playing;
    this.#last = last;
    store.on([playing], (state) => (state[playing] ? this.#run() : cancelAnimationFrame(this.#frame)));
  }

  /** To the number, or the nearest one that there is. */
  go(number) {
    this.#store.set({ [this.#key]: Math.min(this.#last(), Math.max(0, number)), [this.#playing]: false });
  }

  step(by) {
    this.go(Math.min(this.#last(), this.#store.state[this.#key]) + by);
  }

  toggle() {
    this.#store.set({ [this.#playing]: !this.#store.state[this.#playing] });
  }

  /** Three numbers a second at least, and through all of them in some seconds. */
  #run() {
    const last = this.#last();
    const perSecond = Math.max(3, last / Player.#secondsForAll);
    const now = this.#store.state[this.#key];
    const first = now >= last ? 0 : now;
    const start = performance.now();
    const frame = (now) => {
      const at = Math.min(last, first + Math.max(0, Math.floor(((now - start) / 1000) * perSecond)));
      this.#store.set({ [this.#key]: at });
      if (at === last) this.#store.set({ [this.#playing]: false });
      else if (this.#store.state[this.#playing]) this.#frame = requestAnimationFrame(frame);
    };
    this.#frame = requestAnimationFrame(frame);
  }
}

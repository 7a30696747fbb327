// The frame of the viewer. The next page is built behind the one that is seen, and begins with what that one shows
// (viewer/src/host.js).

const patience = 400; // ms until a page that does not answer is not asked any more
const mostWait = 20000; // ms until a page is shown that has not said that it is ready

const messages = new EventTarget();
addEventListener('message', ({ data, source }) => {
  if (data?.lamella) messages.dispatchEvent(Object.assign(new Event('message'), { of: source, ...data.lamella }));
});

/** The next message of a frame that has a property; undefined after some time. */
function next(frame, property, milliseconds) {
  return new Promise((resolve) => {
    const listen = (event) => event.of === frame.contentWindow && event[property] !== undefined && end(event[property]);
    const end = (value) => {
      messages.removeEventListener('message', listen);
      clearTimeout(timer);
      resolve(value);
    };
    const timer = setTimeout(end, milliseconds);
    messages.addEventListener('message', listen);
  });
}

export class ViewerFrame {
  #frame;
  #kind = null; // of the page that is seen
  #look = {};
  #places = {}; // where one looks, by kind of page
  #turn = 0;

  /**
   * @param {HTMLIFrameElement} frame
   * @param {{theme: Function, drag: Function, files: Function}} react called with what the page tells
   */
  constructor(frame, react) {
    this.#frame = frame;
    for (const [name, act] of Object.entries(react))
      messages.addEventListener('message', (event) => event.of === this.#frame.contentWindow && event[name] !== undefined && act(event[name]));
  }

  /** A new part is looked at from anew. */
  forgetPlaces() {
    this.#places = {};
    this.#kind = null;
  }

  set theme(name) {
    this.#look.theme = name;
  }

  /** Asks the page that is seen what it shows. */
  async #remember() {
    if (this.#kind === null) return;
    const kind = this.#kind;
    const answer = next(this.#frame, 'shown', patience);
    this.#frame.contentWindow?.postMessage({ lamella: { ask: 'shown' } }, '*');
    const shown = await answer;
    if (!shown || kind !== this.#kind) return;
    this.#look = { ...this.#look, ...shown.look };
    this.#places[kind] = shown.place;
  }

  /**
   * Shows a page, and is done when there is something to see.
   * @param {string} address @param {string} kind such as 'layers' @param {string} title
   * @returns {Promise<boolean>} whether it is seen, and not another one that was asked for meanwhile
   */
  async show(address, kind, title) {
    const turn = ++this.#turn;
    await this.#remember();
    if (turn !== this.#turn) return false;
    const frame = Object.assign(this.#frame.cloneNode(), { id: '', title, hidden: false, className: 'coming' });
    const shown = { look: this.#look, place: this.#places[kind] ?? {} };
    frame.src = `${address}#shown=${encodeURIComponent(JSON.stringify(shown))}`;
    this.#frame.after(frame);
    await next(frame, 'ready', mostWait);
    if (turn !== this.#turn) return void frame.remove() ?? false;
    this.#frame.remove();
    Object.assign(frame, { id: 'viewer', className: '' });
    this.#frame = frame;
    this.#kind = kind;
    return true;
  }
}

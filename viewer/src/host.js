/**
 * The page around this one, if that is a host: it shows one page after the other in its frame, such as the playground after
 * each run. It passes what the page before has shown in the address, "#shown=" and JSON; it asks for that before the next
 * page, and gets the theme and what is dropped here.
 *
 * @typedef {object} Shown
 * @property {object} look how layers are drawn: properties of View, `theme` by its name
 * @property {object} place where one looks, mm of the part's coordinates
 */

const given = /^#shown=(.+)$/.exec(location.hash)?.[1];

/** Keys of View that belong to the look. */
const lookKeys = ['view', 'fill', 'lines', 'directions', 'hatches', 'ghosts', 'jumps'];

export const hasHost = given !== undefined && parent !== window;

/** What the page before has shown; of a first page nothing. @returns {{look: object, place: object}} */
export const shownBefore = () => ({ look: {}, place: {}, ...(hasHost ? JSON.parse(decodeURIComponent(given)) : {}) });

/** Of the look that was shown, what the store keeps. */
export const lookOf = (state) => Object.fromEntries(lookKeys.filter((key) => state[key] !== undefined).map((key) => [key, state[key]]));

const tell = (message) => parent.postMessage({ lamella: message }, '*');

/** @param {() => object} placeNow where one looks */
export function answerHost(store, placeNow) {
  if (!hasHost) return;
  const themeName = () => (store.state.theme.dark ? 'dark' : 'light');
  addEventListener('message', ({ data, source }) => {
    if (source === parent && data?.lamella?.ask === 'shown') tell({ shown: { look: { ...lookOf(store.state), theme: themeName() }, place: placeNow() } });
  });
  let first = true;
  store.on(['theme'], () => (first ? (first = false) : tell({ theme: themeName() })));
  for (const kind of ['dragover', 'dragleave', 'drop'])
    addEventListener(kind, (event) => {
      event.preventDefault();
      tell({ drag: kind === 'dragover' });
      if (kind === 'drop' && event.dataTransfer.files.length > 0) tell({ files: [...event.dataTransfer.files] });
    });
}

/** There is something to see. */
export const tellReady = () => hasHost && tell({ ready: true });

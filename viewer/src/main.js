import './styles.css';
import { readPage } from './data/page.js';
import { element } from './element.js';
import { answerHost, lookOf, shownBefore, tellReady } from './host.js';
import { listenToKeys } from './keys.js';
import { buildLayerPage, signsOfLayers } from './layer_page.js';
import { buildMeshPage } from './mesh_page.js';
import { helpDialog } from './panels/help.js';
import { Store } from './store.js';
import { firstTheme, followTheme, switchTheme } from './theme.js';
import { watchScrolling } from './touch.js';
import { nextTurn } from './turn.js';

/**
 * What the page shows at the moment.
 * @typedef {object} View
 * @property {number} layer counted from 0
 * @property {boolean} playing
 * @property {object} theme the colours in effect
 * @property {boolean} fill whether the material is filled; likewise contours, directions, hatches
 * @property {boolean} ghosts whether the layers above are hinted at in the stack
 * @property {'layer'|'stack'|'both'} view
 * @property {Set<import('./data/exposures.js').Group>} off groups of parts that are not shown
 * @property {Set<number>} hidden the parts of these
 * @property {number} order number of vectors of the layer that are shown, as they are executed; Infinity for all
 * @property {boolean} executing whether the order plays
 * @property {boolean} jumps whether the ways between vectors are shown
 * @property {string} colouring of vectors: 'kind', or a key of colourings
 * @property {boolean} measuring whether clicks on the layer are the ends of a distance
 * @property {number|null} shell of a mesh: the one that is shown in colours; null for all
 */
async function build() {
  await nextTurn(); // it took a while to load the modules
  const page = readPage(document);
  const before = shownBefore();
  const store = new Store({
    layer: 0,
    playing: false,
    theme: firstTheme(before.look.theme),
    fill: true,
    lines: true,
    directions: true,
    hatches: true,
    ghosts: true,
    view: matchMedia('(min-width: 1100px)').matches ? 'both' : 'layer',
    off: new Set(),
    hidden: new Set(),
    order: Infinity,
    executing: false,
    jumps: true,
    colouring: 'kind',
    measuring: false,
    shell: null,
    ...lookOf(before.look),
  });
  followTheme(store);
  watchScrolling();
  document.title = `${page.head.title} – Lamella`;
  const title = document.getElementById('title');
  title.textContent = title.title = page.head.title; // there may be no room for all of it
  document.getElementById('theme').addEventListener('click', () => switchTheme(store));
  let help;
  const isMesh = page.head.kind === 'mesh';
  const { keys, place } = await (isMesh ? buildMeshPage : buildLayerPage)(page, store, document.getElementById('main'), () => help, before.place);
  help = helpDialog(keys, isMesh ? [] : signsOfLayers);
  document.getElementById('help').addEventListener('click', () => help.showModal());
  listenToKeys(keys);
  answerHost(store, place);
}

const main = document.getElementById('main');
try {
  if (typeof DecompressionStream === 'undefined')
    throw new Error('this browser is too old for this page: it takes Chrome 103, Firefox 113, Safari 16.4 or later');
  await build();
} catch (error) {
  main.replaceChildren(element('p', { className: 'trouble', role: 'alert' }, `This page cannot be shown: ${error.message}.`));
  throw error;
} finally {
  main.classList.remove('loading');
  tellReady();
}

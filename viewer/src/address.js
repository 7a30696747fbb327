import { nearest } from './extremes.js';
import { layerNumber } from './text.js';

/** "#layer=265" at the end of the page's address: it survives a reload, and is a link to a layer. So is "#z=26.55", in mm. */

const millisecondsOfStay = 300; // browsers take no more than some changes of the address in a second

/** The layer that the address names, or the one with the nearest number; undefined where it names none. */
export function layerInAddress(table, address = location.hash) {
  const named = /^#(layer|z)=(-?\d+(?:\.\d+)?)$/.exec(address);
  if (!named || table.index.length === 0) return undefined;
  return nearest(named[1] === 'z' ? table.z : table.index, Number(named[2]));
}

/** Has the address follow the layer once that stays, and the layer the address. @param {(layer: number) => void} go */
export function keepLayerInAddress(table, store, go) {
  let waiting = 0;
  let first = true;
  store.on(['layer'], ({ layer }) => {
    if (first) return void (first = false);
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      try {
        history.replaceState(null, '', `#layer=${layerNumber(table, layer)}`);
      } catch {
        // Some browsers allow it to no page from disk. Then the address stays as it is.
      }
    }, millisecondsOfStay);
  });
  addEventListener('hashchange', () => {
    const layer = layerInAddress(table);
    if (layer !== undefined) go(layer);
  });
}

/** Dark and light. The colours themselves are in styles.css; canvases ask here. */

import { kinds, regions } from './data/exposures.js';

const names = [
  'paper', 'grid', 'gridStrong', 'outer', 'hole', 'open', 'crossing', 'place', 'hatch', 'accent',
  'plot', 'plotFill', 'fault', 'bed', 'bedLine', 'soft', 'wallCut', 'inside', 'jump', 'outline',
];
const mostParts = 8;
const remembered = 'lamella-theme';

const variable = (style, name) => style.getPropertyValue(`--${name.replace(/[A-Z]/g, (c) => `-${c.toLowerCase()}`)}`).trim();

/** The colours in effect, by the names above, and those of parts: `fills` in 2D, `walls` in 3D; `vectors` by region and kind. */
function coloursInEffect() {
  const style = getComputedStyle(document.documentElement);
  const colours = Object.fromEntries(names.map((name) => [name, variable(style, name)]));
  for (const of of ['fill', 'wall'])
    colours[`${of}s`] = Array.from({ length: mostParts }, (_, i) => variable(style, `${of}-${i}`));
  colours.vectors = {};
  for (const region of regions)
    for (const kind of kinds) colours.vectors[`${region} ${kind}`] = variable(style, `${region}-${kind}`);
  colours.dark = document.documentElement.dataset.theme === 'dark';
  return colours;
}

/** Storage is refused to some pages opened from disk. */
const stored = {
  get: () => {
    try {
      return localStorage.getItem(remembered);
    } catch {
      return null;
    }
  },
  set: (value) => {
    try {
      localStorage.setItem(remembered, value);
    } catch {
      // Then the choice lasts as long as the page.
    }
  },
};

const wishOfSystem = matchMedia('(prefers-color-scheme: dark)');

function apply(name) {
  document.documentElement.dataset.theme = name;
  return coloursInEffect();
}

/** The theme to begin with: that of the page before in the same frame, else what was chosen before, else what the system asks for. */
export const firstTheme = (before) => apply(before ?? stored.get() ?? (wishOfSystem.matches ? 'dark' : 'light'));

/** Keeps the theme in the store, and follows the system until somebody chooses. */
export function followTheme(store) {
  wishOfSystem.addEventListener('change', () => {
    if (stored.get() === null) store.set({ theme: apply(wishOfSystem.matches ? 'dark' : 'light') });
  });
}

export function switchTheme(store) {
  const name = store.state.theme.dark ? 'light' : 'dark';
  stored.set(name);
  store.set({ theme: apply(name) });
}

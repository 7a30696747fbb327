import { element } from './element.js';
import { hasMaterial, hasVectors } from './data/exposures.js';
import { LayerShelf } from './data/page.js';
import { nearest } from './extremes.js';
import { faultText, faultsOf, firstLayer, layerText, verdict } from './findings.js';
import { LayerView } from './layer/layer_view.js';
import { layerPanels, middleOf } from './panels/panels.js';
import { StackView } from './stack/stack_view.js';
import { Player } from './player.js';
import { Timeline } from './timeline/timeline.js';
import { layerNumber, layerNumbers, mm } from './text.js';
import { switchTheme } from './theme.js';
import { keepLayerInAddress, layerInAddress } from './address.js';

/** Tells screen readers where one is, once the layer stays. */
function announce(page, store) {
  const live = document.getElementById('live');
  let waiting = 0;
  let first = true;
  store.on(['layer'], ({ layer }) => {
    if (first) return void (first = false);
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      const { table } = page;
      live.textContent =
        `Layer ${layerNumber(table, layer)} ${layerNumbers(table)}, z ${mm(table.z[layer])} millimetres, ` +
        `${layerText(page, layer)}, ${faultText(table, layer) || 'no faults'}`;
    }, 400);
  });
}

/** Buttons for the layer, the stack, or both side by side. */
function switchViews(store, layerView, stackView) {
  const names = { layer: 'Layer', stack: 'Stack', both: 'Both' };
  const group = document.getElementById('views');
  const buttons = Object.entries(names).map(([view, name]) =>
    element('button', { type: 'button', onclick: () => store.set({ view }) }, name),
  );
  group.append(...buttons);
  group.hidden = false;
  store.on(['view'], ({ view }) => {
    Object.keys(names).forEach((name, i) => buttons[i].setAttribute('aria-pressed', name === view));
    layerView.node.hidden = view === 'stack';
    stackView.node.hidden = view === 'layer';
  });
}

function keyTable(page, store, player, orderPlayer, layerView, stackView, help) {
  const faulty = page.table.z.flatMap((_, i) => (faultsOf(page.table, i) > 0 ? [i] : []));
  const nextFault = () => faulty.find((i) => i > store.state.layer) ?? faulty[0];
  const lastFault = () => faulty.findLast((i) => i < store.state.layer) ?? faulty.at(-1);
  const goTo = (layer) => layer !== undefined && player.go(layer);
  /** Keys are for the drawing that has the focus, or the only one there is. */
  const inStack = () => store.state.view === 'stack' || stackView.node.contains(document.activeElement);
  const zoom = (factor) => (inStack() ? stackView : layerView).zoomBy(factor);
  const move = (x, y) => (inStack() ? stackView.turnBy(-0.2 * x, 0.2 * y) : layerView.moveBy(-60 * x, 60 * y));
  const ofVectors = [
    { keys: ['.'], label: '. ,', help: 'one vector more, one less', act: () => orderPlayer.step(1) },
    { keys: [','], act: () => orderPlayer.step(-1) },
    { keys: ['>'], label: '> <', help: 'a hundred vectors more, less', act: () => orderPlayer.step(100) },
    { keys: ['<'], act: () => orderPlayer.step(-100) },
    { keys: ['o'], label: 'O', help: 'execute the vectors, pause', act: () => orderPlayer.toggle() },
    { keys: ['j'], label: 'J', help: 'jumps', act: () => store.set({ jumps: !store.state.jumps }) },
  ];
  return [
    { keys: ['ArrowRight', 'ArrowUp'], label: '→ ↑', help: 'layer above', act: () => player.step(1) },
    { keys: ['ArrowLeft', 'ArrowDown'], label: '← ↓', help: 'layer below', act: () => player.step(-1) },
    { keys: ['PageUp'], label: 'Page up', help: 'ten layers up', act: () => player.step(10) },
    { keys: ['PageDown'], label: 'Page down', help: 'ten layers down', act: () => player.step(-10) },
    { keys: ['Home'], label: 'Home', help: 'first layer', act: () => player.go(0) },
    { keys: ['End'], label: 'End', help: 'last layer', act: () => player.go(page.head.layers - 1) },
    { keys: [' '], label: 'Space', help: 'play and pause', act: () => player.toggle() },
    { keys: ['n'], label: 'N', help: 'next layer with a fault', act: () => goTo(nextFault()) },
    { keys: ['p'], label: 'P', help: 'layer with a fault before', act: () => goTo(lastFault()) },
    { keys: ['+', '='], label: '+', help: 'zoom in', act: () => zoom(1.5) },
    { keys: ['-'], label: '−', help: 'zoom out', act: () => zoom(1 / 1.5) },
    { keys: ['0'], label: '0', help: 'show all', act: () => (inStack() ? stackView : layerView).fit() },
    { keys: ['Shift+ArrowLeft'], label: 'Shift + arrows', help: 'move the layer, rotate the stack', act: () => move(-1, 0) },
    { keys: ['Shift+ArrowRight'], act: () => move(1, 0) },
    { keys: ['Shift+ArrowUp'], act: () => move(0, 1) },
    { keys: ['Shift+ArrowDown'], act: () => move(0, -1) },
    { keys: ['m'], label: 'M', help: 'measure a distance between two clicks; end it', act: () => store.set({ measuring: !store.state.measuring }) },
    { keys: ['Escape'], label: 'Esc', help: 'forget what was clicked and measured', act: () => layerView.forget() },
    { keys: ['d'], label: 'D', help: 'directions', act: () => store.set({ directions: !store.state.directions }) },
    ...(hasMaterial(page.head) ? [{ keys: ['f'], label: 'F', help: 'fill', act: () => store.set({ fill: !store.state.fill }) }] : []),
    ...(hasVectors(page.head) ? ofVectors : []),
    { keys: ['1', '2', '3'], label: '1 2 3', help: 'the layer, the stack, or both', act: ({ key }) => store.set({ view: ['layer', 'stack', 'both'][key - 1] }) },
    { keys: ['t'], label: 'T', help: 'dark or light', act: () => switchTheme(store) },
    { keys: ['?'], label: '?', help: 'this list', act: () => help().showModal() },
  ];
}

/** What drawings mean, for the list of keys. */
export const signsOfLayers = [
  'Red lines are open contours; red lines with red stripes are rings inside out. A cross in a circle marks a crossing of contours, ' +
    'a square on its corner a defect of the mesh.',
  'A click on a contour or a scan vector shows its figures.',
];

/**
 * Builds the page of a stack of layers.
 * @param {{z?: number, order?: number, layer?: object, stack?: object}} before where one looked in the page before (host.js)
 * @returns {{keys: object[], place: () => object}} its table of keys, and what tells where one looks
 */
export function buildLayerPage(page, store, main, help, before) {
  if (page.head.layers === 0) {
    main.append(element('p', { className: 'trouble' }, 'There are no layers in this file.'));
    return { keys: [], place: () => before };
  }
  const layerBefore = before.z === undefined ? undefined : nearest(page.table.z, before.z);
  store.set({ layer: layerInAddress(page.table) ?? layerBefore ?? firstLayer(page) });
  keepLayerInAddress(page.table, store, (layer) => player.go(layer));
  store.on(['layer'], () => store.set({ order: Infinity, executing: false }));
  const shelf = new LayerShelf(page);
  const player = new Player(store, 'layer', 'playing', () => page.head.layers - 1);
  const orderPlayer = new Player(store, 'order', 'executing', () => layerView.vectors);
  const layerView = new LayerView(page, shelf, store, orderPlayer);
  const timeline = new Timeline(page, store, player);
  const show = (place) => {
    const [x, y, z] = middleOf(place);
    player.go(nearest(page.table.z, z));
    layerView.lookAt(x, y);
    stackView.lookAt([x, y, z]);
  };
  const stackView = new StackView(page, shelf, store, layerView.drawn);
  if (before.layer) layerView.outlook = before.layer;
  if (before.stack) stackView.outlook = before.stack;
  if (before.order) store.set({ order: before.order });
  const stage = element('div', { className: 'stage' }, layerView.node, stackView.node);
  switchViews(store, layerView, stackView);
  main.append(stage, timeline.node, layerPanels(page, store, (layer) => player.go(layer), show));
  // Neighbours are ready before they are asked for.
  layerView.drawn.then(() =>
    store.on(['layer'], ({ layer }) => {
      for (const next of [layer + 1, layer - 1]) if (next >= 0 && next < shelf.count) shelf.layer(next);
    }),
  );
  announce(page, store);
  const { tone, text } = verdict(page);
  const node = document.getElementById('verdict');
  node.className = `verdict ${tone}`;
  node.textContent = text;
  const place = () => ({
    z: page.table.z[store.state.layer],
    ...(Number.isFinite(store.state.order) ? { order: store.state.order } : {}),
    layer: layerView.outlook,
    stack: stackView.outlook,
  });
  return { keys: keyTable(page, store, player, orderPlayer, layerView, stackView, help), place };
}

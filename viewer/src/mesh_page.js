import { meshOf } from './data/page.js';
import { element } from './element.js';
import { largest } from './extremes.js';
import { MeshView } from './mesh/mesh_view.js';
import { meshPanels, middleOf } from './panels/panels.js';
import { switchTheme } from './theme.js';

/** How far a place reaches, mm, seen from its middle. */
function reachOf({ points }) {
  const middle = middleOf({ points });
  return 2 * largest(points.map((p) => Math.hypot(...p.map((value, k) => value - middle[k]))));
}

function verdictOf(page) {
  const facts = page.notes.sections.flatMap((section) => section.facts);
  if (facts.some(({ tone }) => tone === 'bad')) return { tone: 'bad', text: 'The mesh has defects' };
  if (facts.some(({ tone }) => tone === 'warning')) return { tone: 'warning', text: 'The mesh is closed, with blemishes' };
  return { tone: 'good', text: 'The mesh is sound' };
}

/**
 * Builds the page of a mesh.
 * @param {{mesh?: object}} before where one looked in the page before (host.js)
 * @returns {Promise<{keys: object[], place: () => object}>} its table of keys, and what tells where one looks
 */
export async function buildMeshPage(page, store, main, help, before) {
  const stage = element('div', { className: 'stage tall' });
  const diagonal = Math.hypot(...page.head.box[0].map((low, k) => page.head.box[1][k] - low));
  let view = null;
  const panels = meshPanels(page, store, {
    place: (place) => view?.lookAtOutside(middleOf(place), Math.max(1.5 * reachOf(place), diagonal / 40)),
    shell: (shell, box) => {
      store.set({ shell });
      if (shell === null) view?.fit();
      else view?.lookAt(box[0].map((low, k) => (low + box[1][k]) / 2), Math.hypot(...box[0].map((low, k) => box[1][k] - low)));
    },
  });
  main.append(stage, panels);
  const { tone, text } = verdictOf(page);
  const verdict = document.getElementById('verdict');
  verdict.className = `verdict ${tone}`;
  verdict.textContent = text;

  const mesh = await meshOf(page);
  try {
    view = new MeshView(page, mesh, store);
    stage.append(view.node);
    if (before.mesh) view.outlook = before.mesh;
  } catch {
    stage.append(element('p', { className: 'trouble' }, 'This browser draws nothing in space: WebGL is missing or switched off.'));
  }
  const turn = 0.2;
  const keys = [
    { keys: ['ArrowLeft'], label: '← → ↑ ↓', help: 'rotate the mesh', act: () => view?.turnBy(turn, 0) },
    { keys: ['ArrowRight'], act: () => view?.turnBy(-turn, 0) },
    { keys: ['ArrowUp'], act: () => view?.turnBy(0, turn) },
    { keys: ['ArrowDown'], act: () => view?.turnBy(0, -turn) },
    { keys: ['+', '='], label: '+', help: 'zoom in', act: () => view?.zoomBy(1.5) },
    { keys: ['-'], label: '−', help: 'zoom out', act: () => view?.zoomBy(1 / 1.5) },
    { keys: ['0'], label: '0', help: 'show all', act: () => view?.fit() },
    { keys: ['t'], label: 'T', help: 'dark or light', act: () => switchTheme(store) },
    { keys: ['?'], label: '?', help: 'this list', act: () => help().showModal() },
  ];
  return { keys, place: () => ({ mesh: view?.outlook }) };
}

import { bodiesOf, hasMaterial, hasVectors, isVectors, switchGroup } from '../data/exposures.js';
import { element } from '../element.js';
import { largest, least } from '../extremes.js';
import { icon } from '../icon.js';
import { brief, count, counted, duration, layerNumber, mm, position, withBriefMeasures } from '../text.js';
import { faultText, findings, gapText, hasHatches, isTold, remarkableLayers, totals, widestGaps, worstLayers } from '../findings.js';

/** The column beside the drawings: what is known, in words and figures. */

function card(title, ...children) {
  return element('section', { className: 'card' }, element('h2', {}, title), ...children);
}

/** A list of names and values. */
function facts(pairs) {
  const list = element('dl');
  for (const [name, value, tone = 'plain'] of pairs)
    list.append(element('dt', {}, name), element('dd', { className: tone }, value));
  return list;
}

function finding({ tone, text, layer }, table, go) {
  const sign = element('span', { className: `sign ${tone}`, 'aria-hidden': true }, icon(tone));
  const item = element('li', { className: 'finding' }, sign, element('span', {}, text));
  if (layer !== undefined)
    item.lastChild.append(' ', element('button', { type: 'button', className: 'link', onclick: () => go(layer) }, `Show layer ${layerNumber(table, layer)}`));
  return item;
}

function diagnosisCard(page, go) {
  return card('Diagnosis', element('ul', { className: 'findings' }, ...findings(page).map((each) => finding(each, page.table, go))));
}

const rowsOfVectors = (table) => [
  ...(isTold(table.build_seconds) ? [['Time of the beam', (i) => duration(table.build_seconds[i])]] : []),
  ['Marked', (i) => `${brief(table.marked_mm[i])} mm`],
  ['Jumped', (i) => `${brief(table.jumped_mm[i])} mm`],
  ...(isTold(table.energy_j) ? [['Energy', (i) => `${brief(table.energy_j[i])} J`]] : []),
  ['Vectors', (i) => count(table.vectors[i])],
];

/** The figures of the layer that is shown. */
function layerCard(page, store) {
  const { head, table } = page;
  const rows = [
    ['Cut at z', (i) => `${mm(table.z[i])} mm`],
    ['Thickness', (i) => `${brief(table.top[i] - table.bottom[i])} mm`],
  ];
  const rowsOfMaterial = [
    ['Area', (i) => `${brief(table.area_mm2[i])} mm²`],
    ['Perimeter', (i) => `${brief(table.perimeter_mm[i])} mm`],
    ['Contours', (i) => count(table.contours[i])],
    ['Holes', (i) => count(table.holes[i])],
    ['Points', (i) => count(table.points[i])],
  ];
  if (hasVectors(head)) rows.push(...rowsOfVectors(table));
  if (hasHatches(table)) rows.push(['Hatch lines', (i) => count(table.hatches[i])]);
  if (hasMaterial(head)) rows.push(...rowsOfMaterial);
  if (table.open_chains.some((n) => n > 0)) rows.push(['Gaps', (i) => gapText(table, i)]);
  if (table.rings_dropped)
    rows.push(['Rings dropped', (i) => count(table.rings_dropped[i])], ['Area before', (i) => `${brief(table.area_before_mm2[i])} mm²`]);
  const list = facts(rows.map(([name]) => [name, '']));
  const values = list.querySelectorAll('dd');
  const fault = element('p', { className: 'fault' });
  const node = card('Layer', list, fault);
  store.on(['layer'], ({ layer }) => {
    node.firstChild.textContent = `Layer ${layerNumber(table, layer)}`;
    rows.forEach(([, tell], k) => (values[k].textContent = tell(layer)));
    const marked = table.crossings[layer] > head.most_marks ? `; of the crossings the first ${count(head.most_marks)} are marked` : '';
    const text = faultText(table, layer) + marked;
    fault.className = `fault ${text === '' ? 'good' : 'bad'}`;
    fault.textContent = text === '' ? 'No faults in this layer' : text;
  });
  return node;
}

function layerList(title, layers, page, go) {
  const items = layers.map(({ layer, text, bad }) =>
    element(
      'li',
      {},
      element(
        'button',
        { type: 'button', className: `pick${bad ? ' bad' : ''}`, onclick: () => go(layer) },
        element('b', {}, layerNumber(page.table, layer)),
        element('span', {}, text),
        element('small', {}, `z ${mm(page.table.z[layer])}`),
      ),
    ),
  );
  return card(title, element('ol', { className: 'picks' }, ...items));
}

/** Scan vectors have the colours of their regions and kinds, so there is none of their body to show. */
function partsCard({ parts }, bodies, store) {
  const items = bodies.map((body, number) => {
    const box = element('input', { type: 'checkbox', checked: true });
    box.addEventListener('change', () => switchGroup(store, body, box.checked));
    const swatch = element('i', { className: 'swatch', style: `background: var(--wall-${number % 8})`, 'aria-hidden': true });
    const signs = isVectors(parts[body.parts[0]]) ? [box] : [box, swatch];
    return element('li', {}, element('label', {}, ...signs, element('span', {}, body.name)));
  });
  return card(`${count(items.length)} parts`, element('ul', { className: 'parts' }, ...items));
}

/** What the program reported beside the data. */
function noteCards(page) {
  return page.notes.sections.map(({ title, facts: rows }) =>
    card(title, facts(rows.map(({ name, value, tone }) => [name, withBriefMeasures(value), tone]))),
  );
}

/**
 * Cards of the places that the program found in the mesh, and by the check of the print, kind by kind.
 * @param {(place: object) => void} show
 */
function placesCards(page, show) {
  const of = (print) => page.notes.places.filter(({ of_print }) => Boolean(of_print) === print);
  return [
    ['Defects of the mesh', of(false)],
    ['Found by the check', of(true)],
  ]
    .filter(([, places]) => places.length > 0)
    .map(([title, places]) => placesCard(title, places, show));
}

function placesCard(title, all, show) {
  const kinds = byKind(all);
  const most = 50; // in the list; all of them are drawn
  const lists = [...kinds].map(([kind, places]) => {
    const rest = places.length - most;
    const items = places.slice(0, most).map((place) =>
      element(
        'li',
        {},
        element('button', { type: 'button', className: 'pick place', onclick: () => show(place) }, element('span', {}, place.text), element('small', {}, at(place))),
      ),
    );
    if (rest > 0) items.push(element('li', { className: 'rest' }, `and ${count(rest)} more`));
    return element('details', { open: places.length <= 8 }, element('summary', {}, kindText(kind, places)), element('ol', { className: 'picks' }, ...items));
  });
  return card(title, ...lists);
}

/** "self-intersection (12)"; "self-intersection, the first 500 of 1,014" */
function kindText(kind, places) {
  const [{ found }] = places;
  return found > places.length ? `${kind}, the first ${count(places.length)} of ${count(found)}` : `${kind} (${count(places.length)})`;
}

function byKind(places) {
  const kinds = new Map();
  for (const place of places) kinds.set(place.kind, [...(kinds.get(place.kind) ?? []), place]);
  return kinds;
}

/** The middle of the box around a place's points, as `lamella info` reports it. */
export function middleOf({ points }) {
  return [0, 1, 2].map((k) => {
    const values = points.map((p) => p[k]);
    return (least(values) + largest(values)) / 2;
  });
}

const at = (place) => `(${middleOf(place).map(position).join(', ')})`;

/** The shells, each a button. @param {(shell: number|null, box?: number[][]) => void} show */
function shellsCard({ head }, store, show) {
  const button = (number, text, box) => {
    const node = element('button', { type: 'button', className: 'pick', onclick: () => show(number, box) }, ...text);
    store.on(['shell'], ({ shell }) => node.setAttribute('aria-pressed', shell === number));
    return element('li', {}, node);
  };
  const items = head.shells.map(({ kind, triangles, volume_mm3, box, inside }, number) => {
    const swatch = element('i', { className: 'swatch', style: `background: var(--wall-${number % 8})`, 'aria-hidden': true });
    const what = inside === null ? kind : `${kind} in shell ${inside + 1}`;
    const volume = kind === 'open' ? '' : `, ${brief(volume_mm3)} mm³`;
    return button(number, [swatch, element('b', {}, count(number + 1)), element('span', {}, `${what}${volume}`), element('small', {}, counted(triangles, 'triangle'))], box);
  });
  items.unshift(button(null, [element('span', {}, 'All shells')]));
  if (head.shell_count > head.shells.length)
    items.push(element('li', { className: 'rest' }, `and ${count(head.shell_count - head.shells.length)} more`));
  return card(counted(head.shell_count, 'shell'), element('ol', { className: 'picks' }, ...items));
}

function surfaceCard({ head }) {
  const all = head.shown === head.triangles;
  const text = all
    ? `All ${count(head.triangles)} triangles are shown, their corners rounded to ${brief(head.step_mm)} mm.`
    : `${count(head.shown)} of ${count(head.triangles)} triangles are shown: corners moved to the middles of cubes of ${brief(head.step_mm)} mm, and triangles left out that have two of them in one. Figures are of all.`;
  return card('This picture', element('p', {}, text), element('p', { className: 'soft' }, 'Orange is the inner side of the surface: where it is seen from outside, there is a hole, or triangles face the wrong way.'));
}

/** Beside a mesh. @param {{place: (place: object) => void, shell: (shell: number|null, box?: number[][]) => void}} show */
export function meshPanels(page, store, show) {
  const [mesh, ...others] = noteCards(page);
  const cards = [mesh];
  cards.push(...placesCards(page, show.place));
  cards.push(shellsCard(page, store, show.shell), ...others, surfaceCard(page));
  return element('aside', { className: 'panels', 'aria-label': 'Figures and findings' }, ...cards);
}

/** Beside layers. @param {(layer: number) => void} go @param {(place: object) => void} show */
export function layerPanels(page, store, go, show) {
  const worst = worstLayers(page.table);
  const remarkable = remarkableLayers(page);
  const cards = [layerCard(page, store), diagnosisCard(page, go)];
  if (worst.length > 0) cards.push(layerList('Worst layers', worst, page, go));
  const gaps = widestGaps(page.table);
  if (gaps.length > 0) cards.push(layerList('Longest gaps', gaps, page, go));
  cards.push(...placesCards(page, show));
  const bodies = bodiesOf(page.head);
  if (bodies.length > 1) cards.push(partsCard(page.head, bodies, store));
  cards.push(card('Stack', facts(totals(page))));
  if (remarkable.length > 0) cards.push(layerList('Layers that stand out', remarkable, page, go));
  cards.push(...noteCards(page));
  return element('aside', { className: 'panels', 'aria-label': 'Figures and findings' }, ...cards);
}

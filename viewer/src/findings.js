import { hasMaterial, hasVectors, isVectors } from './data/exposures.js';
import { largest, least } from './extremes.js';
import { brief, count, counted, duration, mm } from './text.js';

/** What the figures of the layers mean, in plain words. */

const sum = (values) => values.reduce((total, value) => total + value, 0);

/** Kinds of faults that a layer can have, the gravest first. */
export const faults = [
  {
    column: 'open_chains',
    name: 'open contours',
    one: 'open contour',
    meaning: 'contours that do not close, where the mesh has a hole or triangles that face the wrong way',
  },
  {
    column: 'crossings',
    name: 'crossings',
    one: 'crossing',
    meaning: 'places where contours cross each other or themselves',
  },
  {
    column: 'misoriented',
    name: 'rings inside out',
    one: 'ring inside out',
    meaning: 'rings that run the wrong way round and bound no material; areas count what they enclose as negative',
  },
];

/** How many faults layer i has. */
export const faultsOf = (table, i) => sum(faults.map(({ column }) => table[column][i]));

/** "2 open contours, 1 crossing"; "" for a layer without faults. */
export function faultText(table, i) {
  return faults
    .filter(({ column }) => table[column][i] > 0)
    .map(({ column, one, name }) => counted(table[column][i], one, name))
    .concat(table.longest_gap_mm[i] > 0 ? [`the longest gap ${brief(table.longest_gap_mm[i])} mm`] : [])
    .join(', ');
}

/** "in 3 of 20 layers, the lowest at z = 1.25 mm" */
function where(table, affected) {
  const all = table.z.length;
  const layers = affected.length < all ? `${count(affected.length)} of ${counted(all, 'layer')}` : all > 1 ? `all ${count(all)} layers` : 'the only layer';
  return `in ${layers}, ${affected.length > 1 ? 'the lowest ' : ''}at z = ${mm(table.z[affected[0]])} mm`;
}

const layersWith = (column) => column.flatMap((n, i) => (n > 0 ? [i] : []));

/**
 * @returns {{tone: string, text: string, layer?: number}[]} the gravest first; `layer` is one to look at
 */
export function findings(page) {
  const { head, table } = page;
  const found = [];
  for (const { column, one, name, meaning } of faults) {
    const affected = layersWith(table[column]);
    if (affected.length === 0) continue;
    const total = affected.length > 1 ? ' in total,' : '';
    const text = `${counted(sum(table[column]), one, name)}${total} ${where(table, affected)}: ${meaning}.`;
    found.push({ tone: 'bad', text, layer: affected[0] });
  }
  const [widest] = widestGaps(table, 1);
  if (widest)
    found.push({
      tone: 'bad',
      text:
        `The longest gap is ${brief(table.longest_gap_mm[widest.layer])} mm, all together ${brief(sum(table.gaps_mm))} mm; ` +
        'lamella slice --close-gaps MM closes those up to a length.',
      layer: widest.layer,
    });
  if (found.length === 0 && table.z.length > 0)
    found.push({
      tone: 'good',
      text: hasMaterial(head)
        ? 'Every contour closes, none crosses another, and all run the right way round.'
        : 'No contour crosses itself or another one of its exposure.',
    });
  const overlapping = layersWith(table.overlapping);
  if (overlapping.length > 0)
    found.push({
      tone: 'warning',
      text: `Bodies overlap ${where(table, overlapping)}. Areas count such places twice; lamella slice --fill nonzero unites them.`,
      layer: overlapping[0],
    });
  const empty = table.contours.flatMap((n, i) => (n === 0 && table.hatches[i] === 0 ? [i] : []));
  if (empty.length > 0)
    found.push({ tone: 'warning', text: `${counted(empty.length, 'layer')} with nothing in ${empty.length === 1 ? 'it' : 'them'}, the lowest at z = ${mm(table.z[empty[0]])} mm.`, layer: empty[0] });
  const bare = table.hatches.flatMap((n, i) => (n > table.hatches_shown[i] ? [i] : []));
  if (bare.length > 0)
    found.push({
      tone: 'warning',
      text:
        `To keep the page small, the hatches of ${counted(bare.length, 'layer')} of ${count(table.z.length)} are left out ` +
        `(${count(sum(table.hatches_shown))} of ${count(sum(table.hatches))} lines are there). All figures count every line.`,
      layer: bare[0],
    });
  for (const text of untoldSpeeds(head)) found.push({ tone: 'plain', text });
  found.push(accuracy(head, table));
  return found;
}

/** What of the times is missing, since speeds are: sentences. */
function untoldSpeeds({ parts }) {
  const parameters = parts.filter(isVectors).map(({ exposure }) => exposure.parameters);
  const marks = parameters.filter(({ speed_mm_s }) => speed_mm_s > 0).length;
  const jumps = parameters.filter(({ jump_speed_mm_s }) => jump_speed_mm_s > 0).length;
  if (parameters.length > 0 && marks + jumps === 0) return ['The file tells no speeds of the beam, so times and energies are unknown.'];
  const sentences = [];
  if (marks < parameters.length)
    sentences.push('The file does not tell all speeds of the beam: what is marked without one counts neither for time nor for energy.');
  if (jumps < parameters.length) sentences.push('The file does not tell how fast the beam jumps: times are without jumps.');
  return sentences;
}

function accuracy(head, table) {
  const thinned = layersWith(table.tolerance_mm);
  const rounded = `coordinates are rounded to ${brief(head.step_mm)} mm`;
  if (thinned.length === 0) return { tone: 'plain', text: `The page shows every point; ${rounded}.` };
  const worst = largest(table.tolerance_mm);
  const contours = sum(table.contours);
  const missing = contours - sum(table.contours_shown);
  return {
    tone: 'warning',
    text:
      `To keep the page small, ${counted(thinned.length, 'layer')} of ${count(table.z.length)} ` +
      `${thinned.length === 1 ? 'is' : 'are'} drawn with fewer points, up to ${brief(worst)} mm off ` +
      `(${count(sum(table.shown))} of ${count(sum(table.points))} points in all)` +
      `${missing > 0 ? `, and ${count(missing)} of ${counted(contours, 'contour')}, all small, are not drawn` : ''}; ${rounded}. ` +
      'All figures are of the full contours.',
    layer: thinned[0],
  };
}

/** In one line for the head of the page: { tone, text }. */
export function verdict(page) {
  const { head, table } = page;
  const bad = table.z.filter((_, i) => faultsOf(table, i) > 0).length;
  if (bad > 0) return { tone: 'bad', text: `${counted(bad, 'layer')} with faults` };
  if (!hasMaterial(head)) return { tone: 'plain', text: vectorText(sum(table.vectors), sum(table.build_seconds)) };
  if (page.notes.places.some(({ of_print }) => !of_print)) return { tone: 'warning', text: 'Contours are sound, the mesh has defects' };
  if (page.notes.places.length > 0) return { tone: 'warning', text: `Contours are sound, ${counted(page.notes.places.length, 'place')} found by the check` };
  return { tone: 'good', text: 'All contours are sound' };
}

/** Layers worth a look, the worst first: { layer, text, bad }. */
export function worstLayers(table, most = 10) {
  const layers = [...table.z.keys()];
  return layers
    .filter((i) => faultsOf(table, i) > 0)
    .sort((a, b) => faultsOf(table, b) - faultsOf(table, a) || a - b)
    .slice(0, most)
    .map((layer) => ({ layer, text: faultText(table, layer), bad: true }));
}

/** Layers with gaps, those with the longest ones first: { layer, text, bad }. */
export function widestGaps(table, most = 10) {
  const layers = [...table.z.keys()];
  return layers
    .filter((i) => table.longest_gap_mm[i] > 0)
    .sort((a, b) => table.longest_gap_mm[b] - table.longest_gap_mm[a] || a - b)
    .slice(0, most)
    .map((layer) => ({ layer, text: gapText(table, layer), bad: true }));
}

/** "1.2 mm"; "the longest 1.2 mm, 3 gaps of 2.5 mm in all"; "none". */
export function gapText(table, i) {
  if (table.open_chains[i] === 0) return 'none';
  const longest = `${brief(table.longest_gap_mm[i])} mm`;
  if (table.open_chains[i] === 1) return longest;
  return `the longest ${longest}, ${counted(table.open_chains[i], 'gap')} of ${brief(table.gaps_mm[i])} mm in all`;
}

/** To begin with: the layer with most faults, or else the one in the middle, of those that have all their hatches. */
export function firstLayer({ table }) {
  const middle = Math.floor(table.z.length / 2);
  const whole = [...table.z.keys()].filter((i) => table.hatches_shown[i] === table.hatches[i]);
  const nearest = whole.reduce((best, i) => (Math.abs(i - middle) < Math.abs(best - middle) ? i : best), whole[0] ?? middle);
  return worstLayers(table, 1)[0]?.layer ?? nearest;
}

/** Without a speed there is no time, either. */
const vectorText = (vectors, seconds) => counted(vectors, 'vector') + (seconds > 0 ? ` in ${duration(seconds)}` : '');

/** "3 contours, 12.5 mm²"; "1,234 vectors in 4.9 s" */
export function layerText({ head, table }, i) {
  const parts = hasVectors(head) ? [vectorText(table.vectors[i], table.build_seconds[i])] : [];
  if (hasMaterial(head)) parts.push(`${counted(table.contours[i], 'contour')}, ${brief(table.area_mm2[i])} mm²`);
  return parts.join(', ');
}

/** Layers that stand out, faults or not. */
export function remarkableLayers({ head, table }) {
  const layers = [...table.z.keys()];
  if (layers.length < 2) return [];
  const highest = (value) => layers.reduce((best, i) => (value(i) > value(best) ? i : best), 0);
  const step = (i) => (i === 0 ? 0 : Math.abs(table.area_mm2[i] - table.area_mm2[i - 1]));
  const [points, contours, area, change] = [(i) => table.points[i], (i) => table.contours[i], (i) => table.area_mm2[i], step].map(highest);
  const uneven = (column) => column.some((value) => value !== column[0]);
  if (!hasMaterial(head)) {
    const [time, vectors, jumps] = ['build_seconds', 'vectors', 'jumped_mm'].map((column) => highest((i) => table[column][i]));
    return [
      { layer: time, text: `longest time, ${duration(table.build_seconds[time])}`, stands: uneven(table.build_seconds) },
      { layer: vectors, text: `most vectors, ${count(table.vectors[vectors])}`, stands: uneven(table.vectors) },
      { layer: jumps, text: `longest jumps, ${brief(table.jumped_mm[jumps])} mm`, stands: uneven(table.jumped_mm) },
    ].filter(({ stands }) => stands);
  }
  return [
    { layer: area, text: `largest area, ${brief(table.area_mm2[area])} mm²`, stands: uneven(table.area_mm2) },
    { layer: change, text: `area changes most, by ${brief(step(change))} mm²`, stands: uneven(table.area_mm2) },
    { layer: contours, text: `most contours, ${count(table.contours[contours])}`, stands: uneven(table.contours) },
    { layer: points, text: `most points, ${count(table.points[points])}`, stands: uneven(table.points) },
  ].filter(({ stands }) => stands);
}

/** Whether there is anything in a column: files may leave out speeds and powers, and then there are no times and energies. */
export const isTold = (column) => column.some((value) => value > 0);

/** Not only scan vectors have hatches: slice files may have them beside contours of material. */
export const hasHatches = (table) => isTold(table.hatches);

/** Figures of the whole stack: [name, value] pairs. */
export function totals(page) {
  const { head, table } = page;
  const n = table.z.length;
  const thickness = table.z.map((_, i) => table.top[i] - table.bottom[i]);
  // Briefly: files keep heights as floats, and of a difference of two of them few digits are true.
  const [thin, thick] = [least(thickness), largest(thickness)].map(brief);
  return [
    ['Layers', count(n)],
    ['Layer height', n === 0 ? '–' : thin === thick ? `${thin} mm` : `${thin} to ${thick} mm`],
    ['From z', n === 0 ? '–' : `${mm(table.bottom[0])} to ${mm(table.top[n - 1])} mm`],
    ['Size', `${head.box[0].map((low, k) => brief(head.box[1][k] - low)).join(' × ')} mm`],
    ...(hasVectors(head) ? totalsOfVectors(table) : []),
    ...(hasHatches(table) ? [['Hatch lines', count(sum(table.hatches))]] : []),
    ...(hasMaterial(head) ? totalsOfMaterial(table, thickness) : []),
  ];
}

const totalsOfVectors = (table) => [
  ...(isTold(table.build_seconds) ? [['Time of the beam', duration(sum(table.build_seconds))]] : []),
  ['Marked', `${brief(sum(table.marked_mm) / 1000)} m`],
  ['Jumped', `${brief(sum(table.jumped_mm) / 1000)} m`],
  ...(isTold(table.energy_j) ? [['Energy', `${brief(sum(table.energy_j) / 1000)} kJ`]] : []),
  ['Vectors', count(sum(table.vectors))],
];

function totalsOfMaterial(table, thickness) {
  return [
    ['Volume', `${brief(sum(thickness.map((t, i) => t * table.area_mm2[i])))} mm³`],
    ['Contours', count(sum(table.contours))],
    ['Open contours', count(sum(table.open_chains))],
    ...(sum(table.open_chains) > 0 ? [['Gaps in all', `${brief(sum(table.gaps_mm))} mm`]] : []),
    ['Points', count(sum(table.points))],
    ...(table.rings_dropped
      ? [
          ['Rings dropped', count(sum(table.rings_dropped))],
          ['Volume before', `${brief(sum(thickness.map((t, i) => t * table.area_before_mm2[i])))} mm³`],
        ]
      : []),
  ];
}

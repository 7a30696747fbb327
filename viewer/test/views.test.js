import assert from 'node:assert/strict';
import { test } from 'node:test';
import { largest, least } from '../src/extremes.js';
import { faultText, findings, firstLayer, gapText, layerText, remarkableLayers, totals, verdict, widestGaps, worstLayers } from '../src/findings.js';
import { layerInAddress } from '../src/address.js';
import { Camera } from '../src/layer/camera.js';
import { roundStep } from '../src/layer/round_step.js';
import { levelsOf } from '../src/stack/levels.js';
import { middleOf } from '../src/panels/panels.js';
import { Walls, lineKinds, linesOfRow, spacingFor } from '../src/stack/walls.js';
import { Store } from '../src/store.js';
import { LayerAxis, columnsOf, drawTicks } from '../src/timeline/plot.js';
import { brief, coordinate, counted, duration, layerNumber, layerNumbers, mm, position, withBriefMeasures } from '../src/text.js';

test('stacks of more layers than a call takes arguments are summed up and plotted', () => {
  const n = 300_000;
  const page = pageOf(Array.from({ length: n }, (_, i) => ({ open_chains: i === 7 ? 1 : 0, tolerance_mm: i === 9 ? 0.5 : 0 })));
  page.head.box = [[0, 0, 0], [1, 1, n]];
  assert.deepEqual(totals(page)[1], ['Layer height', '1 mm']);
  assert.match(findings(page).at(-1).text, /up to 0\.5 mm off/);
  assert.deepEqual([least(page.table.z), largest(page.table.z)], [0.5, n - 0.5]);
  const drawn = [];
  drawTicks({ clearRect() {}, fillRect: (...box) => drawn.push(box) }, page.table.open_chains, new LayerAxis(n, 300), 22, 'red');
  assert.deepEqual(drawn, [[7, 0, 2, 19]]);
});

test('heights that a file keeps in single precision are shown as they were meant', () => {
  for (const [meant, text] of [[53.1, '53.1'], [0.05, '0.05'], [1234.567, '1,234.567'], [0.5, '0.5']]) assert.equal(mm(Math.fround(meant)), text);
  assert.equal(mm(53.0999999), '53.1');
  assert.equal(mm(53.099998), '53.099998');
});

test('a place is the middle of the box of its points, with the digits of the program', () => {
  const rim = { points: [[-500, 1300, 150], [-500, 1406.44, 213.398], [-500, 1405, 212], [-500, 1404, 211]] };
  assert.deepEqual(middleOf(rim).map(position), ['-500', '1,353.22', '181.699']);
});

test('a camera fits, zooms about a pixel and moves', () => {
  const camera = new Camera();
  camera.resize(800, 400);
  camera.frame([-10, 5, 30, 25]);
  assert.ok(camera.toPixelX(-10) >= 0 && camera.toPixelX(30) <= 800);
  assert.ok(camera.toPixelY(25) >= 0 && camera.toPixelY(5) <= 400);
  const place = camera.toPlane(100, 70);
  camera.zoomBy(7, 100, 70);
  assert.ok(Math.abs(camera.toPlane(100, 70)[0] - place[0]) < 1e-9);
  assert.ok(Math.abs(camera.toPlane(100, 70)[1] - place[1]) < 1e-9);
  assert.ok(Math.abs(camera.zoom - 7) < 1e-9);
  camera.moveBy(13, -4);
  assert.ok(Math.abs(camera.toPlane(113, 66)[0] - place[0]) < 1e-9);
  camera.fit();
  assert.equal(camera.zoom, 1);
  assert.ok(camera.sees([0, 10, 1, 11], 0));
  assert.ok(!camera.sees([500, 10, 501, 11], 0));
});

test('steps are round', () => {
  assert.deepEqual([0.3, 1, 1.01, 2.2, 7].map(roundStep), [0.5, 1, 2, 5, 10]);
});

test('an axis maps layers to pixels and back, and a plot loses no peak', () => {
  const axis = new LayerAxis(1000, 300);
  for (const layer of [0, 1, 499, 998, 999]) assert.ok(Math.abs(axis.layerAt(axis.at(layer)) - layer) <= 2);
  assert.equal(axis.layerAt(-50), 0);
  assert.equal(axis.layerAt(5000), 999);
  const values = Array.from({ length: 1000 }, (_, i) => (i === 617 ? 99 : 1));
  const columns = columnsOf(values, axis);
  assert.ok(columns.length <= 300);
  assert.equal(Math.max(...columns.map((column) => column.high)), 99);
  assert.equal(Math.min(...columns.map((column) => column.low)), 1);
});

const columns = ['area_mm2', 'contours', 'points', 'shown', 'open_chains', 'longest_gap_mm', 'gaps_mm', 'crossings', 'misoriented', 'overlapping', 'tolerance_mm', 'hatches', 'hatches_shown', 'contours_shown'];
const columnsOfVectors = ['vectors', 'marked_mm', 'jumped_mm', 'build_seconds', 'energy_j'];
function pageOf(layers, notes = { sections: [], places: [] }, parts = [{}]) {
  const table = { z: [], bottom: [], top: [] };
  for (const column of [...columns, ...(parts.some(({ exposure }) => exposure) ? columnsOfVectors : [])]) table[column] = layers.map((layer) => layer[column] ?? (column.startsWith('contours') ? (layer.contours ?? 1) : 0));
  layers.forEach((_, i) => {
    table.bottom.push(i);
    table.z.push(i + 0.5);
    table.top.push(i + 1);
  });
  return { head: { step_mm: 0.001, layers: layers.length, parts }, table, notes };
}

test('faults are told, the worst layers first', () => {
  const page = pageOf([{}, { open_chains: 2 }, { crossings: 5, open_chains: 1 }, { misoriented: 1 }, {}]);
  const told = findings(page);
  assert.deepEqual(told.slice(0, 3).map(({ tone, layer }) => [tone, layer]), [['bad', 1], ['bad', 2], ['bad', 3]]);
  assert.match(told[0].text, /^3 open contours in total, in 2 of 5 layers, the lowest at z = 1\.5 mm:/);
  assert.match(told[2].text, /^1 ring inside out in 1 of 5 layers, at z = 3\.5 mm:/);
  assert.deepEqual(worstLayers(page.table).map(({ layer }) => layer), [2, 1, 3]);
  assert.equal(verdict(page).text, '3 layers with faults');
  assert.equal(firstLayer(page), 2);
});

test('faults of every layer are told as the number in all of them', () => {
  const [twenty] = findings(pageOf(Array.from({ length: 10 }, () => ({ misoriented: 2 }))));
  assert.match(twenty.text, /^20 rings inside out in total, in all 10 layers, the lowest at z = 0\.5 mm:/);
  const [single] = findings(pageOf([{ crossings: 3 }]));
  assert.match(single.text, /^3 crossings in the only layer, at z = 0\.5 mm:/);
});

test('the address names a layer by the number that commands give it, or the nearest one', () => {
  const table = { index: [40, 41, 45, 60] };
  for (const [address, layer] of [['#layer=45', 2], ['#layer=47', 2], ['#layer=9999', 3], ['#layer=0', 0], ['#layer=', undefined], ['', undefined], ['#layer=x', undefined]])
    assert.equal(layerInAddress(table, address), layer, address);
});

test('gaps are told, the longest first', () => {
  const page = pageOf([
    { open_chains: 1, longest_gap_mm: 0.25, gaps_mm: 0.25 },
    {},
    { open_chains: 3, longest_gap_mm: 1.5, gaps_mm: 2 },
    { open_chains: 1 },
  ]);
  page.head.box = [[0, 0, 0], [1, 1, 4]];
  assert.deepEqual(widestGaps(page.table).map(({ layer }) => layer), [2, 0]);
  assert.equal(gapText(page.table, 0), '0.25 mm');
  assert.equal(gapText(page.table, 1), 'none');
  assert.equal(gapText(page.table, 2), 'the longest 1.5 mm, 3 gaps of 2 mm in all');
  assert.equal(faultText(page.table, 2), '3 open contours, the longest gap 1.5 mm');
  const told = findings(page).find(({ text }) => text.startsWith('The longest gap'));
  assert.equal(told.layer, 2);
  assert.match(told.text, /^The longest gap is 1\.5 mm, all together 2\.25 mm;/);
  assert.deepEqual(totals(page).find(([name]) => name === 'Gaps in all'), ['Gaps in all', '2.25 mm']);
  const sound = pageOf([{}, {}]);
  sound.head.box = page.head.box;
  assert.deepEqual(widestGaps(sound.table), []);
  assert.ok(!findings(sound).some(({ text }) => text.includes('gap')));
  assert.ok(!totals(sound).some(([name]) => /Gaps|dropped/.test(name)));
});

test('what steps made of the layers is told where there were any', () => {
  const page = pageOf([{ area_mm2: 5 }, { area_mm2: 7 }]);
  page.head.box = [[0, 0, 0], [3, 3, 2]];
  Object.assign(page.table, { rings_dropped: [0, 1200], area_before_mm2: [5, 8] });
  const told = new Map(totals(page));
  assert.equal(told.get('Rings dropped'), '1,200');
  assert.equal(told.get('Volume'), '12 mm³');
  assert.equal(told.get('Volume before'), '13 mm³');
});

test('thin layers have a thickness, and floats are told without their last digits', () => {
  const page = pageOf([{}, {}, {}]);
  page.head.box = [[0, 0, 0], [3, 3, 2]];
  const heightOf = (...bounds) => {
    page.table.bottom = bounds.slice(0, -1);
    page.table.top = bounds.slice(1);
    return totals(page)[1][1];
  };
  assert.equal(heightOf(0, 0.0125, 0.025, 0.0375), '0.0125 mm');
  assert.equal(heightOf(0, 1e-4, 2e-4, 3e-4), '0.0001 mm');
  assert.equal(heightOf(...[53.05, 53.1, 53.15, 53.2].map(Math.fround)), '0.05 mm');
  assert.equal(heightOf(0, 0.0125, 0.0625, 0.1), '0.0125 to 0.05 mm');
});

test('a sound stack is called sound, and thinning is said', () => {
  const page = pageOf([{ points: 100, shown: 100 }, { points: 100, shown: 20, tolerance_mm: 0.04 }]);
  assert.equal(verdict(page).tone, 'good');
  const told = findings(page);
  assert.equal(told[0].tone, 'good');
  assert.match(told.at(-1).text, /1 layer of 2 is drawn with fewer points, up to 0\.04 mm off \(120 of 200 points in all\)/);
  assert.equal(firstLayer(page), 1);
  const specks = pageOf([{ points: 100, shown: 20, contours: 12, contours_shown: 9, tolerance_mm: 0.04 }]);
  assert.match(findings(specks).at(-1).text, /\(20 of 100 points in all\), and 3 of 12 contours, all small, are not drawn;/);
  const flawed = pageOf([{}], { sections: [], places: [{ kind: 'boundary loop' }] });
  assert.equal(verdict(flawed).tone, 'warning');
});

test('only what differs stands out', () => {
  assert.deepEqual(remarkableLayers(pageOf([{ area_mm2: 5 }, { area_mm2: 5 }, { area_mm2: 5 }])), []);
  const told = remarkableLayers(pageOf([{ area_mm2: 5 }, { area_mm2: 9 }, { area_mm2: 8 }]));
  assert.deepEqual(told.map(({ layer }) => layer), [1, 1]);
});

/** A page of scan vectors alone. */
const scanPageOf = (layers, parameters = { speed_mm_s: 500, jump_speed_mm_s: 5000 }) =>
  pageOf(layers, undefined, [{ exposure: { part: 'a', region: 'core', kind: 'hatch', parameters } }]);

test('of scan vectors their time is told, and nothing of material', () => {
  const page = scanPageOf([
    { vectors: 100, build_seconds: 40, marked_mm: 900, energy_j: 500, hatches: 90, hatches_shown: 90 },
    { vectors: 300, build_seconds: 50, marked_mm: 100, energy_j: 500, hatches: 300, hatches_shown: 300, contours: 0 },
    { contours: 0 },
  ]);
  page.head.box = [[0, 0, 0], [3, 3, 2]];
  assert.deepEqual(verdict(page), { tone: 'plain', text: '400 vectors in 1 min 30 s' });
  assert.equal(layerText(page, 1), '300 vectors in 50 s');
  const told = new Map(totals(page));
  assert.deepEqual(['Time of the beam', 'Marked', 'Energy', 'Volume'].map((name) => told.get(name)), ['1 min 30 s', '1 m', '1 kJ', undefined]);
  assert.deepEqual(['Vectors', 'Hatch lines'].map((name) => told.get(name)), ['400', '390']);
  const texts = findings(page).map(({ text }) => text);
  assert.match(texts[0], /^No contour crosses itself/);
  assert.match(texts[1], /^1 layer with nothing in it, the lowest at z = 2\.5 mm/);
  assert.ok(!texts.some((text) => text.includes('does not tell')));
  const untold = findings(scanPageOf([{}], { speed_mm_s: 500, jump_speed_mm_s: 0 })).map(({ text }) => text);
  assert.ok(untold.includes('The file does not tell how fast the beam jumps: times are without jumps.'));
  assert.deepEqual(remarkableLayers(page).map(({ text }) => text), ['longest time, 50 s', 'most vectors, 300']);
});

test('times and energies that a file does not tell are left out', () => {
  const page = scanPageOf([{ vectors: 100, marked_mm: 900, jumped_mm: 5 }, { vectors: 1, marked_mm: 9 }], { speed_mm_s: 0, jump_speed_mm_s: 0 });
  page.head.box = [[0, 0, 0], [3, 3, 2]];
  assert.equal(verdict(page).text, '101 vectors');
  assert.equal(layerText(page, 1), '1 vector');
  assert.deepEqual(totals(page).map(([name]) => name).slice(4), ['Marked', 'Jumped', 'Vectors']);
  const told = (parameters) => findings(scanPageOf([{}], parameters)).map(({ text }) => text).filter((text) => text.startsWith('The file'));
  assert.deepEqual(told({ speed_mm_s: 0, jump_speed_mm_s: 0 }), ['The file tells no speeds of the beam, so times and energies are unknown.']);
  assert.equal(told({ speed_mm_s: 0, jump_speed_mm_s: 9 }).length, 1);
  assert.match(told({ speed_mm_s: 0, jump_speed_mm_s: 9 })[0], /not tell all speeds of the beam/);
});

test('hatch lines are counted, be there scan vectors, contours of material, or both', () => {
  const material = {};
  const [exposed] = scanPageOf([{}]).head.parts;
  for (const parts of [[exposed], [material], [material, exposed]]) {
    const page = pageOf([{ hatches: 3, vectors: 2 }, { hatches: 4 }], undefined, parts);
    page.head.box = [[0, 0, 0], [3, 3, 2]];
    assert.deepEqual(totals(page).filter(([name]) => /hatch/i.test(name)), [['Hatch lines', '7']]);
  }
  const bare = pageOf([{}]);
  bare.head.box = [[0, 0, 0], [3, 3, 2]];
  assert.ok(!totals(bare).some(([name]) => /hatch/i.test(name)));
});

test('which layers are without their hatches is said, and the page begins at another one', () => {
  const layers = Array.from({ length: 9 }, (_, i) => ({ hatches: 100, hatches_shown: i % 4 === 3 ? 100 : 0 }));
  const page = scanPageOf(layers);
  const told = findings(page).find(({ text }) => text.includes('hatches'));
  assert.match(told.text, /the hatches of 7 layers of 9 are left out \(200 of 900 lines are there\)/);
  assert.equal(told.layer, 0);
  assert.equal(firstLayer(page), 3);
});

/** A square of 10 mm with one open chain beside it. */
function squareLayer() {
  const points = new Float32Array([0, 0, 10, 0, 10, 10, 0, 10, 20, 0, 21, 0]);
  return { parts: [{ points, ends: new Uint32Array([4, 6]), rings: 1 }], insideOut: { rings: [new Set(), new Set()], deepest: 0 } };
}

test('walls stand on every line, with normals that point out of the material', () => {
  const walls = new Walls([{}]);
  walls.add(squareLayer(), 3, 0);
  assert.equal(walls.size, 5);
  assert.deepEqual([walls.layers, walls.counts], [[3], [5]]);
  const { rows } = walls;
  const floats = new Float32Array(rows.buffer, rows.byteOffset, rows.length);
  const vector = (number) => [(number << 16) >> 16, number >> 16];
  assert.deepEqual([...floats.subarray(0, 4)], [0, 0, 10, 0]);
  assert.deepEqual([...rows.subarray(6, 8)].map(vector), [[0, -32767], [0, -32767]]);
  const lines = [0, 1, 2, 3, 4].map((i) => [...rows.subarray(8 * i + 4, 8 * i + 6)]);
  assert.deepEqual(lines, [[3, 0], [3, 0], [3, 0], [3, 0], [3, lineKinds.fault]]);
});

test('only chains of material are faults', () => {
  const walls = new Walls([{}, { exposure: { region: 'core', kind: 'contour' } }]);
  const [square] = squareLayer().parts;
  walls.add({ ...squareLayer(), parts: [square, square] }, 0, 0);
  const kinds = Array.from({ length: 10 }, (_, i) => walls.rows[8 * i + 5]);
  const { ring, vectors, fault } = lineKinds;
  assert.deepEqual(kinds.map((number) => [number >> 2, number & 3]), [
    ...Array(4).fill([0, ring]), [0, fault],
    ...Array(4).fill([1, ring]), [1, vectors],
  ]);
});

test('walls of rings inside out are faults', () => {
  const walls = new Walls([{}]);
  walls.add({ ...squareLayer(), insideOut: { rings: [new Set([0])], deepest: 1 } }, 0, 0);
  assert.equal(walls.size, 5);
  for (let line = 0; line < 5; ++line) assert.equal(walls.rows[8 * line + 5], lineKinds.fault);
});

test('lines that turn by little have a normal in common', () => {
  const n = 36;
  const circle = Array.from({ length: n }, (_, i) => [Math.cos((2 * Math.PI * i) / n), Math.sin((2 * Math.PI * i) / n)]);
  const walls = new Walls([{}]);
  walls.add({ ...squareLayer(), parts: [{ points: new Float32Array(circle.flat()), ends: new Uint32Array([n]), rings: 1 }] }, 0, 0);
  for (let i = 0; i < n; ++i) {
    assert.equal(walls.rows[8 * i + 7], walls.rows[8 * ((i + 1) % n) + 6]);
    const [x, y] = [(walls.rows[8 * i + 6] << 16) >> 16, walls.rows[8 * i + 6] >> 16].map((c) => c / 32767);
    assert.ok(Math.hypot(x - circle[i][0], y - circle[i][1]) < 1e-3);
  }
});

test('walls of many layers stay as they were put up', () => {
  const walls = new Walls([{}]);
  for (let number = 0; number < 1000; ++number) walls.add(squareLayer(), number, 0);
  assert.equal(walls.size, 5000);
  assert.equal(walls.rows.length, 8 * 5 * linesOfRow);
  for (let line = 0; line < 5000; ++line) assert.equal(walls.rows[8 * line + 4], Math.floor(line / 5));
});

test('levels hold each layer once, and with those before they are evenly spaced', () => {
  for (const [count, stride] of [[1, 1], [1, 8], [7, 4], [100, 16], [557, 128]]) {
    const levels = levelsOf(count, stride);
    for (let k = 0; k < levels.length; ++k) {
      const step = stride / 2 ** k;
      const held = levels.slice(0, k + 1).flat().sort((a, b) => a - b);
      assert.deepEqual(held, Array.from({ length: Math.ceil(count / step) }, (_, i) => i * step), `${count}, ${stride}, ${k}`);
      assert.deepEqual(levels[k], [...levels[k]].sort((a, b) => a - b));
    }
    assert.equal(levels.flat().length, count);
  }
});

test('points are left out by their distance until enough are', () => {
  const n = 1000;
  const points = new Float32Array(2 * n);
  for (let i = 0; i < n; ++i) points.set([10 * Math.cos((2 * Math.PI * i) / n), 10 * Math.sin((2 * Math.PI * i) / n)], 2 * i);
  const layer = { ...squareLayer(), parts: [{ points, ends: new Uint32Array([n]), rings: 1 }] };
  assert.equal(spacingFor(layer, 1000, 0.01), 0);
  const apart = spacingFor(layer, 100, 0.01);
  assert.ok(apart > 0.3 && apart < 1.5, `${apart}`);
  const walls = new Walls([{}]);
  walls.add(layer, 0, apart);
  assert.ok(walls.size <= 100 && walls.size > 30);
});

test('a store tells those who listen, and of changes only', () => {
  const store = new Store({ a: 1, b: 2 });
  const heard = [];
  store.on(['a'], ({ a }) => heard.push(a));
  store.set({ b: 3 });
  store.set({ a: 1 });
  store.set({ a: 5, b: 4 });
  assert.deepEqual(heard, [1, 5]);
});

test('numbers read well', () => {
  assert.deepEqual([0, 0.05, 12.3456, 1234.56, 123456.7, 1e-5].map(brief), ['0', '0.05', '12.35', '1,235', '123,457', '0.00001']);
  assert.deepEqual([1e-6, 9e-7, -1e-16].map(brief), ['0.000001', '< 0.000001', '> −0.000001']);
  assert.deepEqual([4.8712, 59, 187, 3600, 7512].map(duration), ['4.871 s', '59 s', '3 min 07 s', '1 h 00 min', '2 h 05 min']);
  assert.deepEqual([53.1375, 0.1 + 0.2, 0.0125, 1e-4, 2e-8, -1e-16, 1234.5].map(mm), ['53.1375', '0.3', '0.0125', '0.0001', '0.00000002', '0', '1,234.5']);
  assert.deepEqual([0.05, 1e-5].map((pixel) => coordinate(1.23456789, pixel)), ['1.235', '1.23457']);
  assert.deepEqual(['19158.8 mm³', '115,343 mm²', '4 × 5 × 1234.56 mm', '12.5 mm', 'part 20231105.1'].map(withBriefMeasures), ['19,159 mm³', '115,343 mm²', '4 × 5 × 1,235 mm', '12.5 mm', 'part 20231105.1']);
  const table = { index: [1000, 1003, 2005] };
  assert.deepEqual([layerNumber(table, 1), layerNumbers(table), layerNumbers({ index: [] })], ['1003', '(1000 to 2005)', '']);
  assert.equal(counted(1, 'layer'), '1 layer');
  assert.equal(counted(1200, 'layer'), '1,200 layers');
});

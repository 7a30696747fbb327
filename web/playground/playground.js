// A page that slices: the package in one file, with the viewer of the program. Settings are in the address; files are not.

import { LamellaError, run, usePlatform } from '../package/api.js';
import { previewOn } from './preview.js';

// build_playground.mjs puts these texts into the page.
const textOf = (id) => document.getElementById(id).textContent;

async function wasmModule() {
  // It is at the end of the page, behind all that is seen.
  if (document.readyState === 'loading') await new Promise((resolve) => addEventListener('DOMContentLoaded', resolve, { once: true }));
  const packed = Uint8Array.from(atob(textOf('wasm')), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

usePlatform({
  processors: navigator.hardwareConcurrency || 1,
  shared: false, // a page from disk is not isolated
  loadModule: wasmModule,
  startWorker(module, onMessage, onFailure) {
    const address = URL.createObjectURL(new Blob([textOf('worker')], { type: 'text/javascript' }));
    const worker = new Worker(address);
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = (event) => onFailure(new Error(event.message));
    worker.postMessage({ module, shared: false });
    return { post: (message, transfer) => worker.postMessage(message, transfer), hold() {}, end: () => worker.terminate() };
  },
});

const bodies = ['rook', 'lattice', 'head', 'sole', 'sheet', 'calibration', 'dodecahedra', 'torus', 'sphere', 'cylinder', 'box'];
/** Options for bodies that are too large otherwise. */
const smaller = { sheet: { holes: 100, segments: 64 }, lattice: { cells: 3 }, head: { scale: 0.5 } };
const patience = 300; // ms without a picture, after which layers are shown one by one
const meshFormats = { cli: 'cli', 'cli-ascii': 'cli', svg: 'svg', slc: 'slc', '3mf': '3mf', dxf: 'dxf', geojson: 'geojson', json: 'json', npz: 'npz', 'png-zip': 'zip', sl1: 'sl1', sl1s: 'sl1s', html: 'html' };
const scanFormats = { ilt: 'ilt', ovf: 'ovf', '3mf-toolpath': '3mf', cli: 'cli', svg: 'svg', dxf: 'dxf', json: 'json', npz: 'npz', html: 'html' };

const $ = (id) => document.getElementById(id);
const form = $('settings');
let input = null; // {files: bytes by name, mesh: whether they are meshes}
let pages = {}; // addresses of the pages of layers and mesh
let abort = null; // of the call in progress
let turn = 0; // of the last slicing: an older one shows nothing

const rememberedTheme = () => {
  try {
    return localStorage.getItem('lamella-theme');
  } catch {
    return null;
  }
};
const dark = matchMedia('(prefers-color-scheme: dark)');
const applyTheme = () => (document.documentElement.dataset.theme = rememberedTheme() ?? (dark.matches ? 'dark' : 'light'));
applyTheme();
dark.addEventListener('change', applyTheme);
addEventListener('storage', applyTheme);

// ---- Settings ---------------------------------------------------------------------------------------------------------

const fields = () => [...form.elements].filter((field) => field.name);
const options = () => Object.fromEntries(fields().map((field) => [field.name, field.type === 'checkbox' ? field.checked : field.value]).filter(([, value]) => value !== '' && value !== false));

function keepSettings() {
  const kept = new URLSearchParams(options());
  if (bodies.includes($('body').value)) kept.set('body', $('body').value);
  try {
    history.replaceState(null, '', `#${kept}`);
  } catch {
    // Some browsers allow it to no page from disk.
  }
}

function takeSettings() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const field of fields()) {
    if (!given.has(field.name)) continue;
    if (field.type === 'checkbox') field.checked = true;
    else field.value = given.get(field.name);
    field.closest('details')?.setAttribute('open', '');
  }
  return given.get('body');
}

const kebab = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
const words = (given) => Object.entries(given).flatMap(([name, value]) => (value === true ? [`--${kebab(name)}`] : [`--${kebab(name)}=${value}`]));

/** Of an input of layers only the steps are of use. */
const stepNames = ['fill', 'offset', 'minArea'];
const onlyOf = (given, names) => Object.fromEntries(Object.entries(given).filter(([name]) => names.includes(name)));

// ---- What the page shows ----------------------------------------------------------------------------------------------

const deeds = { read: 'Reading', weld: 'Joining vertices', link: 'Linking triangles', slice: 'Slicing', polygon: 'Changing layers', write: 'Writing' };

function showProgress({ stage, done, total }) {
  $('bar').hidden = false;
  $('bar').value = total > 0 ? done / total : 0;
  $('status').textContent = `${deeds[stage] ?? stage} …`;
}

function showWarnings(warnings) {
  $('warnings').replaceChildren(...warnings.map((warning) => Object.assign(document.createElement('li'), { textContent: warning })));
}

function showTimes(rows) {
  $('times').replaceChildren(
    ...rows.flatMap(([name, text]) => [Object.assign(document.createElement('dt'), { textContent: name }), Object.assign(document.createElement('dd'), { textContent: text })]),
  );
}

function reveal(shown) {
  for (const id of ['viewer', 'preview', 'nothing']) $(id).hidden = id !== shown;
  // On a phone the layers are below the settings.
  if (shown !== 'nothing' && matchMedia('(max-width: 800px)').matches) $(shown).scrollIntoView({ behavior: 'smooth' });
}

function showPage(name) {
  for (const button of $('views').children) button.setAttribute('aria-pressed', String(button.dataset.view === name));
  $('viewer').title = name === 'mesh' ? 'The mesh and its defects' : 'Layers';
  $('viewer').src = pages[name];
  reveal('viewer');
}

function keepPage(name, bytes) {
  if (pages[name]) URL.revokeObjectURL(pages[name]);
  pages[name] = URL.createObjectURL(new Blob([bytes], { type: 'text/html' }));
}

/** Runs a call that can be cancelled, and shows how it fails. */
async function attempt(act) {
  abort?.abort();
  const mine = (abort = new AbortController());
  const number = ++turn;
  $('error').textContent = '';
  $('cancel').hidden = false;
  try {
    await act({ signal: mine.signal, onProgress: showProgress });
  } catch (error) {
    if (number !== turn) return;
    if (!$('preview').hidden) reveal(pages.layers ? 'viewer' : 'nothing');
    if (mine.signal.aborted) {
      $('status').textContent = 'Cancelled.';
    } else {
      $('status').textContent = '';
      $('error').textContent = error instanceof LamellaError ? error.message : `${error}`;
      $('error').scrollIntoView({ block: 'nearest' });
    }
  } finally {
    if (number === turn) {
      $('bar').hidden = true;
      $('cancel').hidden = true;
    }
  }
}

const seconds = (value) => `${value < 10 ? value.toFixed(2) : value.toFixed(1)} s`;
const grouped = (value) => value.toLocaleString('en');

function fillFormats() {
  const of = options().scan ? scanFormats : meshFormats;
  const before = $('format').value;
  $('format').replaceChildren(...Object.keys(of).map((name) => new Option(name, name)));
  if (of[before]) $('format').value = before;
}

const nameOf = ({ files }) => Object.keys(files).join(', ');
const sizeOf = (bytes) => (bytes < 1e5 ? `${grouped(bytes)} bytes` : `${(bytes / 1e6).toLocaleString('en', { maximumFractionDigits: 2 })} MB`);

/** Runs a command on the input, with the texts of the page for its progress. */
const runOn = ({ files }, command, calls) => run([...command, '--progress=json'], files, calls);

/** The command that writes layers of the input. */
const writing = ({ files, mesh }, given, ...more) => {
  const names = Object.keys(files);
  return mesh ? ['slice', ...words(given), ...names, ...more] : ['convert', ...words(onlyOf(given, stepNames)), ...names, ...more];
};

async function sliceInput(calls) {
  const begun = performance.now();
  let shownAfter = null; // s, until layers were seen
  const seeLayers = () => (shownAfter ??= (performance.now() - begun) / 1000);
  const given = options();
  pages.mesh = undefined;
  const preview = previewOn($('preview'), () => (reveal('preview'), seeLayers()));
  const chunks = []; // of layers that come before anybody waits for them
  const isLate = () => performance.now() - begun > patience;
  const onOutput = (bytes) => {
    chunks.push(bytes);
    if (isLate()) chunks.splice(0).forEach(preview);
  };
  const slicing = writing({ ...input, mesh: true }, given, '-o', '-', '--format', 'cli', '--report', 'page.html', '--stats', 'figures.json');
  const shown = input;
  let result;
  if (shown.mesh !== false) {
    try {
      result = await runOn(shown, slicing, { ...calls, onOutput });
      shown.mesh = true;
    } catch (error) {
      if (calls.signal.aborted || !(await holdsLayers(shown, calls))) throw error;
      shown.mesh = false;
    }
  }
  if (!shown.mesh) result = await runOn(shown, ['view', ...Object.keys(shown.files), ...words(onlyOf(given, stepNames)), '-o', 'page.html'], calls);
  $('viewer').addEventListener('load', () => seeLayers(), { once: true });
  keepPage('layers', result.files['page.html']);
  showPage('layers');
  fillFormats();
  $('results').hidden = false;
  $('views').hidden = !shown.mesh || Object.keys(shown.files).length > 1;
  const rows = [];
  const warnings = [...result.warnings];
  if (shown.mesh) {
    const figures = JSON.parse(new TextDecoder().decode(result.files['figures.json']));
    describe(shown, figures);
    warnings.push(...overlaps(shown, figures.parts));
    rows.push(['layers', grouped(figures.layers.length)], ['contours', grouped(figures.contours)], ['points', grouped(figures.points)]);
    for (const stage of ['read', 'weld', 'link', 'slice', 'write']) if (figures.seconds[stage] > 0) rows.push([deeds[stage].toLowerCase(), seconds(figures.seconds[stage])]);
  }
  showWarnings(warnings);
  if (shownAfter !== null) rows.push(['until layers were seen', seconds(shownAfter)]);
  rows.push(['until all was done', seconds((performance.now() - begun) / 1000)]);
  showTimes(rows);
  $('status').textContent = shown.mesh ? 'Sliced.' : 'Read.';
}

/** Whether a file that cannot be sliced holds layers. */
async function holdsLayers({ files }, calls) {
  const [name, ...others] = Object.keys(files);
  if (others.length > 0) return false;
  try {
    return JSON.parse((await run(['read', name], files, { signal: calls.signal })).text).kind === 'layers';
  } catch {
    return false; // it can be read in no way
  }
}

function describe(shown, { input: { triangles, bbox } }) {
  const size = bbox[1].map((high, axis) => (high - bbox[0][axis]).toLocaleString('en', { maximumFractionDigits: 2 })).join(' × ');
  $('input').textContent = `${nameOf(shown)}: ${grouped(triangles)} triangles, ${size} mm`;
}

/** Files of one plate keep their positions, which may not have been meant for each other. */
function overlaps({ files }, parts = []) {
  const inside = (a, b) => [0, 1, 2].every((axis) => a.bbox[0][axis] < b.bbox[1][axis] && b.bbox[0][axis] < a.bbox[1][axis]);
  const pairs = parts.flatMap((one, i) => parts.slice(i + 1).filter((other) => inside(one, other)).map((other) => `${one.label} and ${other.label}`));
  if (pairs.length === 0 || Object.keys(files).length === 1) return [];
  const more = pairs.length > 1 ? ` (and ${pairs.length - 1} pairs more)` : '';
  return [`the boxes of ${pairs[0]}${more} overlap: each file keeps its own position; to place parts, use lamella slice with --translate behind each file`];
}

async function take(load) {
  await attempt(async (calls) => {
    $('status').textContent = 'Reading …';
    showWarnings([]);
    showTimes([]);
    $('results').hidden = true;
    $('slice').disabled = true;
    $('input').textContent = '';
    input = null;
    pages = {};
    reveal('nothing');
    const files = await load(calls);
    input = { files };
    $('slice').disabled = false;
    $('input').textContent = `${nameOf(input)}: ${sizeOf(Object.values(files).reduce((sum, { length }) => sum + length, 0))}`;
    await sliceInput(calls);
  });
}

async function takeFiles(list) {
  $('body').value = '';
  keepSettings();
  await take(async () => {
    const files = {};
    for (const file of list) files[unusedName(file.name, files)] = new Uint8Array(await file.arrayBuffer());
    return files;
  });
}

function unusedName(name, files) {
  for (let number = 1; ; ++number) {
    const unused = number === 1 ? name : name.replace(/(\.[^.]*)?$/, ` ${number}$1`);
    if (files[unused] === undefined) return unused;
  }
}

const takeBody = (body) =>
  take(async (calls) => (await run(['make', body, '-o', `${body}.stl`, ...words(smaller[body] ?? {})], {}, calls)).files);

async function showMesh() {
  if (pages.mesh) return showPage('mesh');
  await attempt(async (calls) => {
    const unit = options().unit;
    const { files, warnings } = await runOn(input, ['info', ...Object.keys(input.files), ...(unit ? [`--unit=${unit}`] : []), '--report', 'mesh.html'], calls);
    keepPage('mesh', files['mesh.html']);
    showPage('mesh');
    showWarnings(warnings);
    $('status').textContent = 'The mesh with its shells and defects.';
  });
}

async function download() {
  await attempt(async (calls) => {
    const format = $('format').value;
    const extension = { ...meshFormats, ...scanFormats }[format];
    const [first] = Object.keys(input.files);
    const name = `${first.replace(/\.[^.]*$/, '')}.${extension}`;
    const output = `output.${extension}`;
    const call = writing(input, options(), ...(input.mesh ? ['-o', output] : [output]), '--format', format);
    const { files, warnings } = await runOn(input, call, calls);
    showWarnings(warnings);
    const address = URL.createObjectURL(new Blob([files[output]]));
    Object.assign(document.createElement('a'), { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
    $('status').textContent = `${name}: ${sizeOf(files[output].length)}.`;
  });
}

// ---- What people do ---------------------------------------------------------------------------------------------------

$('body').append(...bodies.map((body) => new Option(body, body)));
$('file').addEventListener('change', ({ target }) => target.files.length > 0 && takeFiles(target.files));
$('body').addEventListener('change', ({ target }) => {
  keepSettings();
  if (target.value) takeBody(target.value);
});
form.addEventListener('submit', (event) => {
  event.preventDefault();
  keepSettings();
  if (input) attempt(sliceInput);
});
form.addEventListener('change', ({ target }) => {
  if (!target.name) return;
  keepSettings();
  if (input && form.checkValidity()) attempt(sliceInput);
});
$('cancel').addEventListener('click', () => abort?.abort());
$('download').addEventListener('click', download);
$('views').addEventListener('click', ({ target }) => {
  if (target.dataset.view === 'layers') showPage('layers');
  else if (target.dataset.view === 'mesh') showMesh();
});
for (const [kind, over] of [['dragover', true], ['dragleave', false], ['drop', false]])
  addEventListener(kind, (event) => {
    event.preventDefault();
    document.body.classList.toggle('over', over);
    if (kind === 'drop' && event.dataTransfer.files.length > 0) takeFiles(event.dataTransfer.files);
  });

const body = takeSettings();
if (bodies.includes(body)) {
  $('body').value = body;
  takeBody(body);
} else {
  // The program is compiled while people look for a file. The page has been painted by then.
  addEventListener('load', () => setTimeout(() => run(['--version']).catch(() => {}), 50), { once: true });
}

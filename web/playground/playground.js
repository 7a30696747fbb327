// A page that slices: the package in one file, with the viewer of the program. Settings are in the address; files are not.

import { LamellaError, Mesh, makeBody, readFile, run, usePlatform } from '../package/api.js';

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
  workers: navigator.hardwareConcurrency || 1,
  loadModule: wasmModule,
  startWorker(module, onMessage, onFailure) {
    const address = URL.createObjectURL(new Blob([textOf('worker')], { type: 'text/javascript' }));
    const worker = new Worker(address);
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = (event) => onFailure(new Error(event.message));
    worker.postMessage({ module });
    return { post: (message, transfer) => worker.postMessage(message, transfer), hold() {}, end: () => worker.terminate() };
  },
});

const bodies = ['rook', 'lattice', 'head', 'sole', 'sheet', 'calibration', 'dodecahedra', 'torus', 'sphere', 'cylinder', 'box'];
/** Options for bodies that are too large otherwise. */
const smaller = { sheet: { holes: 100, segments: 64 }, lattice: { cells: 3 }, head: { scale: 0.5 } };
const meshFormats = { cli: 'cli', 'cli-ascii': 'cli', svg: 'svg', slc: 'slc', '3mf': '3mf', dxf: 'dxf', geojson: 'geojson', json: 'json', npz: 'npz', 'png-zip': 'zip', sl1: 'sl1', sl1s: 'sl1s', html: 'html' };
const scanFormats = { ilt: 'ilt', ovf: 'ovf', '3mf-toolpath': '3mf', cli: 'cli', svg: 'svg', dxf: 'dxf', json: 'json', npz: 'npz', html: 'html' };

const $ = (id) => document.getElementById(id);
const form = $('settings');
let input = null; // Mesh or Stack with a name
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

function showPage(name) {
  for (const button of $('views').children) button.setAttribute('aria-pressed', String(button.dataset.view === name));
  $('viewer').title = name === 'mesh' ? 'The mesh and its defects' : 'Layers';
  $('viewer').src = pages[name];
  const first = $('viewer').hidden;
  $('viewer').hidden = false;
  $('nothing').hidden = true;
  // On a phone the layers are below the settings.
  if (first && matchMedia('(max-width: 800px)').matches) $('viewer').scrollIntoView({ behavior: 'smooth' });
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
    if (mine.signal.aborted) {
      $('status').textContent = 'Cancelled.';
    } else {
      $('status').textContent = '';
      $('error').textContent = error instanceof LamellaError ? error.message : `${error}`;
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

async function sliceInput(calls) {
  const begun = performance.now();
  const given = options();
  const mesh = input instanceof Mesh;
  pages.mesh = undefined;
  const files = { [input.name]: input.bytes };
  const call = mesh
    ? ['slice', ...words(given), input.name, '--report', 'page.html', '--stats', 'figures.json', '--progress=json']
    : ['view', input.name, ...words(onlyOf(given, stepNames)), '-o', 'page.html', '--progress=json'];
  // A first impression, while thousands of layers are on their way.
  if (mesh && input.triangles > 300000 && !given.scan) await firstImpression(files, given, calls);
  const result = await run(call, files, calls);
  keepPage('layers', result.files['page.html']);
  showPage('layers');
  fillFormats();
  $('results').hidden = false;
  $('views').hidden = !mesh;
  showWarnings([...(input.warnings ?? []), ...result.warnings.filter((text) => !(input.warnings ?? []).includes(text))]);
  const rows = [];
  if (mesh) {
    const figures = JSON.parse(new TextDecoder().decode(result.files['figures.json']));
    rows.push(['layers', grouped(figures.layers.length)], ['contours', grouped(figures.contours)], ['points', grouped(figures.points)]);
    for (const stage of ['read', 'weld', 'link', 'slice', 'write']) if (figures.seconds[stage] > 0) rows.push([deeds[stage].toLowerCase(), seconds(figures.seconds[stage])]);
  }
  rows.push(['from start to picture', seconds((performance.now() - begun) / 1000)]);
  showTimes(rows);
  $('status').textContent = mesh ? 'Sliced.' : 'Read.';
}

async function firstImpression(files, given, calls) {
  const [low, high] = input.box.map(([, , z]) => z);
  const { layerHeight, scan, ...rest } = given;
  const coarse = (high - low) / 24;
  if (!(coarse > 4 * layerHeight)) return;
  try {
    const { files: written } = await run(['slice', ...words({ ...rest, layerHeight: coarse }), input.name, '--report', 'page.html', '--progress=json'], files, calls);
    keepPage('layers', written['page.html']);
    showPage('layers');
    $('status').textContent = 'A first impression in few layers; all of them follow.';
  } catch (error) {
    if (calls.signal.aborted) throw error; // whatever else is wrong, the full call says it better
  }
}

async function take(load) {
  await attempt(async (calls) => {
    $('status').textContent = 'Reading …';
    showWarnings([]);
    showTimes([]);
    input = null;
    $('slice').disabled = true;
    const read = await load(calls);
    input = read;
    $('slice').disabled = false;
    $('input').textContent =
      read instanceof Mesh
        ? `${read.name}: ${grouped(read.triangles)} triangles, ${read.box[1].map((high, i) => (high - read.box[0][i]).toLocaleString('en', { maximumFractionDigits: 2 })).join(' × ')} mm`
        : `${read.name}: ${grouped(read.layers.length)} layers`;
    await sliceInput(calls);
  });
}

async function takeFile(file) {
  $('body').value = '';
  keepSettings();
  await take(async (calls) => {
    const bytes = new Uint8Array(await file.arrayBuffer());
    const unit = options().unit;
    const read = await readFile(bytes, file.name, { ...calls, ...(unit ? { unit } : {}) });
    return read instanceof Mesh ? read : { name: file.name, bytes, layers: read.layers, warnings: read.warnings };
  });
}

const takeBody = (body) => take((calls) => makeBody(body, { ...smaller[body], signal: calls.signal }));

async function showMesh() {
  if (pages.mesh) return showPage('mesh');
  await attempt(async (calls) => {
    const unit = options().unit;
    const { files } = await run(['info', input.name, ...(unit ? [`--unit=${unit}`] : []), '--report', 'mesh.html', '--progress=json'], { [input.name]: input.bytes }, calls);
    keepPage('mesh', files['mesh.html']);
    showPage('mesh');
    $('status').textContent = 'The mesh with its shells and defects.';
  });
}

async function download() {
  await attempt(async (calls) => {
    const format = $('format').value;
    const given = options();
    const extension = { ...meshFormats, ...scanFormats }[format];
    const name = `${input.name.replace(/\.[^.]*$/, '')}.${extension}`;
    const output = `output.${extension}`;
    const mesh = input instanceof Mesh;
    const call = mesh
      ? ['slice', ...words(given), input.name, '-o', output, '--format', format, '--progress=json']
      : ['convert', input.name, output, '--format', format, ...words(onlyOf(given, stepNames)), '--progress=json'];
    const { files, warnings } = await run(call, { [input.name]: input.bytes }, calls);
    showWarnings(warnings);
    const address = URL.createObjectURL(new Blob([files[output]]));
    Object.assign(document.createElement('a'), { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
    $('status').textContent = `${name}: ${(files[output].length / 1e6).toLocaleString('en', { maximumFractionDigits: 2 })} MB.`;
  });
}

// ---- What people do ---------------------------------------------------------------------------------------------------

$('body').append(...bodies.map((body) => new Option(body, body)));
$('file').addEventListener('change', ({ target }) => target.files[0] && takeFile(target.files[0]));
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
    if (kind === 'drop' && event.dataTransfer.files[0]) takeFile(event.dataTransfer.files[0]);
  });

const body = takeSettings();
if (bodies.includes(body)) {
  $('body').value = body;
  takeBody(body);
}

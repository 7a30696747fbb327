// A page that slices: the package in one file, with the viewer of the program. Settings are in the address; files are not.

import { LamellaError, run, usePlatform } from '../package/api.js';
import { previewOn } from './preview.js';
import { check, enter, entered, goTo, labelOf, onlyImages, onlySteps, options as optionsWith, withoutCheck, withoutImages, words } from './settings.js';
import { commandText, inWordsOfPage, warningsOfPage } from './texts.js';
import { ViewerFrame } from './viewer_frame.js';

// build_playground.mjs puts these texts into the page.
const textOf = (id) => document.getElementById(id).textContent;

async function wasmModule() {
  // It is at the end of the page, behind all that is seen.
  if (document.readyState === 'loading') await new Promise((resolve) => addEventListener('DOMContentLoaded', resolve, { once: true }));
  const text = atob(textOf('wasm'));
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
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

/** The name of the format that the chosen printer reads, in the list of formats. */
const ofPrinter = 'of the printer';
const imageFormats = [ofPrinter, 'png-zip', 'sl1', 'sl1s'];
/** Whose bytes come one after the other and do not depend on the name. */
const streamedFormats = ['cli', 'cli-ascii', 'svg', 'slc', 'dxf', 'geojson', 'json'];
const blobBytes = 64 << 20; // of chunks that become one
const $ = (id) => document.getElementById(id);
const form = $('settings');
let input = null; // {files: bytes by name, mesh: whether they are meshes}
let strategy = null; // {name, text} of a file
let pages = {}; // addresses of the pages of layers and mesh
let abort = null; // of the call in progress
let turn = 0; // of the last slicing: an older one shows nothing
let meshIsWanted = false; // rather than layers
let done = false; // what is seen is of the settings

const strategyFile = 'strategy.toml';
const options = () => optionsWith(strategy ? strategyFile : undefined);

// ---- Dark and light ---------------------------------------------------------------------------------------------------

const storage = (act) => {
  try {
    return act();
  } catch {
    return null; // it is refused to some pages opened from disk
  }
};
let chosenTheme = storage(() => localStorage.getItem('lamella-theme')); // in the viewer, now or before
const dark = matchMedia('(prefers-color-scheme: dark)');
const theme = () => chosenTheme ?? (dark.matches ? 'dark' : 'light');
const viewer = new ViewerFrame($('viewer'), {
  theme(name) {
    chosenTheme = name;
    storage(() => localStorage.setItem('lamella-theme', name));
    applyTheme();
  },
  drag: (over) => document.body.classList.toggle('over', over),
  files: (files) => takeFiles(files),
});
function applyTheme() {
  document.documentElement.dataset.theme = viewer.theme = theme();
}
applyTheme();
dark.addEventListener('change', applyTheme);

// ---- The address ------------------------------------------------------------------------------------------------------

function keepSettings() {
  const kept = new URLSearchParams(entered());
  if (bodies.includes($('body').value)) kept.set('body', $('body').value);
  storage(() => history.replaceState(null, '', `#${kept}`));
}

/** Takes settings from the address. Returns the test body that it names. */
function takeSettings() {
  const given = new URLSearchParams(location.hash.slice(1));
  enter(given);
  const body = given.get('body');
  return bodies.includes(body) ? body : '';
}

function link() {
  const kept = new URLSearchParams(entered());
  if (bodies.includes($('body').value)) kept.set('body', $('body').value);
  return `${location.href.replace(/#.*/, '')}#${kept}`;
}

// ---- What the page shows ----------------------------------------------------------------------------------------------

const deeds = { read: 'Reading', weld: 'Joining vertices', link: 'Linking triangles', slice: 'Slicing', polygon: 'Changing layers', scan: 'Making scan vectors', write: 'Writing' };
const named = (tag, textContent) => Object.assign(document.createElement(tag), { textContent });

function showProgress({ stage, done: ready, total }) {
  $('bar').hidden = false;
  // What still takes time at the end of the last stage is not counted.
  if (total > 0 && ready < total) $('bar').value = ready / total;
  else $('bar').removeAttribute('value');
  $('status').textContent = `${deeds[stage] ?? 'Working'} …`;
}

const showWarnings = (warnings, output) => $('warnings').replaceChildren(...warningsOfPage(warnings, output).map((warning) => named('li', warning)));
const showTimes = (rows) => $('times').replaceChildren(...rows.flatMap(([name, text]) => [named('dt', name), named('dd', text)]));

/** Shows one of what covers the place of the layers. */
function reveal(shown) {
  for (const id of ['viewer', 'preview', 'nothing']) $(id).hidden = id !== shown;
}

/** On a phone, settings and layers take turns. */
function showPane(name) {
  document.querySelector('main').dataset.pane = name;
  for (const button of $('panes').children) button.setAttribute('aria-pressed', String(button.dataset.pane === name));
}

async function showPage(name) {
  const isSeen = await viewer.show(pages[name], name, name === 'mesh' ? 'The mesh and its defects' : 'Layers');
  if (!isSeen) return false;
  for (const button of $('views').children) button.setAttribute('aria-pressed', String(button.dataset.view === name));
  reveal('viewer');
  return true;
}

function forgetPage(name) {
  if (pages[name]) URL.revokeObjectURL(pages[name]);
  delete pages[name];
}

function keepPage(name, bytes) {
  forgetPage(name);
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
    await act({ signal: mine.signal, onProgress: (progress) => number === turn && showProgress(progress) });
  } catch (error) {
    if (number !== turn) return;
    if (!$('preview').hidden) reveal(pages.layers ? 'viewer' : 'nothing');
    if (mine.signal.aborted) {
      $('status').textContent = 'Cancelled.';
    } else {
      $('status').textContent = '';
      $('error').textContent = error instanceof LamellaError ? inWordsOfPage(error.message) : `${error}`;
      showPane('settings');
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
  const printer = options().scan ? undefined : printerNamed(form.elements.printer.value);
  const of = { ...(printer ? { [ofPrinter]: printer.extension.slice(1) } : {}), ...(options().scan ? scanFormats : meshFormats) };
  const before = $('format').value;
  $('format').replaceChildren(...Object.keys(of).map((name) => new Option(name === ofPrinter ? `${printer.extension} for ${printer.name}` : name, name)));
  if (of[before]) $('format').value = before;
}

// ---- Resin printers ---------------------------------------------------------------------------------------------------

let printers = []; // {name, extension, pixels, display_mm, height_mm, facts}

/** Lists the printers that the program knows. */
async function listPrinters() {
  const { text } = await run(['printers', '--json']);
  const factsOf = ({ pixels, display_mm, height_mm }) => `${pixels.join(' × ')} pixels, ${[...display_mm, height_mm].join(' × ')} mm`;
  printers = JSON.parse(text).map((printer) => ({ ...printer, facts: factsOf(printer) }));
  $('printers').replaceChildren(...printers.map(({ name, facts }) => Object.assign(new Option(name, name), { label: facts })));
  showPrinter();
}

/** The printer of this name, or the only one that has the word in its name, as the program finds it. */
function printerNamed(word) {
  const wanted = word.trim().toLowerCase();
  const having = wanted ? printers.filter(({ name }) => name.toLowerCase().includes(wanted)) : [];
  return having.find(({ name }) => name.toLowerCase() === wanted) ?? (having.length === 1 ? having[0] : undefined);
}

/** Says which printer is chosen, or how many have the word in their names. */
function showPrinter() {
  const word = form.elements.printer.value.trim();
  const found = printerNamed(word);
  const having = printers.filter(({ name }) => name.toLowerCase().includes(word.toLowerCase()));
  const several = having.length > 1 ? `${having.length} printers: ${having.slice(0, 4).map(({ name }) => name).join(', ')}${having.length > 4 ? ' …' : ''}` : 'No printer has this word in its name.';
  if (word && printers.length > 0) $('printerFacts').textContent = found ? `${found.name}: ${found.facts}; files ${found.extension}` : several;
  else $('printerFacts').textContent = 'Type a word, such as a maker, to search. The printer determines format and display.';
  const before = $('format').value;
  fillFormats();
  if (found && before !== ofPrinter) $('format').value = ofPrinter;
}

/** Shows what the check of the print found; the page of the layers marks it. */
function showPrintCheck(found) {
  $('printCheck').hidden = !found;
  if (!found) return;
  const { findings } = found;
  $('printCheck').classList.toggle('ok', findings.length === 0);
  $('checkVerdict').textContent = findings.length === 0 ? 'The check of the print found nothing.' : 'The check of the print found:';
  $('checkFindings').replaceChildren(...findings.map((text) => named('li', text)));
  $('checkMarks').hidden = found.list_of_islands.length + found.list_of_cavities.length === 0;
}

const nameOf = ({ files }) => Object.keys(files).join(', ');
const sizeOf = (bytes) => (bytes < 1e5 ? `${grouped(bytes)} bytes` : `${(bytes / 1e6).toLocaleString('en', { maximumFractionDigits: 2 })} MB`);

// ---- Runs of the program ----------------------------------------------------------------------------------------------

/** Runs a command on the input, with the texts of the page for its progress. */
const runOn = ({ files }, command, calls) => run([...command, '--progress=json'], strategy ? { ...files, [strategyFile]: strategy.text } : files, calls);

/** The command that writes layers of the input. */
const writing = ({ files, mesh }, given, ...more) => {
  const names = Object.keys(files);
  return mesh ? ['slice', ...words(given), ...names, ...more] : ['convert', ...words(onlySteps(given)), ...names, ...more];
};

/** Name of a download, and the command that writes it to a path. */
function writingDownload(path) {
  const format = $('format').value;
  const printer = format === ofPrinter ? printerNamed(form.elements.printer.value) : undefined;
  const { printer: _, ...ofImages } = onlyImages(options());
  const images = printer ? { ...ofImages, printer: printer.name } : ofImages;
  const given = { ...withoutCheck(withoutImages(options())), ...(imageFormats.includes(format) ? images : {}) };
  const ofLayers = input.mesh ? [] : words(onlyImages(given));
  const [first] = Object.keys(input.files);
  const name = `${first.replace(/\.[^.]*$/, '')}.${printer ? printer.extension.slice(1) : { ...meshFormats, ...scanFormats }[format]}`;
  const output = path(name);
  return { name, output, command: writing(input, given, ...ofLayers, ...(input.mesh ? ['-o', output] : [output]), ...(printer ? [] : ['--format', format])) };
}

/** Shows the command that does the same in a terminal. */
function tellCommand() {
  if (!input || $('results').hidden) return;
  const { command } = writingDownload((name) => name);
  const body = $('body').value;
  const making = body ? [commandText(['make', body, '-o', `${body}.stl`, ...words(smaller[body] ?? {})])] : [];
  const taken = command.map((word) => (word === `--strategy=${strategyFile}` ? `--strategy=${strategy.name}` : word));
  $('command').textContent = [...making, commandText(taken)].join('\n');
}

async function sliceInput(calls) {
  const begun = performance.now();
  let shownAfter = null; // s, until layers were seen
  const seeLayers = () => (shownAfter ??= (performance.now() - begun) / 1000);
  const given = withoutImages(options());
  forgetPage('mesh');
  const preview = previewOn($('preview'), () => (reveal('preview'), seeLayers()));
  const chunks = []; // of layers that come before anybody waits for them
  const isLate = () => performance.now() - begun > patience;
  const onOutput = (bytes) => {
    if (calls.signal.aborted) return;
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
  if (!shown.mesh) result = await runOn(shown, ['view', ...Object.keys(shown.files), ...words(onlySteps(given)), '-o', 'page.html'], calls);
  keepPage('layers', result.files['page.html']);
  $('status').textContent = 'Showing …';
  if (!(await showPage('layers')) || calls.signal.aborted) return;
  seeLayers();
  showFigures(shown, result, [
    ...(shownAfter !== null ? [['until layers were seen', seconds(shownAfter)]] : []),
    ['until all was done', seconds((performance.now() - begun) / 1000)],
  ]);
}

function showFigures(shown, result, times) {
  const rows = [];
  const warnings = [...result.warnings];
  if (shown.mesh) {
    const figures = JSON.parse(new TextDecoder().decode(result.files['figures.json']));
    describe(shown, figures);
    warnings.push(...overlaps(shown, figures.parts));
    showPrintCheck(figures.check);
    rows.push(['layers', grouped(figures.layers.length)], ['contours', grouped(figures.contours)], ['points', grouped(figures.points)]);
    for (const stage of ['read', 'weld', 'link', 'slice', 'write']) if (figures.seconds[stage] > 0) rows.push([deeds[stage].toLowerCase(), seconds(figures.seconds[stage])]);
  }
  fillFormats();
  $('results').hidden = false;
  $('views').hidden = !shown.mesh || Object.keys(shown.files).length > 1;
  tellCommand();
  showWarnings(warnings);
  showTimes([...rows, ...times]);
  done = true;
  $('status').textContent = shown.mesh ? 'Sliced.' : 'Read.';
}

/** Slices, if all that was entered is valid. */
function sliceIfValid() {
  const faults = check();
  if (faults.length > 0) {
    abort?.abort();
    turn += 1;
    $('bar').hidden = $('cancel').hidden = true;
    const [{ field, text }] = faults;
    $('error').textContent = `Not sliced: “${labelOf(field)}”: ${text}${faults.length > 1 ? `; ${faults.length - 1} more below` : ''}.`;
    $('status').textContent = done ? 'The layers shown are those of the settings before.' : '';
    return faults;
  }
  done = false;
  if (input) attempt(sliceInput);
  else $('error').textContent = '';
  return faults;
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
  if (Object.keys(files).length === 1) return [];
  const inside = (a, b) => [0, 1, 2].every((axis) => a.bbox[0][axis] < b.bbox[1][axis] && b.bbox[0][axis] < a.bbox[1][axis]);
  let pairs = 0;
  let first;
  parts.forEach((one, i) => {
    for (let k = i + 1; k < parts.length; ++k) if (inside(one, parts[k])) first = pairs++ === 0 ? `${one.label} and ${parts[k].label}` : first;
  });
  if (pairs === 0) return [];
  const more = pairs > 1 ? ` (and ${grouped(pairs - 1)} more pairs)` : '';
  return [`the boxes of ${first}${more} overlap: each file keeps its own coordinates, because the page does not move parts`];
}

async function take(load) {
  await attempt(async (calls) => {
    $('status').textContent = 'Reading …';
    showWarnings([]);
    showTimes([]);
    $('results').hidden = $('printCheck').hidden = true;
    $('slice').disabled = true;
    $('input').textContent = '';
    input = null;
    done = false;
    for (const name of Object.keys(pages)) forgetPage(name);
    viewer.forgetPlaces();
    reveal('nothing');
    const files = await load(calls);
    input = { files };
    $('slice').disabled = false;
    $('input').textContent = `${nameOf(input)}: ${sizeOf(Object.values(files).reduce((sum, { length }) => sum + length, 0))}`;
    if (check().length > 0) return void sliceIfValid();
    await sliceInput(calls);
    if (done) showPane('layers');
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
    if (files[unused] === undefined && unused !== strategyFile) return unused;
  }
}

const takeBody = (body) =>
  take(async (calls) => (await run(['make', body, '-o', `${body}.stl`, ...words(smaller[body] ?? {})], {}, calls)).files);

/** Diagnoses the mesh and shows it, unless somebody goes back to the layers meanwhile. */
async function showMesh() {
  meshIsWanted = true;
  await attempt(async (calls) => {
    if (!pages.mesh) {
      const unit = options().unit;
      const { files, warnings } = await runOn(input, ['info', ...Object.keys(input.files), ...(unit ? [`--unit=${unit}`] : []), '--report', 'mesh.html'], calls);
      keepPage('mesh', files['mesh.html']);
      showWarnings(warnings);
    }
    if (!meshIsWanted) $('status').textContent = '';
    else if (await showPage('mesh')) $('status').textContent = 'The mesh with its shells and defects.';
  });
}

/** The bytes of a download. They come in chunks where the format permits it: no array of a browser holds more than 2 GB. */
async function downloaded({ name, output, command }, calls) {
  const blobs = []; // which browsers may keep on disk
  let chunks = [];
  let waiting = 0; // bytes in chunks
  const flush = () => {
    blobs.push(new Blob(chunks));
    [chunks, waiting] = [[], 0];
  };
  const onOutput = (bytes) => {
    chunks.push(bytes);
    waiting += bytes.length;
    if (waiting > blobBytes) flush();
  };
  const isStreamed = streamedFormats.includes($('format').value);
  const taken = isStreamed ? command.map((word) => (word === output ? '-' : word)) : command;
  const places = { files: { ...input.files, 'out/': '' } };
  const { files, warnings } = await runOn(places, taken, isStreamed ? { ...calls, onOutput } : calls);
  showWarnings(warnings, name);
  flush();
  return new Blob(isStreamed ? blobs : [files[output]]);
}

async function download() {
  await attempt(async (calls) => {
    const writing = writingDownload((file) => `out/${file}`);
    const { name } = writing;
    const bytes = await downloaded(writing, calls);
    const address = URL.createObjectURL(bytes);
    Object.assign(document.createElement('a'), { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
    $('status').textContent = `${name}: ${sizeOf(bytes.size)}.`;
  });
}

/** Copies a text, also where a page from disk may not write to the clipboard. */
async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = Object.assign(document.createElement('textarea'), { value: text, className: 'unseen' });
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
  const before = button.textContent;
  button.textContent = 'Copied';
  setTimeout(() => (button.textContent = before), 1500);
}

function takeStrategy(given) {
  strategy = given;
  $('strategyName').textContent = given?.name ?? 'none';
  $('noStrategy').hidden = !given;
  if (entered().scan) sliceIfValid();
}

// ---- What people do ---------------------------------------------------------------------------------------------------

$('body').append(...bodies.map((body) => new Option(body, body)));
$('file').addEventListener('change', ({ target }) => {
  const list = [...target.files];
  target.value = ''; // so that the same file can be chosen again
  if (list.length > 0) takeFiles(list);
});
$('strategy').addEventListener('change', async ({ target }) => {
  const [file] = target.files;
  target.value = '';
  if (file) takeStrategy({ name: file.name, text: await file.text() });
});
$('noStrategy').addEventListener('click', () => takeStrategy(null));
$('body').addEventListener('change', ({ target }) => {
  keepSettings();
  if (target.value) takeBody(target.value);
});
form.addEventListener('submit', (event) => {
  event.preventDefault();
  keepSettings();
  const [first] = sliceIfValid();
  if (first) goTo(first.field);
});
const isOfImages = (name) => /^(pixel|display|antialias|printer)/.test(name);
form.addEventListener('change', ({ target }) => {
  if (!target.name) return;
  keepSettings();
  if (target.name === 'printer') showPrinter();
  if (isOfImages(target.name)) return void (check(), tellCommand()); // the layers stay as they are
  sliceIfValid();
});
form.addEventListener('click', ({ target }) => {
  if (!target.dataset.height) return;
  form.elements.layerHeight.value = target.dataset.height;
  form.elements.layerHeight.dispatchEvent(new Event('change', { bubbles: true }));
});
$('cancel').addEventListener('click', () => abort?.abort());
$('format').addEventListener('change', tellCommand);
$('download').addEventListener('click', () => {
  const [first] = check();
  if (first) sliceIfValid(), goTo(first.field);
  else download();
});
$('results').addEventListener('click', ({ target }) => {
  if (target.dataset.copy === 'command') copy($('command').textContent, target);
  if (target.dataset.copy === 'link') copy(link(), target);
});
$('views').addEventListener('click', ({ target }) => {
  if (target.dataset.view === 'layers') {
    meshIsWanted = false;
    showPage('layers');
  }
  if (target.dataset.view === 'mesh') showMesh();
});
$('panes').addEventListener('click', ({ target }) => target.dataset.pane && showPane(target.dataset.pane));
for (const kind of ['dragover', 'dragleave', 'drop'])
  addEventListener(kind, (event) => {
    event.preventDefault();
    document.body.classList.toggle('over', kind === 'dragover');
    if (kind === 'drop' && event.dataTransfer.files.length > 0) takeFiles([...event.dataTransfer.files]);
  });
form.elements.printer.addEventListener('input', showPrinter);
$('resin').addEventListener('toggle', () => printers.length === 0 && listPrinters().catch(() => {}), { once: true });
addEventListener('hashchange', () => {
  const body = takeSettings();
  const other = body !== $('body').value && body !== '';
  if (body) $('body').value = body;
  check();
  if (other) takeBody(body);
  else sliceIfValid();
});

const body = takeSettings();
check();
if (body) {
  $('body').value = body;
  takeBody(body);
} else {
  // The program is compiled while people look for a file. The page has been painted by then.
  addEventListener('load', () => setTimeout(() => run(['--version']).catch(() => {}), 50), { once: true });
}

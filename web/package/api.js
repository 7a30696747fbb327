// The interface for JavaScript: meshes and stacks of layers are bytes in the caller's memory, and each call runs the
// program on them in a worker. So nothing has to be freed, and a call can be ended at any time.

import { newFlow } from './flow.js';
import { pixelsOf } from './pixels.js';
import { rawReader } from './raw_layers.js';

const kinds = { 1: 'internal', 2: 'usage', 3: 'input', 4: 'defect', 5: 'limit', 6: 'output', 130: 'cancelled' };

/** A failure that the program reports; its message is the text of the program. */
export class LamellaError extends Error {
  /** @param {string} message @param {number} exitCode of the program */
  constructor(message, exitCode) {
    super(message);
    this.name = 'LamellaError';
    this.exitCode = exitCode;
    this.kind = kinds[exitCode] ?? 'internal';
  }
}

const smallBytes = 1 << 20; // of inputs for which starting threads takes longer than they save

let platform;
let module; // of WebAssembly, compiled once
const idle = []; // workers
const waiting = []; // functions to call with a worker
let started = 0;

/** Called once, by the entry for Node.js or for browsers. */
export function usePlatform(given) {
  platform = given;
}

function startWorker(compiled) {
  const worker = { job: null };
  const onMessage = (message) => {
    try {
      if (message.line !== undefined) worker.job?.onLine(message.line);
      else if (message.output) worker.job?.onOutput(message.output);
      else worker.job?.finish(message);
    } catch (error) {
      worker.job?.end(error); // of a function of the caller
    }
  };
  const onFailure = (error) => {
    if (worker.job) worker.job.end(error instanceof LamellaError ? error : new LamellaError(trapText(error?.message ?? error), 5));
    else endWorker(worker);
  };
  worker.handle = platform.startWorker(compiled, onMessage, onFailure);
  return worker;
}

/** Ends a worker and what it computes, and makes room for another one. */
function endWorker(worker) {
  worker.handle.end();
  drop(worker);
}

async function takeWorker() {
  module ??= platform.loadModule();
  const compiled = await module.catch((error) => {
    module = undefined; // the next call tries again
    throw error;
  });
  if (idle.length > 0) return idle.pop();
  if (started < platform.processors) {
    started += 1;
    return startWorker(compiled);
  }
  return new Promise((resolve) => waiting.push(resolve));
}

function giveBack(worker) {
  const next = waiting.shift();
  if (next) next(worker);
  else idle.push(worker);
}

function drop(worker) {
  const at = idle.indexOf(worker);
  if (at >= 0) idle.splice(at, 1);
  started -= 1;
  if (waiting.length > 0) takeWorker().then(waiting.shift());
}

/** Terminates idle workers. The next call starts new ones. */
export function releaseWorkers() {
  for (const worker of idle.splice(0)) {
    worker.handle.end();
    started -= 1;
  }
}

/** Number of processors for a call; 0: the thread of its worker. Calls at the same time share the processors. */
function processorsFor(words, inputs) {
  if (!platform.shared) return 0;
  if (words.some((word) => /^--(threads|timeout)\b/.test(word))) return platform.processors;
  if (inputs.reduce((sum, { bytes }) => sum + bytes.length, 0) < smallBytes) return 0;
  const busy = started - idle.length;
  return Math.max(1, Math.floor(platform.processors / busy));
}

/** Runs in a worker. @returns {Promise<{code: number, files: object[]}>} */
async function runInWorker(words, inputs, signal, onLine, onOutput, flow) {
  signal?.throwIfAborted();
  const worker = await takeWorker();
  if (signal?.aborted) {
    giveBack(worker);
    signal.throwIfAborted();
  }
  worker.handle.hold(true);
  let abort;
  try {
    return await new Promise((resolve, reject) => {
      const end = (reason) => {
        worker.job = null;
        endWorker(worker);
        reject(reason);
      };
      abort = () => end(signal.reason);
      worker.job = {
        onLine,
        onOutput,
        end,
        finish({ result, trap }) {
          worker.handle.hold(false);
          giveBack(worker);
          if (result) resolve(result);
          else reject(new LamellaError(trapText(trap), 5));
        },
      };
      signal?.addEventListener('abort', abort, { once: true });
      worker.handle.post({ words, inputs, processors: processorsFor(words, inputs), flow: flow?.counter });
    });
  } finally {
    worker.job = null;
    signal?.removeEventListener('abort', abort);
  }
}

const trapText = (trap) =>
  `stopped by WebAssembly (${trap}): most likely the 4 GB that it can use, or its stack, were not enough; the native program has no such limit`;

/** The error of a run, whose reason may be a limit of WebAssembly that the computer itself does not show. */
function failureOf(text, code, refused) {
  if (refused !== null) return new LamellaError(`${text}: a file here has at most 2 GB in a browser and 4 GB in Node.js; the native program has no such limit`, 5);
  return new LamellaError(code === 5 && /\bmemory\b/.test(text) ? `${text} (WebAssembly can use 4 GB at most)` : text, code);
}

/**
 * Runs the program with a command line, on files given by name.
 * @param {string[]} words such as ['slice', 'part.stl', '-o', 'part.cli']
 * @param {Record<string, Uint8Array>} files
 * @param {{signal?: AbortSignal, onProgress?: Function, onOutput?: Function}} options `onOutput` gets the bytes of standard
 *     output as they come
 */
export function run(words, files = {}, options = {}) {
  return runCounted(words, files, options);
}

/** Like `run`; the program waits while too much of its output does (flow.js). */
async function runCounted(words, files, { signal, onProgress, onOutput }, flow) {
  const warnings = [];
  const texts = [];
  let failure;
  const onLine = (line) => {
    const message = line.startsWith('{') ? JSON.parse(line) : {};
    if (message.stage !== undefined) onProgress?.(message);
    else if (message.warning !== undefined) warnings.push(message.warning);
    else if (message.error !== undefined) failure = message.error;
    else if (line.startsWith('lamella: error: ')) failure = line.slice('lamella: error: '.length);
    else if (line.startsWith('lamella: warning: ')) warnings.push(line.slice('lamella: warning: '.length));
    else texts.push(line);
  };
  const inputs = Object.entries(files).map(([name, bytes]) => ({ name, bytes: bytesOf(bytes) }));
  const decoder = new TextDecoder();
  let text = '';
  onOutput ??= (bytes) => (text += decoder.decode(bytes, { stream: true }));
  const { code, files: written, refused } = await runInWorker(words, inputs, signal, onLine, onOutput, flow);
  const result = {
    code,
    text,
    warnings,
    notes: texts,
    files: Object.fromEntries(written.map(({ name, bytes }) => [name, bytes])),
  };
  if (failure !== undefined) throw Object.assign(failureOf(failure, code, refused), { warnings });
  return result;
}

/** The bytes of a PLY file of a mesh in arrays: its numbers are stored as they are. */
function plyOf(positions, indices) {
  const isList = (one) => Array.isArray(one) || (ArrayBuffer.isView(one) && !(one instanceof DataView));
  if (!isList(positions) || (indices !== undefined && indices !== null && !isList(indices)))
    throw new TypeError('meshOf takes arrays: x, y and z of each vertex in turn, and three vertices for each triangle');
  const vertices = positions.length / 3;
  const given = indices?.length ?? vertices;
  if (!Number.isInteger(vertices)) throw new LamellaError(`meshOf: there are ${positions.length} positions, which is no multiple of 3: x, y and z of each vertex`, 2);
  if (given % 3 !== 0) throw new LamellaError(`meshOf: there are ${given} ${indices ? 'indices' : 'vertices'}, which is no multiple of 3: the vertices of each triangle`, 2);
  const type = positions instanceof Float32Array ? 'float' : 'double';
  const Numbers = type === 'float' ? Float32Array : Float64Array;
  const properties = ['x', 'y', 'z'].map((axis) => `property ${type} ${axis}\n`).join('');
  const header = new TextEncoder().encode(
    `ply\nformat binary_little_endian 1.0\nelement vertex ${vertices}\n${properties}element face ${given / 3}\nproperty list uchar uint vertex_indices\nend_header\n`,
  );
  const points = new Uint8Array(Numbers.from(positions).buffer);
  const faces = new DataView(new ArrayBuffer((given / 3) * 13));
  for (let i = 0, at = 0; i < given; ++i) {
    if (i % 3 === 0) faces.setUint8(at++, 3);
    const vertex = indices?.[i] ?? i;
    if (!(vertex >= 0 && vertex < vertices && Number.isInteger(vertex)))
      throw new LamellaError(`meshOf: index ${i} is ${vertex}, but the vertices are 0 to ${vertices - 1}`, 2);
    faces.setUint32(at, vertex, true);
    at += 4;
  }
  const bytes = new Uint8Array(header.length + points.length + faces.byteLength);
  bytes.set(header);
  bytes.set(points, header.length);
  bytes.set(new Uint8Array(faces.buffer), header.length + points.length);
  return bytes;
}

function bytesOf(data) {
  if (data instanceof Uint8Array) return data;
  if (typeof data === 'string') return new TextEncoder().encode(data);
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  if (data instanceof ArrayBuffer || (typeof SharedArrayBuffer !== 'undefined' && data instanceof SharedArrayBuffer)) return new Uint8Array(data);
  throw new TypeError('bytes must be an ArrayBuffer, a view of one, or a string');
}

// ---- Options: those of the program, in camel case. --------------------------------------------------------------------

const ranges = new Set(['layers', 'zRange', 'adaptive', 'bottomOffset']);
/** Options that are files for the program, and the name of the file. */
const texts = { zList: 'heights.json', strategy: 'strategy.toml' };
const ofCall = new Set(['signal', 'onProgress', 'onOutput']);

/** Of the options of a call, those that are not for the program. */
const callOf = ({ signal, onProgress }) => ({ signal, onProgress });

const kebab = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);

function valueText(name, value) {
  if (name === 'heights') return value.map(([from, to, height]) => `${from}:${to}=${height}`).join(',');
  if (name === 'greyCurve') return value.map((point) => point.join(':')).join(',');
  if (name === 'resolution') return value.join('x');
  if (ranges.has(name)) return value.map((end) => end ?? '').join(':');
  return Array.isArray(value) ? value.join(',') : String(value);
}

/** The words for options; files that they need are added to `files`. */
function wordsOf(options, files) {
  return Object.entries(options).flatMap(([name, value]) => {
    if (value === undefined || value === null || value === false || ofCall.has(name)) return [];
    if (name === 'threads' && !platform.shared) return [];
    const option = `--${kebab(name)}`;
    if (value === true) return [option];
    if (texts[name] !== undefined) {
      files[texts[name]] = typeof value === 'string' ? value : JSON.stringify(value);
      return [option, texts[name]];
    }
    return [`${option}=${valueText(name, value)}`];
  });
}

/** A name under which a file can lie beside the others of a call. */
function fileName(name, files) {
  const plain = name.replace(/^.*[/\\]/, '') || 'part';
  for (let number = 1; ; ++number) {
    const unique = number === 1 ? plain : plain.replace(/(\.[^.]*)?$/, `-${number}$1`);
    if (files[unique] === undefined) return unique;
  }
}

// ---- Meshes -----------------------------------------------------------------------------------------------------------

/** Memory is freed when nothing refers to bytes any more; `dispose` ends the reference of a mesh or a stack to its own. */
class Disposable {
  dispose() {
    this.bytes = new Uint8Array();
    this.layers &&= [];
    this.disposed = true;
  }
}
Object.defineProperty(Disposable.prototype, 'disposed', { value: false, writable: true });
if (Symbol.dispose) Disposable.prototype[Symbol.dispose] = Disposable.prototype.dispose;

/** Returns `one` if it is of a type and has its data; `where` names the function. */
function checked(one, types, where) {
  if (!types.some((type) => one instanceof type)) {
    const found = one instanceof Disposable ? `a ${one.constructor.name}` : one === null ? 'null' : Array.isArray(one) ? 'an array' : typeof one;
    throw new TypeError(`${where} takes a ${types.map(({ name }) => name).join(' or a ')}, not ${found}`);
  }
  if (one.disposed) throw new LamellaError(`${where}: the ${one.constructor.name} was disposed of and has no data any more`, 2);
  return one;
}

/** The options with which each mesh was read: its file is read again by each call. */
const readings = new WeakMap();

/** A mesh file that was read without an error. */
export class Mesh extends Disposable {
  constructor(bytes, facts, warnings, { unit, include, maxTriangles } = {}) {
    super();
    Object.assign(this, facts, { bytes, warnings });
    readings.set(this, { unit, include, maxTriangles });
  }
}

/** Reads a mesh or slice file and describes it. */
async function readAny(data, name, options) {
  const bytes = bytesOf(data);
  const plain = fileName(name, {});
  const { text, warnings } = await run(['read', plain, '--progress=json', ...wordsOf(options, {})], { [plain]: bytes }, options);
  return { bytes, warnings, facts: { ...JSON.parse(text), name: plain } };
}

/** Reads a mesh file; its format is recognised by its content. */
export async function readMesh(data, name = 'part', options = {}) {
  const { bytes, facts, warnings } = await readAny(data, name, options);
  if (facts.kind !== 'mesh') throw new LamellaError(`${facts.name}: holds layers (${facts.format}); readLayers reads them`, 3);
  return new Mesh(bytes, facts, warnings, options);
}

/**
 * Makes a mesh of arrays, as three.js, manifold-3d and others have them.
 * @param {ArrayLike<number>} positions x, y and z of each vertex, in turn
 * @param {ArrayLike<number>} [indices] three vertices for each triangle; without them, vertices follow one another
 * @param {{name?: string}} options and those of readMesh
 * @returns {Promise<Mesh>}
 */
export async function meshOf(positions, indices, { name = 'mesh', ...options } = {}) {
  return readMesh(plyOf(positions, indices), `${name}.ply`, options);
}

/** Reads a mesh or layers, whatever the file holds. @returns {Promise<Mesh|Stack>} */
export async function readFile(data, name = 'part', options = {}) {
  const { bytes, facts, warnings } = await readAny(data, name, options);
  return facts.kind === 'mesh' ? new Mesh(bytes, facts, warnings, options) : readLayers(bytes, facts.name, callOf(options));
}

/** Makes one of the test bodies, such as `rook`. */
export async function makeBody(body, { ascii, format = 'stl', ...options } = {}) {
  const name = `${body}.${format}`;
  const { files } = await run(['make', body, '-o', name, ...wordsOf({ ascii, ...options }, {})], {}, options);
  return readMesh(files[name], name, { signal: options.signal });
}

/** Size, volume, shells and every kind of defect with its positions, as `lamella info --json` describes them. */
export async function diagnose(mesh, options = {}) {
  const { name, bytes } = checked(mesh, [Mesh], 'diagnose');
  const words = wordsOf({ ...readings.get(mesh), ...options }, {});
  const { text, warnings } = await run(['info', name, '--json', '--progress=json', ...words], { [name]: bytes }, options);
  return { ...JSON.parse(text), warnings };
}

/** Islands, overhangs, cups and traps of a print, as `lamella check --json` describes them. */
export async function checkPrint(meshOrStack, options = {}) {
  const { name = 'stack.npz', bytes } = checked(meshOrStack, [Mesh, Stack], 'checkPrint');
  const files = { [name]: bytes };
  const words = wordsOf({ ...readings.get(meshOrStack), ...options }, files);
  const { text, warnings } = await run(['check', name, '--json', '--progress=json', ...words], files, options);
  return { ...JSON.parse(text), warnings };
}

// ---- Layers -----------------------------------------------------------------------------------------------------------

/** The entries of a zip archive whose bytes are stored as they are. */
function* entries(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - 22;
  while (view.getUint32(end, true) !== 0x06054b50) end -= 1;
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; --left) {
    const nameBytes = view.getUint16(at + 28, true);
    const header = view.getUint32(at + 42, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameBytes));
    const begin = header + 30 + view.getUint16(header + 26, true) + view.getUint16(header + 28, true);
    yield [name, begin, view.getUint32(at + 20, true)];
    at += 46 + nameBytes + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
  }
}

const headerBytes = 128; // of the arrays that the program writes
const types = { '<f8': Float64Array, '<i8': BigInt64Array, '|b1': Uint8Array };

/** The arrays of an NPZ file that the program wrote, views of one buffer. */
function arraysOf(file) {
  // Views of doubles begin at multiples of 8 bytes. The file is moved so that its points do.
  const [, first] = entries(file).next().value;
  const shift = (8 - ((first + headerBytes) % 8)) % 8;
  const bytes = roomFor(file.length + shift).subarray(shift);
  bytes.set(file);
  const arrays = {};
  for (const [name, begin, size] of entries(bytes)) {
    const header = new TextDecoder('latin1').decode(bytes.subarray(begin + 10, begin + headerBytes));
    const type = /'descr': '([^']*)'/.exec(header)[1];
    const data = bytes.subarray(begin + headerBytes, begin + size);
    arrays[name.replace('.npy', '')] = type.startsWith('<U') ? strings(data, Number(type.slice(2))) : numbers(data, types[type]);
  }
  return { bytes, arrays };
}

function roomFor(bytes) {
  try {
    return new Uint8Array(bytes);
  } catch {
    throw new LamellaError(`there is no memory for an array of ${(bytes / 1e9).toFixed(2)} GB of layers: sliceLayers yields them one by one, sliceToFile makes a file`, 5);
  }
}

function numbers(data, Type) {
  const begin = data.byteOffset;
  if (begin % Type.BYTES_PER_ELEMENT === 0) return new Type(data.buffer, begin, data.length / Type.BYTES_PER_ELEMENT);
  return new Type(data.slice().buffer);
}

function strings(data, length) {
  const points = new Uint32Array(data.slice().buffer);
  return Array.from({ length: points.length / length }, (_, i) =>
    String.fromCodePoint(...points.subarray(i * length, (i + 1) * length)).replace(/\0+$/, ''),
  );
}

/** The position of the first number of an ascending array, also of 64-bit integers, that is not below `value`. */
function lowerBound(array, value) {
  let [low, high] = [0, array.length];
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (array[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The contours of one plane. `points`, `closed` and `hatches` are views without a copy. */
export class Layer {
  #arrays;
  #first; // contour
  #last;
  #offsets;
  #hatches; // from which line to which

  constructor(arrays, i, statistics) {
    this.#arrays = arrays;
    this.index = Number(arrays.index[i]);
    this.z = arrays.z[i];
    this.bottom = arrays.bottom[i];
    this.top = arrays.top[i];
    this.#first = lowerBound(arrays.layer, i);
    this.#last = lowerBound(arrays.layer, i + 1);
    this.#hatches = arrays.hatch_layer ? [lowerBound(arrays.hatch_layer, i), lowerBound(arrays.hatch_layer, i + 1)] : [0, 0];
    Object.assign(this, statistics);
  }

  /** Number of contours. */
  get contours() {
    return this.#last - this.#first;
  }

  /** x and y of all points, in turn. */
  get points() {
    const { points, offsets } = this.#arrays;
    return points.subarray(2 * Number(offsets[this.#first]), 2 * Number(offsets[this.#last]));
  }

  /** Contour i has the points from offsets[i] to offsets[i + 1]. */
  get offsets() {
    if (!this.#offsets) {
      const { offsets } = this.#arrays;
      const begin = offsets[this.#first];
      this.#offsets = Uint32Array.from(offsets.subarray(this.#first, this.#last + 1), (offset) => Number(offset - begin));
    }
    return this.#offsets;
  }

  /** 1 for each ring, 0 for each open contour. */
  get closed() {
    return this.#arrays.closed.subarray(this.#first, this.#last);
  }

  /** The part of each contour. */
  get parts() {
    return Uint32Array.from(this.#arrays.part.subarray(this.#first, this.#last), Number);
  }

  /** x and y of the first and last point of each hatch line, in turn. */
  get hatches() {
    const [begin, end] = this.#hatches;
    return this.#arrays.hatches?.subarray(4 * begin, 4 * end) ?? new Float64Array();
  }

  /** The part of each hatch line. */
  get hatchParts() {
    const [begin, end] = this.#hatches;
    return Uint32Array.from(this.#arrays.hatch_part?.subarray(begin, end) ?? [], Number);
  }

  /** x and y of the points of contour i, in turn. */
  contour(i) {
    return this.points.subarray(2 * this.offsets[i], 2 * this.offsets[i + 1]);
  }
}

const camel = (name) => name.replace(/_(mm[23]?|[a-z])/g, (_, rest) => rest[0].toUpperCase() + rest.slice(1));

/** Statistics without the properties that layers have anyway. */
function statisticsOf({ index, z, contours, points, ...rest }) {
  return Object.fromEntries(Object.entries(rest).map(([name, value]) => [camel(name), value]));
}

/** Layers in ascending z. `bytes` are an NPZ file of them. */
export class Stack extends Disposable {
  constructor(file, { statistics = null, warnings = [], source = null } = {}) {
    super();
    const { bytes, arrays } = arraysOf(file);
    this.bytes = bytes;
    this.labels = arrays.labels;
    this.layers = Array.from(arrays.z, (_, i) => new Layer(arrays, i, statistics?.layers ? statisticsOf(statistics.layers[i]) : {}));
    this.statistics = statistics;
    this.warnings = warnings;
    /** Of scan vectors: how they are made again, because NPZ files store no parameters. */
    this.source = source;
  }
}

/** The words of a command that slices meshes, each with its placement; files that it needs are added to `files`. */
function sliceWords(meshes, options, files, where) {
  const placed = [meshes].flat().map((one) => {
    const { mesh, ...placement } = one instanceof Mesh || one === null || typeof one !== 'object' || !('mesh' in one) ? { mesh: one } : one;
    return { mesh: checked(mesh, [Mesh], where), placement };
  });
  const inputs = placed.flatMap(({ mesh, placement }) => {
    const name = fileName(mesh.name, files);
    files[name] = mesh.bytes;
    const { unit } = readings.get(mesh);
    return [name, ...wordsOf(options.unit === undefined ? { unit, ...placement } : placement, files)];
  });
  const include = placed.flatMap(({ mesh }) => readings.get(mesh).include ?? []);
  const ofAll = include.length > 0 ? { include: [...new Set(include)] } : {};
  // Placements of all meshes go before the first one.
  return ['slice', ...wordsOf({ ...ofAll, ...options }, files), ...inputs, '--progress=json'];
}

/**
 * Slices one mesh, or several on one plate.
 * @param {Mesh | (Mesh | {mesh: Mesh})[]} meshes
 * @returns {Promise<Stack>}
 */
export async function slice(meshes, options = {}) {
  const files = {};
  const words = sliceWords(meshes, options, files, 'slice');
  const { files: written, warnings } = await run([...words, '-o', 'layers.npz', '--stats', 'layers.stats'], files, options);
  const statistics = JSON.parse(new TextDecoder().decode(written['layers.stats']));
  return new Stack(written['layers.npz'], { statistics, warnings, source: statistics.scan ? { meshes, options } : null });
}

/** The layers of a run that writes them in the format `raw` to standard output. */
async function* comingLayers(meshes, options, facts) {
  const { signal, onProgress } = options;
  const files = {};
  const words = [...sliceWords(meshes, options, files, 'sliceLayers'), '-o', '-', '--format', 'raw'];
  const chunks = []; // that have come and are not read
  const ready = []; // layers
  let wake = () => {};
  let over = false;
  let failure;
  const read = rawReader(
    ({ parts }) => facts.labels.push(...parts.map(({ label }) => label)),
    (arrays) => ready.push(new Layer(arrays, 0, {})),
  );
  const onOutput = (bytes) => {
    chunks.push(bytes);
    wake();
  };
  const stop = new AbortController();
  const abort = () => stop.abort(signal.reason);
  signal?.addEventListener('abort', abort, { once: true });
  if (signal?.aborted) abort();
  const flow = newFlow();
  runCounted(words, files, { signal: stop.signal, onProgress, onOutput }, flow)
    .then(
      ({ warnings }) => facts.warnings.push(...warnings.map((text) => text.replace(/^standard output: /, 'layers: '))),
      (error) => (failure = error),
    )
    .finally(() => {
      over = true;
      wake();
    });
  try {
    while (!over || chunks.length > 0 || ready.length > 0) {
      stop.signal.throwIfAborted();
      if (ready.length > 0) yield ready.shift();
      else if (chunks.length > 0) flow.release(take(chunks, read));
      else await new Promise((resolve) => (wake = resolve));
    }
    if (failure) throw failure;
  } finally {
    signal?.removeEventListener('abort', abort);
    stop.abort(); // nobody wants the rest
  }
}

/** Reads the first chunk. @returns {number} its bytes */
function take(chunks, read) {
  const bytes = chunks.shift();
  read(bytes);
  return bytes.length;
}

/**
 * Slices like `slice`, and yields the layers one by one while they come. Where threads can share memory, slicing waits for the
 * loop.
 * @returns {AsyncGenerator<Layer> & {labels: string[], warnings: string[]}} `warnings` are complete behind the last layer
 */
export function sliceLayers(meshes, options = {}) {
  const facts = { labels: [], warnings: [] };
  return Object.assign(comingLayers(meshes, options, facts), facts);
}

/** The files of a run, or the bytes of the only one. */
function result(files, name) {
  return files[name] ?? files;
}

/**
 * Slices into a slice file, without layers in between.
 * @param {string} format such as 'cli' or '3mf'; `png` gives a file for each layer, by name
 * @returns {Promise<{bytes: Uint8Array, statistics: object, warnings: string[]}>}
 */
export async function sliceToFile(meshes, format, options = {}) {
  const files = {};
  const words = sliceWords(meshes, options, files, 'sliceToFile');
  const { files: all, warnings } = await run([...words, '-o', 'layers', '--format', format, '--stats', 'figures.json'], files, options);
  const { 'figures.json': figures, ...written } = all;
  return { bytes: result(written, 'layers'), statistics: JSON.parse(new TextDecoder().decode(figures)), warnings };
}

/** Writes layers in any slice format. @returns {Promise<Uint8Array>} */
export async function writeLayers(stack, format, options = {}) {
  checked(stack, [Stack], 'writeLayers');
  if (stack.source) return (await sliceToFile(stack.source.meshes, format, { ...stack.source.options, ...options })).bytes;
  const { files } = await run(['convert', 'stack.npz', 'layers', '--format', format, '--progress=json', ...wordsOf(options, {})], { 'stack.npz': stack.bytes }, options);
  return result(files, 'layers');
}

/** Reads a slice file; its format is recognised by its content. */
export async function readLayers(data, name = 'layers', options = {}) {
  const plain = fileName(name, { 'stack.npz': 1 });
  const { files, warnings } = await run(['convert', plain, 'stack.npz', '--progress=json', ...wordsOf(options, {})], { [plain]: bytesOf(data) }, options);
  return new Stack(files['stack.npz'], { warnings });
}

/**
 * The layers as pixels: exact coverage from 0 to 255 or, with `antialias: 1`, 255 where the centre of a pixel is covered.
 * @returns {Promise<{data: Uint8Array, shape: number[], spacing: number[], origin: number[], z: Float64Array}>}
 */
export async function pixels(stack, options = {}) {
  checked(stack, [Stack], 'pixels');
  for (const name of ['printer', 'orientation', 'mirror', 'partColours'])
    if (options[name] !== undefined) throw new TypeError(`pixels: ${name} is for images, and columns and rows of pixels are along x and y`);
  return pixelsOf(await writeLayers(stack, 'png', options), roomFor);
}

/** A page that shows a mesh's or a file's layers, as `lamella view` writes it. @returns {Promise<Uint8Array>} HTML */
export async function view(meshOrStack, options = {}) {
  const { name = 'stack.npz', bytes } = checked(meshOrStack, [Mesh, Stack], 'view');
  const files = { [name]: bytes };
  const words = wordsOf({ ...readings.get(meshOrStack), ...options }, files);
  const { files: written } = await run(['view', name, '-o', 'page.html', '--progress=json', ...words], files, options);
  return written['page.html'];
}

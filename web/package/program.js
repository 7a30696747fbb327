// Runs the program of Lamella in WebAssembly, on files in memory. Used inside a worker.

import { holdBack } from './flow.js';
import { lines } from './lines.js';
import { newMemory } from './memory.js';

/** @typedef {{name: string, bytes: Uint8Array}} NamedBytes */

const mostKept = 256 << 20; // bytes: WebAssembly gives no memory back, so larger instances are dropped after a run

/** Has a standard stream give its bytes to `take`. */
function onWrite(FS, number, take) {
  const stream = FS.getStream(number);
  stream.tty = undefined; // it is no terminal
  stream.stream_ops = { ...stream.stream_ops, write: (_, buffer, offset, length) => (take(buffer.slice(offset, offset + length)), length) };
}

/** Of a file in memory, bytes: browsers pass no larger arrays between threads, and Node.js makes no larger ones. */
export const mostInFile = typeof process === 'object' && process.versions?.node ? 2 ** 32 - 1 : 2 ** 31 - 1;
const tooLarge = 22; // EFBIG

/**
 * Gives a file in memory room for `bytes`, in place of Emscripten's function, which copies large files time and again.
 * @param {(number: number) => Error} errorOf an error number @param {(name: string) => void} refuse called with the name of a file that is too large
 */
export function growFile(node, bytes, errorOf, refuse) {
  const { contents, usedBytes } = node;
  if (contents && contents.length >= bytes) return;
  const fail = () => {
    refuse(node.name);
    throw errorOf(tooLarge);
  };
  if (bytes > mostInFile) fail();
  let grown;
  try {
    grown = new Uint8Array(Math.min(Math.max(bytes, 2 * (contents?.length ?? 0), 256), mostInFile));
  } catch {
    fail(); // there is not enough memory
  }
  node.contents = grown;
  if (usedBytes > 0) node.contents.set(contents.subarray(0, usedBytes));
}

/**
 * Runs the program of an instance of lamella.wasm.
 * @param {number} processors 0: only this thread; otherwise threads that share memory, meanwhile this one serves files
 * @returns {Promise<{code: number, early: boolean}>} its exit code, and whether it ended while threads were at work
 */
export async function runProgram(instance, words, processors) {
  const call = (name) => {
    const text = new TextEncoder().encode(words.map((word) => `${word}\0`).join(''));
    return instance.ccall(name, 'number', ['array', 'number'], [text, words.length]);
  };
  instance.processors = Math.max(1, processors);
  if (processors === 0) return { code: call('lamella_run'), early: false };
  return new Promise((resolve) => {
    instance.ended = (code, early) => resolve({ code, early });
    call('lamella_start');
  });
}

export class Program {
  #create;
  #compiled;
  #environment;
  #instance = null;
  #memory;
  #refused = null; // name of a file that became too large

  /**
   * @param create the function of lamella.js
   * @param {{module: WebAssembly.Module, shared: boolean}} compiled lamella.wasm, and whether threads share its memory
   * @param environment variables
   */
  constructor(create, compiled, environment) {
    this.#create = create;
    this.#compiled = compiled;
    this.#environment = environment;
  }

  async #ready() {
    const { module, shared } = this.#compiled;
    const instantiateWasm = (imports, done) => {
      // The promise reports a failure, as a lack of memory is.
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    };
    if (!this.#instance) {
      this.#memory = newMemory(shared);
      this.#instance = await this.#create({
        instantiateWasm,
        wasmMemory: this.#memory,
        preRun: [({ ENV }) => Object.assign(ENV, this.#environment)],
      });
      const { FS, MEMFS } = this.#instance;
      MEMFS.expandFileStorage = (node, bytes) => growFile(node, bytes, (number) => new FS.ErrnoError(number), (name) => (this.#refused = name));
      if (!shared) this.#instance.PThread.getNewWorker = () => null; // there are then no threads
    }
    return this.#instance;
  }

  /** Ends all threads of an instance that is not used any more. */
  #drop() {
    this.#instance.PThread.runningWorkers.concat(this.#instance.PThread.unusedWorkers).forEach((worker) => worker.terminate());
    this.#instance = null;
  }

  /**
   * Runs the program on files of a folder of its own. An input whose name ends with a slash is an empty folder.
   * @param {{words: string[], inputs: NamedBytes[], processors: number}} request its command line, and how many processors
   *     it may use; 0: only this thread
   * @param {(line: string) => void} onLine of standard error
   * @param {(bytes: Uint8Array) => void} onOutput bytes of standard output
   * @returns {Promise<{code: number, files: NamedBytes[], refused: string | null}>} the files that it wrote, and the name of
   *     one that became too large
   */
  async run({ words, inputs, processors }, onLine, onOutput) {
    const instance = await this.#ready();
    const { FS } = instance;
    onWrite(FS, 1, onOutput);
    onWrite(FS, 2, lines(onLine));
    this.#refused = null;
    FS.mkdir('/job');
    FS.chdir('/job');
    for (const { name, bytes } of inputs) {
      const folder = name.slice(0, name.lastIndexOf('/') + 1);
      if (folder) FS.mkdirTree(`/job/${folder}`);
      if (name !== folder) FS.writeFile(name, bytes, { canOwn: true });
    }
    let spoiled = true;
    try {
      const { code, early } = await runProgram(instance, words, this.#compiled.shared ? processors : 0);
      spoiled = early;
      const known = new Set(inputs.map(({ name }) => `/job/${name}`));
      return { code, files: this.#collect('/job', known), refused: this.#refused };
    } finally {
      if (spoiled || this.#memory.buffer.byteLength > mostKept) this.#drop();
      else this.#empty('/job');
    }
  }

  #children(folder) {
    const { FS } = this.#instance;
    return FS.readdir(folder)
      .filter((name) => name !== '.' && name !== '..')
      .map((name) => [`${folder}/${name}`, FS.isDir(FS.stat(`${folder}/${name}`).mode)]);
  }

  #collect(folder, known) {
    return this.#children(folder).flatMap(([path, isFolder]) => {
      if (isFolder) return this.#collect(path, known);
      return known.has(path) ? [] : [{ name: path.slice('/job/'.length), bytes: this.#bytesOf(path) }];
    });
  }

  /** The bytes themselves, unless much of their memory is room that the file did not use. */
  #bytesOf(path) {
    const { contents, usedBytes } = this.#instance.FS.lookupPath(path).node;
    if (!contents || usedBytes === 0) return new Uint8Array();
    const bytes = new Uint8Array(contents.buffer, contents.byteOffset, usedBytes); // of signed bytes, sometimes
    return usedBytes > 0.75 * contents.length ? bytes : bytes.slice();
  }

  #empty(folder) {
    const { FS } = this.#instance;
    for (const [path, isFolder] of this.#children(folder)) isFolder ? this.#empty(path) : FS.unlink(path);
    if (folder === '/job') FS.chdir('/');
    FS.rmdir(folder);
  }
}

/**
 * Answers the messages of `api.js`: {words, inputs, processors, flow} gives {line} for each line of standard error, {output} for
 * bytes of standard output, and {result} or {trap} at the end.
 * @param {(message: object, transfer?: ArrayBuffer[]) => void} post
 * The other parameters are those of Program.
 * @returns {(request: object) => Promise<void>}
 */
export function answering(post, create, compiled, environment = {}) {
  const program = new Program(create, compiled, environment);
  return async (request) => {
    try {
      const result = await program.run(
        request,
        (line) => post({ line }),
        (output) => {
          const { length } = output; // it is gone once it is posted
          post({ output }, [output.buffer]);
          holdBack(request.flow, length);
        },
      );
      post({ result }, result.files.map(({ bytes }) => bytes.buffer));
    } catch (error) {
      post({ trap: String(error?.message ?? error) });
    }
  };
}

// Runs the program of Lamella in WebAssembly, on files in memory. Used inside a worker.

/** @typedef {{name: string, bytes: Uint8Array}} NamedBytes */

const mostKept = 256 << 20; // bytes: WebAssembly gives no memory back, so larger instances are dropped after a run

/** Has a standard stream give its bytes to `take`. */
function onWrite(FS, number, take) {
  const stream = FS.getStream(number);
  stream.tty = undefined; // it is no terminal
  stream.stream_ops = { ...stream.stream_ops, write: (_, buffer, offset, length) => (take(buffer.slice(offset, offset + length)), length) };
}

/** Gives a file in memory room for `bytes`, in place of Emscripten's function, which copies large files time and again. */
function growFile(node, bytes) {
  const { contents, usedBytes } = node;
  if (contents && contents.length >= bytes) return;
  node.contents = new Uint8Array(Math.max(bytes, 2 * (contents?.length ?? 0), 256));
  if (usedBytes > 0) node.contents.set(contents.subarray(0, usedBytes));
}

function joined(chunks) {
  const all = new Uint8Array(chunks.reduce((sum, chunk) => sum + chunk.length, 0));
  let at = 0;
  for (const chunk of chunks) {
    all.set(chunk, at);
    at += chunk.length;
  }
  return all;
}

/** Calls `act` with each whole line of text. */
function lines(act) {
  const decoder = new TextDecoder();
  let rest = '';
  return (bytes) => {
    const parts = (rest + decoder.decode(bytes, { stream: true })).split('\n');
    rest = parts.pop();
    parts.forEach(act);
  };
}

export class Program {
  #create;
  #module;
  #environment;
  #instance = null;

  /** @param create the function of lamella.js @param {WebAssembly.Module} module lamella.wasm @param environment variables */
  constructor(create, module, environment) {
    this.#create = create;
    this.#module = module;
    this.#environment = environment;
  }

  async #ready() {
    const instantiateWasm = (imports, done) => {
      // The promise reports a failure, as a lack of memory is.
      WebAssembly.instantiate(this.#module, imports).then((instance) => done(instance, this.#module));
      return {};
    };
    if (!this.#instance) {
      this.#instance = await this.#create({ instantiateWasm, preRun: [({ ENV }) => Object.assign(ENV, this.#environment)] });
      this.#instance.MEMFS.expandFileStorage = growFile;
    }
    return this.#instance;
  }

  /**
   * Runs the program on files of a folder of its own.
   * @param {string[]} words of its command line
   * @param {NamedBytes[]} inputs
   * @param {(line: string) => void} onLine of standard error
   * @returns {Promise<{code: number, output: Uint8Array, files: NamedBytes[]}>} what it printed and the files that it wrote
   */
  async run(words, inputs, onLine) {
    const instance = await this.#ready();
    const { FS } = instance;
    const output = [];
    onWrite(FS, 1, (bytes) => output.push(bytes));
    onWrite(FS, 2, lines(onLine));
    FS.mkdir('/job');
    FS.chdir('/job');
    for (const { name, bytes } of inputs) {
      const folder = name.slice(0, name.lastIndexOf('/') + 1);
      if (folder) FS.mkdirTree(folder);
      FS.writeFile(name, bytes, { canOwn: true });
    }
    let failed = true;
    try {
      const code = instance.ccall('lamella_run', 'number', ['array', 'number'], [new TextEncoder().encode(words.join('\0') + '\0'), words.length]);
      failed = false;
      const known = new Set(inputs.map(({ name }) => `/job/${name}`));
      return { code, output: joined(output), files: this.#collect('/job', known) };
    } finally {
      if (failed || instance.HEAPU8.length > mostKept) this.#instance = null;
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
 * Answers the messages of `api.js`: {words, inputs} gives {line} for each line and {result} or {trap} at the end.
 * @param {(message: object, transfer?: ArrayBuffer[]) => void} post
 * The other parameters are those of Program.
 * @returns {(request: object) => Promise<void>}
 */
export function answering(post, create, module, environment = {}) {
  const program = new Program(create, module, environment);
  return async ({ words, inputs }) => {
    try {
      const result = await program.run(words, inputs, (line) => post({ line }));
      post({ result }, [result.output.buffer, ...result.files.map(({ bytes }) => bytes.buffer)]);
    } catch (error) {
      post({ trap: String(error?.message ?? error) });
    }
  };
}

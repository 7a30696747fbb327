// Puts the package for npm together: node build_package.mjs LAMELLA.JS LAMELLA.WASM VERSION TREE OUTPUT

import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [glue, wasmFile, version, tree, output] = process.argv.slice(2);
const sources = join(tree, 'web/package');
const wasm = readFileSync(wasmFile);
const values = { version, ...memoryOf(wasm) };

rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });
for (const name of readdirSync(sources)) {
  const text = readFileSync(join(sources, name), 'utf8');
  const filled = text.replace(/@(\w+)@/g, (_, value) => values[value]);
  writeFileSync(join(output, name.replace(/\.in$/, '')), name.endsWith('.in') ? filled : text);
}
// Emscripten makes scripts that in Node.js ask for CommonJS, and that start and load others by their addresses. As a
// module they are given what they ask for. Memory that is not shared passes for shared memory, of which texts are copied
// before they are decoded.
writeFileSync(
  join(output, 'lamella.js'),
  `// Made by Emscripten.
/** Returns a function that makes instances. @param {{require?: Function, Worker?: Function}} platform */
export default function createLamellaIn({ require, Worker }) {
  const [__dirname, __filename, SharedArrayBuffer] = ['', '', globalThis.SharedArrayBuffer ?? ArrayBuffer];
${readFileSync(glue, 'utf8')}
  return createLamella;
}
/** Makes this worker a thread of the instance that has started it. */
export function runThread(createLamella, require) {
  const [__filename, importScripts] = ['', () => {}];
${readFileSync(glue.replace(/\.js$/, '.worker.js'), 'utf8')}
}
`,
);
wasm[values.flagsAt] = 1; // memory of its own
writeFileSync(join(output, 'lamella.wasm'), wasm);
for (const name of ['LICENSE', 'LICENSES-third-party.txt']) copyFileSync(join(tree, name), join(output, name));

/** The offset of the flags of the memory that a module imports, and its limits in pages. */
function memoryOf(module) {
  let at = 8; // behind the magic and the version
  const byte = () => module[at++];
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const part = byte();
      value += (part & 127) * 2 ** shift;
      if (part < 128) return value;
    }
  };
  const skip = (bytes) => (at += bytes);
  const skipLimits = () => (byte() & 1 ? [number(), number()] : number());
  for (;;) {
    const section = byte();
    const size = number();
    if (section === 2) break; // imports
    skip(size);
  }
  for (let left = number(); left > 0; --left) {
    skip(number()); // name of a module
    skip(number()); // name in it
    const kind = byte();
    if (kind === 0) number(); // the type of a function
    else if (kind === 1) byte(), skipLimits(); // a table
    else if (kind === 3) byte(), byte(); // a global
    else if (kind === 2) {
      const flagsAt = at;
      if (byte() !== 3) throw new Error('the memory of lamella.wasm is not shared');
      return { flagsAt, initial: number(), maximum: number() };
    } else if (kind === 4) byte(), number(); // a tag
    else throw new Error(`lamella.wasm imports something of kind ${kind}`);
  }
  throw new Error('lamella.wasm imports no memory');
}

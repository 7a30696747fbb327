#!/usr/bin/env node
// The program on the files of this computer: npx lamella slice part.stl -o part.cli
// It runs in a worker, so that Ctrl-C can end it and remove what is unfinished.

import { readFileSync, readdirSync, readSync, rmSync, statSync, writeSync } from 'node:fs';
import { createRequire } from 'node:module';
import { availableParallelism, cpus } from 'node:os';
import { isatty } from 'node:tty';
import { Worker, isMainThread, parentPort, workerData } from 'node:worker_threads';

import createLamellaIn from './lamella.js';
import { canShare, compile, newMemory } from './memory.js';
import { runProgram } from './program.js';

const cancelled = 130; // exit code of the program
const outOfMemory = 5;

class Thread extends Worker {
  constructor() {
    super(new URL('./node_thread.js', import.meta.url));
  }
}

if (isMainThread) {
  const unfinished = new Set(); // paths
  const worker = new Worker(new URL(import.meta.url), { workerData: process.argv.slice(2) });
  const end = async (code, text = '') => {
    await worker.terminate();
    unfinished.forEach(remove);
    if (text) writeSync(2, `lamella: error: ${text}\n`);
    process.exit(code);
  };
  worker.on('message', ({ made, gone, code }) => {
    if (made) unfinished.add(made);
    if (gone) unfinished.delete(gone);
    if (code !== undefined) end(code);
  });
  worker.on('error', (error) =>
    end(outOfMemory, `stopped by WebAssembly (${error.message}): most likely the 4 GB that it can use were not enough`),
  );
  for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.once(signal, () => end(cancelled, 'cancelled'));
} else {
  parentPort.postMessage({ code: await runOnFiles(workerData) });
}

function remove(path) {
  rmSync(path, { recursive: true, force: true });
}

async function runOnFiles(words) {
  const shared = canShare();
  const module = await compile(readFileSync(new URL('./lamella.wasm', import.meta.url)), shared);
  const createLamella = createLamellaIn({ require: createRequire(import.meta.url), Worker: Thread });
  const instance = await createLamella({
    preRun: [({ ENV }) => Object.assign(ENV, process.env)],
    wasmMemory: newMemory(shared),
    instantiateWasm(imports, done) {
      done(new WebAssembly.Instance(module, imports), module);
      return {};
    },
  });
  useStreams(instance.FS);
  useFolders(instance.FS, instance.NODEFS);
  const processors = availableParallelism?.() ?? cpus().length;
  return (await runProgram(instance, words, shared ? processors : 0)).code;
}

/** The standard streams of the program are those of this process. */
function useStreams(FS) {
  // The calls of Node.js fail where a pipe is full or empty for the moment; the program waits.
  const patiently = (act) => {
    for (;;) {
      try {
        return act();
      } catch (error) {
        if (error.code === 'EOF') return 0;
        if (error.code !== 'EAGAIN') throw new FS.ErrnoError(error.code === 'EPIPE' ? 64 : 29);
        Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 5);
      }
    }
  };
  const write = (number) => (_, buffer, offset, length) => {
    for (let at = 0; at < length; ) at += patiently(() => writeSync(number, buffer, offset + at, length - at));
    return length;
  };
  for (const number of [1, 2]) {
    const stream = FS.getStream(number);
    stream.stream_ops = { ...stream.stream_ops, write: write(number) };
    if (!isatty(number)) stream.tty = undefined;
  }
  // A copy of the descriptor of standard input opens its path again, so that has to be the pipe, too.
  FS.unlink('/dev/stdin');
  FS.writeFile('/dev/stdin', '');
  const { node } = FS.lookupPath('/dev/stdin');
  node.mode = 0o010666; // a pipe
  node.stream_ops = { read: (_, buffer, offset, length) => patiently(() => readSync(0, buffer, offset, length, null)) };
  Object.assign(FS.getStream(0), { path: '/dev/stdin', node, stream_ops: node.stream_ops, tty: undefined });
}

/** The folders of this computer have their names in the program, too. Unfinished files in them are reported. */
function useFolders(FS, NODEFS) {
  const isUnfinished = (name) => /^\..*\.tmp$/.test(name);
  const pathOf = (parent, name) => `${NODEFS.realPath(parent)}/${name}`;
  for (const name of ['mknod', 'unlink', 'rmdir', 'rename']) {
    const act = NODEFS.node_ops[name];
    NODEFS.node_ops[name] = (first, second, ...rest) => {
      // Nodes that are made or removed are named by their parent; one that is renamed is itself given.
      const [parent, own] = name === 'rename' ? [first.parent, first.name] : [first, second];
      const path = isUnfinished(own) ? pathOf(parent, own) : undefined;
      if (path && name === 'mknod') parentPort.postMessage({ made: path });
      const result = act(first, second, ...rest);
      if (path && name !== 'mknod') parentPort.postMessage({ gone: path });
      return result;
    };
  }
  for (const name of readdirSync('/')) {
    const path = `/${name}`;
    if (['dev', 'proc', 'sys'].includes(name) || !statSync(path, { throwIfNoEntry: false })?.isDirectory()) continue;
    FS.mkdirTree(path);
    FS.mount(NODEFS, { root: path }, path);
  }
  FS.chdir(process.cwd());
}

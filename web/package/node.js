// The entry for Node.js.

import { readFile } from 'node:fs/promises';
import { availableParallelism, cpus } from 'node:os';
import { Worker } from 'node:worker_threads';
import { fileURLToPath } from 'node:url';

import { LamellaError, usePlatform } from './api.js';
import { canShare, compile } from './memory.js';

const shared = canShare();

/** Bundlers move this script away from the other files of the package. */
function missing(name) {
  const advice = 'the files *.js and *.wasm of the package lamella have to be beside the script that runs, or the bundler has to leave the package out (docs/javascript.md, Bundlers)';
  return new LamellaError(`${name} is missing beside ${fileURLToPath(import.meta.url)}: ${advice}`, 2);
}

usePlatform({
  processors: availableParallelism?.() ?? cpus().length,
  shared,
  async loadModule() {
    const bytes = await readFile(new URL('./lamella.wasm', import.meta.url)).catch((error) => {
      throw error.code === 'ENOENT' ? missing('lamella.wasm') : error;
    });
    return compile(bytes, shared);
  },
  startWorker(module, onMessage, onFailure) {
    // Bundlers find the worker where it is written like this.
    const worker = new Worker(new URL('./node_worker.js', import.meta.url), { workerData: { module, shared } });
    worker.on('message', onMessage);
    worker.on('error', (error) => onFailure(/MODULE_NOT_FOUND$/.test(error.code) ? missing('node_worker.js') : error));
    worker.unref();
    return {
      post: (message, transfer) => worker.postMessage(message, transfer),
      // A program ends once nothing is computed.
      hold: (busy) => (busy ? worker.ref() : worker.unref()),
      end: () => worker.terminate(),
    };
  },
});

export * from './api.js';

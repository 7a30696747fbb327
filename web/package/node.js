// The entry for Node.js.

import { readFile } from 'node:fs/promises';
import { availableParallelism, cpus } from 'node:os';
import { Worker } from 'node:worker_threads';

import { usePlatform } from './api.js';
import { canShare, compile } from './memory.js';

const shared = canShare();

usePlatform({
  processors: availableParallelism?.() ?? cpus().length,
  shared,
  loadModule: async () => compile(await readFile(new URL('./lamella.wasm', import.meta.url)), shared),
  startWorker(module, onMessage, onFailure) {
    const worker = new Worker(new URL('./node_worker.js', import.meta.url), { workerData: { module, shared } });
    worker.on('message', onMessage);
    worker.on('error', onFailure);
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

// The entry for browsers.

import { usePlatform } from './api.js';
import { canShare, compile } from './memory.js';

const shared = canShare();

usePlatform({
  processors: navigator.hardwareConcurrency || 1,
  shared,
  async loadModule() {
    const response = fetch(new URL('./lamella.wasm', import.meta.url));
    return shared ? compile(new Uint8Array(await (await response).arrayBuffer()), true) : WebAssembly.compileStreaming(response);
  },
  startWorker(module, onMessage, onFailure) {
    const worker = new Worker(new URL('./browser_worker.js', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = (event) => onFailure(new Error(event.message || 'the worker could not be started'));
    worker.postMessage({ module, shared });
    return { post: (message, transfer) => worker.postMessage(message, transfer), hold() {}, end: () => worker.terminate() };
  },
});

export * from './api.js';

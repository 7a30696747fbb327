// The entry for browsers.

import { usePlatform } from './api.js';

usePlatform({
  workers: navigator.hardwareConcurrency || 1,
  loadModule: () => WebAssembly.compileStreaming(fetch(new URL('./lamella.wasm', import.meta.url))),
  startWorker(module, onMessage, onFailure) {
    const worker = new Worker(new URL('./browser_worker.js', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = (event) => onFailure(new Error(event.message || 'the worker could not be started'));
    worker.postMessage({ module });
    return { post: (message, transfer) => worker.postMessage(message, transfer), hold() {}, end: () => worker.terminate() };
  },
});

export * from './api.js';

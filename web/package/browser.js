// The entry for browsers.

import { LamellaError, usePlatform } from './api.js';
import { canShare, compile } from './memory.js';

const shared = canShare();
const advice = 'the files *.js and *.wasm of the package lamella have to be beside the script that is loaded (docs/javascript.md, Bundlers)';

async function loadModule() {
  const address = new URL('./lamella.wasm', import.meta.url).href;
  const response = await fetch(address).catch((error) => {
    throw new LamellaError(`${address} cannot be loaded (${error.message}): ${advice}`, 2);
  });
  if (!response.ok) throw new LamellaError(`${address} cannot be loaded (${response.status} ${response.statusText}): ${advice}`, 2);
  const isWasm = response.headers.get('content-type')?.startsWith('application/wasm');
  if (isWasm && !shared) return WebAssembly.compileStreaming(response);
  const bytes = new Uint8Array(await response.arrayBuffer());
  // Servers of one-page applications answer with their page.
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== '\0asm') throw new LamellaError(`${address} is no WebAssembly: ${advice}`, 2);
  return compile(bytes, shared);
}

usePlatform({
  processors: navigator.hardwareConcurrency || 1,
  shared,
  loadModule,
  startWorker(module, onMessage, onFailure) {
    // Bundlers find the worker where it is written like this.
    const worker = new Worker(new URL('./browser_worker.js', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    // An error without a text is that of a script that could not be loaded.
    worker.onerror = (event) => onFailure(event.message ? new Error(event.message) : new LamellaError(`browser_worker.js cannot be loaded: ${advice}`, 2));
    worker.postMessage({ module, shared });
    return { post: (message, transfer) => worker.postMessage(message, transfer), hold() {}, end: () => worker.terminate() };
  },
});

export * from './api.js';

// The worker in which the program runs, of a browser. Its first message has the module of WebAssembly.

import createLamellaIn from './lamella.js';
import { answering } from './program.js';

function startThread() {
  return new Worker(new URL('./browser_thread.js', import.meta.url), { type: 'module' });
}

let answer;
self.onmessage = ({ data }) => {
  const post = (message, transfer = []) => self.postMessage(message, transfer);
  if (data.module) answer = answering(post, createLamellaIn({ Worker: startThread }), data);
  else answer(data);
};

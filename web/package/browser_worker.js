// The worker in which the program runs, of a browser. Its first message is the module of WebAssembly.

import createLamellaIn from './lamella.js';
import { answering } from './program.js';

let answer;
self.onmessage = ({ data }) => {
  if (data.module) answer = answering((message, transfer = []) => self.postMessage(message, transfer), createLamellaIn(), data.module);
  else answer(data);
};

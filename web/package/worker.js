// The worker in which the program runs: of node:worker_threads or of a browser.

import createLamellaIn from './lamella.js';
import { answering } from './program.js';

const isNode = typeof process !== 'undefined' && Boolean(process.versions?.node);
if (isNode) {
  const { parentPort, workerData } = await import('node:worker_threads');
  const { createRequire } = await import('node:module');
  const { SOURCE_DATE_EPOCH } = process.env; // a date for files that store one
  const create = createLamellaIn(createRequire(import.meta.url), '', '');
  const post = (message, transfer) => parentPort.postMessage(message, transfer);
  const answer = answering(post, create, workerData, SOURCE_DATE_EPOCH === undefined ? {} : { SOURCE_DATE_EPOCH });
  parentPort.on('message', answer);
} else {
  const post = (message, transfer = []) => self.postMessage(message, transfer);
  let answer;
  self.onmessage = ({ data }) => {
    if (data.module) answer = answering(post, createLamellaIn(), data.module);
    else answer(data);
  };
}

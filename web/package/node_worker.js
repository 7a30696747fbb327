// The worker in which the program runs, of node:worker_threads.

import { createRequire } from 'node:module';
import { Worker, parentPort, workerData } from 'node:worker_threads';

import createLamellaIn from './lamella.js';
import { answering } from './program.js';

class Thread extends Worker {
  constructor() {
    super(new URL('./node_thread.js', import.meta.url));
  }
}

const { SOURCE_DATE_EPOCH } = process.env; // a date for files that store one
const create = createLamellaIn({ require: createRequire(import.meta.url), Worker: Thread });
const post = (message, transfer) => parentPort.postMessage(message, transfer);
parentPort.on('message', answering(post, create, workerData, SOURCE_DATE_EPOCH === undefined ? {} : { SOURCE_DATE_EPOCH }));

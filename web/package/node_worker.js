// The worker in which the program runs, of node:worker_threads.

import { createRequire } from 'node:module';
import { parentPort, workerData } from 'node:worker_threads';

import createLamellaIn from './lamella.js';
import { answering } from './program.js';

const { SOURCE_DATE_EPOCH } = process.env; // a date for files that store one
const create = createLamellaIn(createRequire(import.meta.url), '', '');
const post = (message, transfer) => parentPort.postMessage(message, transfer);
parentPort.on('message', answering(post, create, workerData, SOURCE_DATE_EPOCH === undefined ? {} : { SOURCE_DATE_EPOCH }));

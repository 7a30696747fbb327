// A thread of the program, of node:worker_threads.

import { createRequire } from 'node:module';

import createLamellaIn, { runThread } from './lamella.js';

const require = createRequire(import.meta.url);
runThread(createLamellaIn({ require }), require);

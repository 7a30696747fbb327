// A thread of the program, of a browser.

import createLamellaIn, { runThread } from './lamella.js';

runThread(createLamellaIn({}));

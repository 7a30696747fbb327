// The worker of the playground, one script.

import createLamellaIn from 'lamella.js';
import { answering } from '../package/program.js';

let answer;
self.onmessage = ({ data }) => {
  if (data.module) answer = answering((message, transfer = []) => self.postMessage(message, transfer), createLamellaIn(), data.module);
  else answer(data);
};

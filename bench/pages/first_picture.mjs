// How long pages take in Chromium from going there to the first layer on the screen, and to the first picture of the
// stack: node first_picture.mjs ROUNDS PAGE... (with playwright-core beside it), JSON on standard output.

import { existsSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [rounds, ...pages] = process.argv.slice(2);
const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!executablePath) throw new Error("no browser: install Debian's chromium");
// Without a graphics card, so that figures are the machine's; root needs --no-sandbox.
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });

/** Milliseconds of one visit, in a window of 1400 by 900 pixels that shows the layer and the stack. */
async function visit(path) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, offline: true });
  const page = await context.newPage();
  await page.goto(pathToFileURL(path).href, { waitUntil: 'commit' });
  await page.waitForSelector('canvas[data-ready]', { timeout: 120000 });
  const marks = await page.evaluate(() => Object.fromEntries(performance.getEntriesByType('mark').map(({ name, startTime }) => [name, startTime])));
  await context.close();
  return { layer: marks['first picture'], stack: marks['first picture of the stack'] };
}

const visits = {};
for (let round = 0; round < Number(rounds); ++round)
  for (const path of pages) (visits[path] ??= []).push(await visit(path));
await browser.close();
console.log(JSON.stringify(visits));

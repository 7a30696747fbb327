// How long the playground takes in Chromium: node browser.mjs PLAYGROUND ROUNDS FILE LAYER_HEIGHT (with playwright-core
// beside it), seconds as JSON on standard output.

import { existsSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [playground, rounds, file, layerHeight] = process.argv.slice(2);
const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!executablePath) throw new Error("no browser: install Debian's chromium");
// Without a graphics card, so that figures are the machine's; root needs --no-sandbox.
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });

/** In the page: ms until its first paint. */
const firstPaint = () =>
  new Promise((resolve) => new PerformanceObserver((list) => resolve(list.getEntries()[0].startTime)).observe({ type: 'paint', buffered: true }));

/** In the page: has `begun` when it is given a file, and `firstLayers` ms later, when it shows layers. */
function watch() {
  const element = (id) => document.getElementById(id);
  element('file').addEventListener('change', () => (window.begun = performance.now()), { capture: true, once: true });
  window.firstLayers = new Promise((resolve) =>
    new MutationObserver(() => {
      if (!element('preview').hidden || !element('viewer').hidden) requestAnimationFrame(() => resolve(performance.now() - window.begun));
    }).observe(document.body, { subtree: true, attributes: true }),
  );
}

/** One visit: the first paint, and after a file is given the first layers, all layers, and the viewer with all of them. */
async function visit() {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, offline: true });
  const page = await context.newPage();
  page.setDefaultTimeout(300000);
  await page.goto(`${pathToFileURL(playground).href}#layerHeight=${layerHeight}`);
  const times = { paint: (await page.evaluate(firstPaint)) / 1000 };
  // The time in the page begins when it is given the file, which a browser's driver hands over in its own time.
  await page.evaluate(watch);
  await page.locator('#file').setInputFiles(file);
  times.first = (await page.evaluate(() => window.firstLayers)) / 1000;
  const since = () => page.evaluate(() => (performance.now() - window.begun) / 1000);
  await page.getByText('Sliced.').waitFor();
  times.sliced = await since();
  await page.frameLocator('#viewer').locator('canvas[data-layer]').first().waitFor();
  times.viewer = await since();
  await context.close();
  return times;
}

const visits = [];
for (let round = 0; round < Number(rounds); ++round) visits.push(await visit());
await browser.close();
console.log(JSON.stringify(visits));

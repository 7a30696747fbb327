// What the tests in the browser share: pages made by the program, opened from disk without a network.

import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const program = process.env.LAMELLA_PROGRAM;
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

export const folder = mkdtempSync(join(tmpdir(), 'lamella-viewer-'));
export const file = (name) => join(folder, name);
export const lamella = (...args) => execFileSync(program, args, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });

let browser;
let page; // one for all: to make one takes a browser longer than to open a file in it
let complaints = []; // of what is open in it

export async function startBrowser() {
  if (!browserPath) throw new Error('no browser: install Debian\'s chromium');
  // Drawing in space must not depend on a graphics card; root needs --no-sandbox.
  browser = await chromium.launch({ executablePath: browserPath, args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--disable-lcd-text'] });
  const context = await browser.newContext({ offline: true, reducedMotion: 'reduce' });
  page = await context.newPage();
  page.setDefaultTimeout(120000); // a picture in space takes a processor seconds, and others may be at work
  // What was chosen in the file before is forgotten.
  await page.addInitScript(() => {
    if (location.protocol === 'file:') localStorage.clear();
  });
  page.on('console', (message) => {
    // What the driver of the software renderer says of itself.
    if (!message.text().includes('GL Driver Message')) complaints.push(`${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(error.stack));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asks for ${request.url()}`);
  });
}
export async function stopBrowser() {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}

const narrow = 1000; // pixels: such a page begins with the layer alone

/**
 * Opens a page of the folder, in the place of the one before. Everything that it says on the console, all its errors, and
 * all that it asks a network for is gathered in `complaints`.
 * @param {{view: 'layer'|'stack'|null}} options what is seen of layers; null: what the page itself begins with. A stack that
 *     nobody asks for is not begun: without a graphics card it takes the processor longer than all the rest.
 */
export async function open(name, { width = 1400, height = 900, colorScheme = 'light', view = 'layer' } = {}) {
  await page.goto('about:blank'); // so that none of the page before counts
  complaints = [];
  await page.emulateMedia({ colorScheme });
  await page.setViewportSize({ width: view ? narrow : width, height });
  await page.goto(addressOf(name));
  await page.waitForSelector('canvas[data-layer], canvas[data-ready], .trouble');
  if (view) {
    await page.setViewportSize({ width, height });
    await redrawn();
  }
  if (view === 'stack') {
    const button = page.locator('#views').getByRole('button', { name: 'stack' });
    await button.click();
    await button.blur(); // keys are for the page again
  }
  return { page, complaints };
}

/** Of a page of the folder; "name.html#layer=3" is a layer of it. */
function addressOf(name) {
  const [path, ...rest] = name.split('#');
  return [pathToFileURL(file(path)).href, ...rest].join('#');
}

/** Opens a page of the folder in a browser of its own kind. @param {(page) => Promise} prepare what is done to it before */
async function openAlone(name, options, prepare = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, offline: true, reducedMotion: 'reduce', ...options });
  const other = await context.newPage();
  other.setDefaultTimeout(120000);
  await prepare(other);
  await other.goto(addressOf(name));
  await other.waitForSelector('canvas[data-layer]');
  return other;
}

/** Opens a page of the folder where nothing can be drawn in space. */
export const openWithoutWebGL = (name) =>
  openAlone(name, {}, (page) =>
    page.addInitScript(() => {
      const { getContext } = HTMLCanvasElement.prototype;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
      };
    }),
  );

/**
 * Opens a page of the folder on a small screen with fingers.
 * @returns `swipe(from, to)` moves fingers from some positions to as many others, and lets them go
 */
export async function openOnPhone(name) {
  const phone = await openAlone(name, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const session = await phone.context().newCDPSession(phone);
  const touch = (type, positions) => session.send('Input.dispatchTouchEvent', { type, touchPoints: positions.map(([x, y], id) => ({ x, y, id })) });
  const swipe = async (from, to, steps = 12) => {
    await touch('touchStart', from);
    for (let i = 1; i <= steps; ++i) {
      await touch('touchMove', from.map((p, k) => p.map((value, at) => value + ((to[k][at] - value) * i) / steps)));
      await phone.waitForTimeout(16);
    }
    await touch('touchEnd', []);
    await phone.waitForTimeout(500); // what goes on scrolling comes to rest
  };
  return { page: phone, swipe };
}

/** Opens a drawing of the folder; `address` may name a part of it behind #. */
export async function openDrawing(address) {
  await page.goto('about:blank');
  await page.goto(addressOf(address));
  return { page };
}

/** Waits until what was asked for is drawn: a page draws the layer in the next frame. */
export const redrawn = () => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve()))));

/** Waits until holds() is true in the page. (Playwright's own way takes eval, which the page forbids.) */
export async function until(page, holds, seconds = 60) {
  for (const end = Date.now() + 1000 * seconds; !(await page.evaluate(holds)); await page.waitForTimeout(30))
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${holds}`);
}

/** The layer that is drawn, counted from the lowest one, 0, once it is the one that is asked for. */
export async function shown(page) {
  await until(page, () => document.querySelector('canvas[data-layer]').dataset.layer === document.getElementById('layer').value);
  return Number(await page.locator('canvas[data-layer]').getAttribute('data-layer'));
}

/** Waits until the stack, or the mesh, is drawn as it is to stay. */
export const settled = (page) => page.waitForSelector('canvas[data-settled]');

/**
 * Opens a page of the folder, alone and as new, and acts in it.
 * @returns {Promise<{work: number, whole: number}[]>} all that its thread did meanwhile, one task after the other: seconds
 *     of the processor, and seconds from begin to end
 */
export async function tasks(name, act) {
  await page.goto('about:blank'); // it would be recorded, too
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, offline: true });
  const fresh = await context.newPage();
  fresh.setDefaultTimeout(300000);
  const session = await context.newCDPSession(fresh);
  const events = [];
  session.on('Tracing.dataCollected', ({ value }) => value.forEach((event) => events.push(event)));
  await session.send('Tracing.start', { traceConfig: { includedCategories: ['toplevel', '__metadata'], excludedCategories: ['*'] } });
  await fresh.goto(pathToFileURL(file(name)).href, { waitUntil: 'commit' });
  await act(fresh);
  const ended = new Promise((resolve) => session.once('Tracing.tracingComplete', resolve));
  await session.send('Tracing.end');
  await ended;
  await context.close();
  const mains = new Set(events.filter(({ ph, args }) => ph === 'M' && args.name === 'CrRendererMain').map(({ pid, tid }) => `${pid} ${tid}`));
  // A task that the end of the record cuts off has no figures.
  return events
    .filter(({ name, pid, tid, tdur }) => name === 'ThreadControllerImpl::RunTask' && mains.has(`${pid} ${tid}`) && tdur !== undefined)
    .map(({ tdur, dur }) => ({ work: tdur / 1e6, whole: dur / 1e6 }));
}

/**
 * Counts the pixels of a canvas that are near a colour.
 * @param {number[]} colour 0 to 255
 */
export async function pixelsNear(canvas, colour, within = 40) {
  return canvas.evaluate(
    (node, [colour, within]) => {
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [node.width, node.height];
      const ctx = copy.getContext('2d');
      ctx.drawImage(node, 0, 0);
      const { data } = ctx.getImageData(0, 0, copy.width, copy.height);
      let near = 0;
      for (let i = 0; i < data.length; i += 4)
        if (Math.abs(data[i] - colour[0]) + Math.abs(data[i + 1] - colour[1]) + Math.abs(data[i + 2] - colour[2]) <= within) ++near;
      return { near, all: copy.width * copy.height };
    },
    [colour, within],
  );
}

// The playground and the package in Chromium, without a network: LAMELLA_PROGRAM, LAMELLA_PACKAGE, LAMELLA_PLAYGROUND.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, normalize } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { compare, scaleOf } from './drawing.mjs';

const program = process.env.LAMELLA_PROGRAM;
const packageFolder = process.env.LAMELLA_PACKAGE;
const playground = pathToFileURL(process.env.LAMELLA_PLAYGROUND).href;
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
const folder = mkdtempSync(join(tmpdir(), 'lamella-playground-'));
const native = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });

let browser;
before(async () => {
  if (!browserPath) throw new Error("no browser: install Debian's chromium");
  // Drawing in space must not depend on a graphics card; root needs --no-sandbox.
  browser = await chromium.launch({ executablePath: browserPath, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Opens the playground from disk; all that it complains of or asks a network for is gathered. */
async function open(hash = '', options = {}) {
  const context = await browser.newContext({ offline: true, viewport: { width: 1400, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  const complaints = [];
  page.on('console', (message) => message.text().includes('GL Driver Message') || complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.stack));
  page.on('request', (request) => /^(file|data|blob|about):/.test(request.url()) || complaints.push(`asks for ${request.url()}`));
  await page.goto(playground + hash);
  return { page, complaints, close: () => context.close() };
}

const layersOf = async (page) => {
  const frame = page.frameLocator('#viewer');
  await frame.locator('canvas[data-layer]').first().waitFor();
  return frame;
};
/** A phone shows either settings or layers, so the text may be hidden. */
const sliced = (page) => page.getByText(/^(Sliced|Read)\.$/).waitFor({ state: 'attached' });

test('a test body is sliced and shown, and its link keeps the settings', async () => {
  const { page, complaints, close } = await open();
  await page.locator('[name=layerHeight]').fill('0.5');
  await page.locator('#body').selectOption('rook');
  await sliced(page);
  const frame = await layersOf(page);
  assert.match(await frame.locator('#title').textContent(), /rook/);
  assert.match(await page.locator('#times').textContent(), /layers106/);
  assert.match(page.url(), /layerHeight=0.5/);
  assert.match(page.url(), /body=rook/);
  const again = await open(new URL(page.url()).hash);
  await sliced(again.page);
  assert.match(await again.page.locator('#times').textContent(), /layers106/);
  await page.getByRole('button', { name: 'Diagnosis of the mesh' }).click();
  await frame.locator('canvas[data-ready]').first().waitFor();
  assert.deepEqual([...complaints, ...again.complaints], []);
  await again.close();
  await close();
});

test('a dropped file is sliced into the bytes of the program', async () => {
  native('make', 'torus', '-o', 'torus.stl');
  native('slice', 'torus.stl', '-o', 'torus.cli', '--layer-height', '1', '--rotate-x', '90');
  const { page, complaints, close } = await open('#layerHeight=1&rotateX=90');
  await page.locator('#file').setInputFiles(join(folder, 'torus.stl'));
  await sliced(page);
  await page.locator('#format').selectOption('cli');
  const coming = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save' }).click();
  const download = await coming;
  assert.equal(download.suggestedFilename(), 'torus.cli');
  assert.ok(Buffer.compare(readFileSync(await download.path()), readFileSync(join(folder, 'torus.cli'))) === 0);
  assert.deepEqual(complaints, []);
  await close();
});

test('a slice file and scan vectors are shown', async () => {
  native('make', 'box', '-o', 'box.stl');
  native('slice', 'box.stl', '-o', 'box.cli', '--layer-height', '1');
  const { page, complaints, close } = await open('#layerHeight=1');
  await page.locator('#file').setInputFiles(join(folder, 'box.cli'));
  await sliced(page);
  await layersOf(page);
  await page.getByText('Scan vectors', { exact: true }).click();
  await page.locator('#body').selectOption('box');
  await sliced(page);
  await page.locator('[name=scan]').check();
  await page.locator('#format option[value=ilt]').waitFor({ state: 'attached' });
  await page.frameLocator('#viewer').getByRole('button', { name: /core hatch/ }).first().waitFor();
  assert.deepEqual(complaints, []);
  await close();
});

test('a broken file gives the error of the program, and the page goes on', async () => {
  const { page, close } = await open();
  for (const [name, content] of [['bad.stl', 'solid\nfacet\n'], ['empty.stl', '']]) {
    writeFileSync(join(folder, name), content);
    await page.locator('#file').setInputFiles(join(folder, name));
    await page.locator('#error:not(:empty)').waitFor();
    const text = await page.locator('#error').textContent();
    assert.match(text, new RegExp(`^${name}`));
    await page.locator('#body').selectOption('box');
    await sliced(page);
    assert.equal(await page.locator('#error').textContent(), '');
  }
  await close();
});

test('a million triangles are shown, layer by layer while they come', async () => {
  native('make', 'lattice', '--cells', '13', '-o', 'million.stl');
  const { page, complaints, close } = await open('#layerHeight=0.1');
  // The preview may be there for a moment only.
  await page.evaluate(() => {
    const preview = document.getElementById('preview');
    new MutationObserver(() => {
      if (!preview.hidden) window.statusOfPreview ??= document.getElementById('status').textContent;
    }).observe(preview, { attributes: true, attributeFilter: ['hidden'] });
  });
  await page.locator('#file').setInputFiles(join(folder, 'million.stl'));
  await sliced(page);
  assert.match(await page.evaluate(() => window.statusOfPreview), / …$/);
  const drawn = await page.locator('#preview').evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return data.some((value) => value > 0);
  });
  assert.ok(drawn);
  await layersOf(page);
  assert.match(await page.locator('#input').textContent(), /^million\.stl: 1,\d{3},\d{3} triangles, /);
  assert.ok(await page.locator('#preview').isHidden());
  assert.deepEqual(complaints, []);
  await close();
});

test('what is drawn while layers come has the outline of the part', async () => {
  native('make', 'box', '--size', '20,30,40', '-o', 'coming.stl');
  const { page, close } = await open('#layerHeight=0.002');
  // The viewer would take its place.
  await page.evaluate(() => new MutationObserver(() => (document.getElementById('preview').hidden = false)).observe(document.getElementById('preview'), { attributes: true }));
  await page.locator('#file').setInputFiles(join(folder, 'coming.stl'));
  await sliced(page);
  const { width, height, ...box } = await page.locator('#preview').evaluate((canvas) => {
    const { data, width, height } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let [left, right, top, bottom] = [width, 0, height, 0];
    for (let i = 0; i < width * height; ++i)
      if (data[4 * i + 3] > 0) {
        left = Math.min(left, i % width);
        right = Math.max(right, (i % width) + 1);
        top = Math.min(top, Math.floor(i / width));
        bottom = Math.max(bottom, Math.floor(i / width) + 1);
      }
    return { width, height, left, right, top, bottom };
  });
  // From a corner, a box of 20 x 30 x 40 mm is 43.5 wide and 55.1 high.
  const ratio = (box.right - box.left) / (box.bottom - box.top);
  assert.ok(Math.abs(ratio - 43.5 / 55.1) < 0.02, `${ratio}`);
  assert.ok(Math.abs((box.bottom - box.top) / height - 0.86) < 0.02);
  assert.ok(Math.abs((box.left + box.right - width) / width) < 0.01);
  await close();
});

test('a layer looks as the raster of the program sees it', async () => {
  native('make', 'rook', '-o', 'drawn.stl');
  native('slice', 'drawn.stl', '--layer-height', '0.5', '-o', 'drawn', '--format', 'png', '--pixel-size', '0.02', '--antialias', '1');
  for (const colorScheme of ['light', 'dark']) {
    const { page, close } = await open('#layerHeight=0.5', { colorScheme });
    await page.locator('#file').setInputFiles(join(folder, 'drawn.stl'));
    await sliced(page);
    const shown = await layersOf(page);
    const frame = page.frames().find((each) => each !== page.mainFrame());
    for (const name of ['Contours', 'Direction']) await shown.getByRole('button', { name, exact: true }).click();
    const tools = await shown.locator('.pane:has(canvas[data-layer]) .tools').evaluate((node) => node.offsetTop + node.offsetHeight);
    for (const layer of [0, 50, 105]) {
      await shown.locator('#layer').fill(String(layer));
      await shown.locator(`canvas[data-layer="${layer}"]`).waitFor();
      await frame.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      const picture = join(folder, 'drawn', `${String(layer).padStart(5, '0')}.png`);
      const { filled, different, wrong } = await compare(frame, picture, 0.02, await scaleOf(frame), tools / 2);
      const where = `layer ${layer}, ${colorScheme}: ${different} of ${filled} pixels`;
      assert.ok(filled > 5000, where);
      assert.equal(wrong, 0, where);
      assert.ok(different < 0.02 * filled, where);
    }
    await close();
  }
});

test('several files make a plate, and overlapping boxes are reported', async () => {
  native('make', 'box', '-o', 'one.stl');
  native('make', 'rook', '-o', 'two.stl');
  native('make', 'torus', '--translate', '100,0,0', '-o', 'three.ply');
  native('slice', 'one.stl', 'two.stl', 'three.ply', '-o', 'plate.cli', '--layer-height', '1');
  const { page, complaints, close } = await open('#layerHeight=1');
  await page.locator('#file').setInputFiles(['one.stl', 'two.stl', 'three.ply'].map((name) => join(folder, name)));
  await sliced(page);
  assert.match(await page.locator('#input').textContent(), /^one.stl, two.stl, three.ply: /);
  assert.match(await page.locator('#warnings').textContent(), /boxes of one and two overlap/);
  const coming = page.waitForEvent('download');
  await page.locator('#format').selectOption('cli');
  await page.getByRole('button', { name: 'Save' }).click();
  assert.ok(Buffer.compare(readFileSync(await (await coming).path()), readFileSync(join(folder, 'plate.cli'))) === 0);
  assert.deepEqual(complaints, []);
  await close();
});

/** The viewer that is seen: its frame, as playwright's frames are. */
const frameOf = async (page) => (await page.locator('#viewer').elementHandle()).contentFrame();
const layerOf = (page) => page.frameLocator('#viewer').locator('#layer').inputValue();
const timesOf = (page) => page.locator('#times').textContent();
/** Changes a setting, and waits until the layers of it are there. */
async function change(page, name, value) {
  await page.evaluate(() => (document.getElementById('status').textContent = ''));
  const field = page.locator(`[name=${name}]`);
  if ((await field.evaluate((one) => one.localName)) === 'select') await field.selectOption(value);
  else {
    await field.fill(value);
    await field.blur();
  }
  await sliced(page);
}

test('the same file can be opened again', async () => {
  native('make', 'rook', '-o', 'again.stl');
  const { page, complaints, close } = await open('#layerHeight=1');
  for (let i = 0; i < 2; ++i) {
    await page.locator('#file').setInputFiles(join(folder, 'again.stl'));
    await page.locator('#input', { hasText: /^again.stl: [\d,]+ triangles/ }).waitFor();
    assert.equal(await page.locator('#file').inputValue(), '');
    await page.locator('#body').selectOption('box');
    await page.locator('#input', { hasText: /^box.stl: 12 triangles/ }).waitFor();
  }
  assert.deepEqual(complaints, []);
  await close();
});

test('a file that is dropped on the viewer is sliced', async () => {
  const { page, complaints, close } = await open('#layerHeight=1&body=box');
  await sliced(page);
  native('make', 'rook', '-o', 'dropped.stl');
  const bytes = readFileSync(join(folder, 'dropped.stl')).toString('base64');
  await (await frameOf(page)).evaluate((text) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], 'dropped.stl'));
    for (const kind of ['dragover', 'drop']) {
      const event = new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true });
      if (document.body.dispatchEvent(event)) throw new Error(`${kind} is left to the browser`);
    }
  }, bytes);
  await page.locator('#input', { hasText: /^dropped.stl: [\d,]+ triangles/ }).waitFor();
  assert.deepEqual(complaints, []);
  await close();
});

test('the viewer keeps height, view and look from run to run, and forgets where it was in another part', async () => {
  const { page, complaints, close } = await open('#layerHeight=0.2&body=rook');
  await sliced(page);
  const frame = await layersOf(page);
  const stateOf = async () => {
    const view = await layersOf(page);
    return {
      z: Number(await view.locator('.height input').inputValue()),
      scale: await view.locator('.scale span').textContent(),
      contours: await view.getByRole('button', { name: 'Contours', exact: true }).getAttribute('aria-pressed'),
      theme: await view.locator('html').getAttribute('data-theme'),
    };
  };
  await frame.locator('#layer').fill('10');
  await frame.getByRole('button', { name: 'Contours', exact: true }).click();
  await frame.locator('#theme').click();
  for (let i = 0; i < 3; ++i) await frame.locator('canvas[data-layer]').press('+');
  const before = await stateOf();
  assert.equal(before.z, 2.1);
  assert.equal(before.contours, 'false');
  assert.equal(await page.locator('html').getAttribute('data-theme'), before.theme);
  await change(page, 'layerHeight', '0.25');
  const after = await stateOf();
  assert.ok(Math.abs(after.z - before.z) <= 0.125, `z = ${after.z} mm`);
  assert.deepEqual({ ...after, z: 0 }, { ...before, z: 0 });
  const mesh = page.locator('#viewer[title="The mesh and its defects"]');
  await page.getByRole('button', { name: 'Diagnosis of the mesh' }).click();
  await mesh.waitFor();
  await page.locator('#views [data-view=layers]').click();
  await mesh.waitFor({ state: 'detached' });
  await page.frameLocator('#viewer').locator('canvas[data-layer]').first().waitFor();
  assert.deepEqual(await stateOf(), after);
  await page.locator('#body').selectOption('box');
  await page.locator('#input', { hasText: /^box.stl: 12/ }).waitFor();
  const other = await stateOf();
  assert.ok(other.z > 4, `z = ${other.z} mm`);
  assert.equal(other.theme, before.theme);
  assert.deepEqual(complaints, []);
  await close();
});

test('whoever goes back to the layers while the mesh is diagnosed stays there', async () => {
  const { page, close } = await open('#layerHeight=2&body=head');
  await sliced(page);
  await layersOf(page);
  await page.getByRole('button', { name: 'Diagnosis of the mesh' }).click();
  await page.locator('#views [data-view=layers]').click();
  await page.locator('#cancel').waitFor({ state: 'hidden' });
  await layersOf(page);
  assert.equal(await page.locator('#viewer').getAttribute('title'), 'Layers');
  await close();
});

test('an invalid value is named where it stands, also in a folded section, and nothing is called sliced', async () => {
  const { page, complaints, close } = await open('#layerHeight=1&body=box');
  await sliced(page);
  const section = page.locator('details', { has: page.locator('[name=minArea]') });
  await section.locator('summary').click();
  await page.locator('[name=minArea]').fill('-3');
  await page.locator('[name=minArea]').blur();
  assert.equal(await section.locator('.fault').textContent(), 'the least is 0');
  await section.locator('summary').click();
  assert.match(await section.getAttribute('class'), /wrong/);
  assert.match(await page.locator('#error').textContent(), /“Drop areas below”: the least is 0/);
  assert.match(await page.locator('#status').textContent(), /of the settings before/);
  await page.locator('#slice').click();
  assert.equal(await page.evaluate(() => document.activeElement.name), 'minArea');
  assert.ok(await page.locator('[name=minArea]').isVisible());
  await change(page, 'minArea', '');
  assert.equal(await page.locator('.fault').count(), 0);
  assert.equal(await page.locator('#error').textContent(), '');
  for (const [name, value] of [['layerHeight', '0'], ['layerHeight', '-1'], ['layerHeight', ''], ['copies', '1.5'], ['scale', '0'], ['adaptiveMin', '0.1']]) {
    await page.evaluate((name) => document.querySelector(`[name=${name}]`).closest('details')?.setAttribute('open', ''), name);
    const before = await page.locator(`[name=${name}]`).inputValue();
    await page.locator(`[name=${name}]`).fill(value);
    await page.locator(`[name=${name}]`).blur();
    assert.ok((await page.locator('.fault').count()) > 0, `${name} ${value}`);
    assert.doesNotMatch(await page.locator('#status').textContent(), /Sliced/);
    await change(page, name, before);
  }
  assert.deepEqual(complaints, []);
  await close();
});

test('messages use the words of the page, and a pattern needs no order of clicks', async () => {
  const { page, complaints, close } = await open('#layerHeight=1&body=box&pattern=chessboard');
  await sliced(page);
  assert.ok(await page.locator('[name=pattern]').isDisabled());
  await page.locator('[name=scan]').check();
  await page.locator('#format option[value=ilt]').waitFor({ state: 'attached' });
  assert.equal(await page.locator('#warnings').textContent(), '');
  await page.locator('#format').selectOption('svg');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.locator('#warnings li').first().waitFor();
  const warnings = await page.locator('#warnings').textContent();
  assert.match(warnings, /^box.svg: /);
  assert.doesNotMatch(warnings, /--|out\//);
  await page.evaluate(() => {
    const one = document.querySelector('[name=layerHeight]');
    one.min = '';
    one.value = '1e-12';
    one.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await page.locator('#error:not(:empty)').waitFor();
  assert.doesNotMatch(await page.locator('#error').textContent(), /--/);
  assert.deepEqual(complaints, []);
  await close();
});

test('nothing scrolls by itself, and on a phone settings and layers take turns', async () => {
  for (const viewport of [{ width: 390, height: 844 }, { width: 700, height: 410 }]) {
    const { page, complaints, close } = await open('', { viewport });
    await page.locator('#body').selectOption('box');
    await page.locator('main[data-pane=layers]').waitFor();
    const inView = async (name) => {
      const { x, y, width, height } = await page.locator(name).boundingBox();
      return x >= 0 && y >= 0 && x + width <= viewport.width && y + height <= viewport.height + 1;
    };
    assert.ok(await inView('#viewer'));
    await page.getByRole('button', { name: 'Settings' }).click();
    await page.locator('details', { has: page.locator('[name=orient]') }).locator('summary').click();
    await page.locator('[name=orient]').scrollIntoViewIfNeeded();
    const scrolls = () => page.evaluate(() => [scrollX, scrollY, document.getElementById('settings').scrollTop]);
    const before = await scrolls();
    await page.evaluate(() => (document.getElementById('status').textContent = ''));
    await page.locator('[name=orient]').check();
    await sliced(page);
    assert.deepEqual(await scrolls(), before);
    assert.equal(await page.locator('main').getAttribute('data-pane'), 'settings');
    assert.deepEqual(await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]), [viewport.width, viewport.height]);
    assert.deepEqual(complaints, []);
    await close();
  }
});

test('a link that is pasted into the open page is followed', async () => {
  const { page, complaints, close } = await open('#layerHeight=1&body=box&orient=on');
  await sliced(page);
  await page.evaluate(() => (document.getElementById('status').textContent = ''));
  await page.evaluate(() => (location.hash = '#layerHeight=2&body=rook'));
  await sliced(page);
  assert.match(await page.locator('#input').textContent(), /^rook/);
  assert.equal(await page.locator('[name=orient]').isChecked(), false);
  assert.equal(await page.locator('[name=layerHeight]').inputValue(), '2');
  assert.deepEqual(complaints, []);
  await close();
});

test('the command that the page shows writes what the page downloads', async () => {
  const settings = '#layerHeight=1&firstLayerHeight=0.5&zTo=8&rotateX=90&scale=-1&scan=on&hatchAngle=30&pattern=lines&pixelSize=0.2&displayX=50&displayY=50&body=torus';
  for (const format of ['cli', 'png-zip']) {
    const { page, complaints, close } = await open(format === 'cli' ? settings : settings.replace('scan=on', 'scale=2'));
    await sliced(page);
    await page.locator('#format').selectOption(format);
    const coming = page.waitForEvent('download');
    await page.getByRole('button', { name: 'Save' }).click();
    const bytes = readFileSync(await (await coming).path());
    const commands = (await page.locator('#command').textContent()).split('\n');
    assert.equal(commands.length, 2);
    for (const command of commands) {
      assert.match(command, /^lamella /);
      execFileSync('/bin/sh', ['-c', `"$0" ${command.slice(8)}`, program], { cwd: folder, stdio: 'pipe' });
    }
    assert.ok(Buffer.compare(bytes, readFileSync(join(folder, `torus.${format === 'cli' ? 'cli' : 'zip'}`))) === 0, commands[1]);
    assert.deepEqual(complaints, []);
    await close();
  }
});

test('a strategy file makes the vectors, and layers may follow the slope', async () => {
  writeFileSync(join(folder, 'narrow.toml'), native('strategy', 'show').replace(/distance = 0\.1\b/g, 'distance = 0.5'));
  const { page, complaints, close } = await open('#layerHeight=5&body=box&scan=on');
  await sliced(page);
  const linesOf = async () => Number(/contours([\d,]+)/.exec(await timesOf(page))[1].replaceAll(',', ''));
  await page.evaluate(() => (document.getElementById('status').textContent = ''));
  await page.locator('#strategy').setInputFiles(join(folder, 'narrow.toml'));
  await sliced(page);
  assert.equal(await page.locator('#strategyName').textContent(), 'narrow.toml');
  assert.match(await page.locator('#command').textContent(), /--strategy=narrow.toml/);
  await page.locator('#noStrategy').click();
  await page.getByText('none', { exact: true }).waitFor();
  await sliced(page);
  await page.evaluate(() => document.querySelector('[name=adaptiveMin]').closest('details').setAttribute('open', ''));
  await page.locator('[name=adaptiveMin]').fill('1');
  await change(page, 'adaptiveMax', '5');
  assert.ok(await page.locator('[name=layerHeight]').isDisabled());
  assert.match(await page.locator('#command').textContent(), /--adaptive=1:5/);
  assert.ok((await linesOf()) > 0);
  assert.deepEqual(complaints, []);
  await close();
});

test('ten thousand copies leave the page alive', async () => {
  const { page, complaints, close } = await open('#layerHeight=5&copies=10000');
  await page.locator('#body').selectOption('box');
  await sliced(page);
  assert.match(await timesOf(page), /contours40,000/); // four layers
  assert.deepEqual(complaints, []);
  await close();
});

test('every control has a name for a screen reader', async () => {
  const { page, close } = await open('#body=box');
  await sliced(page);
  await page.evaluate(() => document.querySelectorAll('details').forEach((each) => (each.open = true)));
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('input, select, button, iframe, canvas, progress')]
      .filter((each) => !(each.ariaLabel || each.title || each.textContent.trim() || each.labels?.[0]?.textContent.trim()))
      .map((each) => each.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await close();
});

test('a run is cancelled', async () => {
  const { page, close } = await open('#layerHeight=0.001');
  await page.locator('#body').selectOption('head');
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('Cancelled.').waitFor();
  await page.locator('[name=layerHeight]').fill('5');
  await page.locator('#body').selectOption('box');
  await sliced(page);
  await close();
});

test('everything is reached with the keyboard, and a phone shows it in its width', async () => {
  const { page, close } = await open('#body=box', { viewport: { width: 390, height: 844 }, colorScheme: 'dark' });
  await sliced(page);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
  const settings = page.getByRole('button', { name: 'Settings' }); // beside the layers, there is no space for them
  if (await settings.isVisible()) await settings.click();
  const reached = new Set();
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.name || document.activeElement.localName));
  }
  for (const id of ['file', 'body', 'layerHeight', 'slice', 'format', 'download', 'summary']) assert.ok(reached.has(id), id);
  await close();
});

/** Chooses a printer by a word, as somebody types it. */
async function choosePrinter(page, word) {
  await page.getByText('Resin printer', { exact: true }).click();
  await page.locator('#printers option').first().waitFor({ state: 'attached' });
  await page.locator('[name=printer]').fill(word);
  await page.locator('[name=printer]').press('Tab');
}

test('jobs for resin printers have the bytes of the program, and the check marks the print', async () => {
  native('make', 'rook', '-o', 'rook.stl');
  const { page, complaints, close } = await open('#layerHeight=2');
  await page.locator('#file').setInputFiles(join(folder, 'rook.stl'));
  await sliced(page);
  await choosePrinter(page, 'mars');
  assert.match(await page.locator('#printerFacts').textContent(), /^\d+ printers: /);
  for (const [word, printer, extension] of [['Mars 4 Max', 'Elegoo Mars 4 Max', 'goo'], ['Photon M3 Max', 'Anycubic Photon M3 Max', 'pm3m']]) {
    await page.locator('[name=printer]').fill(word);
    assert.match(await page.locator('#printerFacts').textContent(), new RegExp(`^${printer}: .* files \\.${extension}$`));
    const coming = page.waitForEvent('download');
    await page.getByRole('button', { name: 'Save' }).click();
    const download = await coming;
    assert.equal(download.suggestedFilename(), `rook.${extension}`);
    native('slice', 'rook.stl', '-o', `rook.${extension}`, '--layer-height', '2', '--printer', printer);
    assert.ok(Buffer.compare(readFileSync(await download.path()), readFileSync(join(folder, `rook.${extension}`))) === 0, printer);
    assert.match(await page.locator('#command').textContent(), new RegExp(`--printer=.*${word}`));
  }
  assert.ok(await page.locator('#printCheck').isHidden());
  await page.locator('[name=check]').check();
  await page.locator('#printCheck').waitFor();
  native('slice', 'rook.stl', '-o', 'rook.cli', '--layer-height', '2', '--check', '--stats', 'rook.json');
  const { findings } = JSON.parse(readFileSync(join(folder, 'rook.json'), 'utf8')).check;
  assert.deepEqual(await page.locator('#checkFindings li').allTextContents(), findings);
  await sliced(page);
  if (process.env.LAMELLA_SHOT) await page.screenshot({ path: process.env.LAMELLA_SHOT });
  assert.deepEqual(complaints, []);
  await close();
});

test('the package works as a module of a page', async () => {
  const kinds = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };
  const [, sample] = /^```html\n([\s\S]*?)^```$/m.exec(readFileSync(process.env.LAMELLA_PAGE, 'utf8'));
  const server = createServer((request, response) => {
    if (request.url === '/') return response.setHeader('content-type', 'text/html').end(`<!doctype html><body>${sample}`);
    const path = join(packageFolder, normalize(request.url).replace(/^\/lamella/, ''));
    if (!existsSync(path)) return response.writeHead(404).end();
    response.setHeader('content-type', kinds[/\.[a-z]+$/.exec(path)[0]] ?? 'text/plain').end(readFileSync(path));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.getByText('107 layers').or(page.getByText('106 layers')).waitFor();
  const hashes = await page.evaluate(async () => {
    const { makeBody, slice } = await import('/lamella/browser.js');
    const stack = await slice(await makeBody('rook'), { layerHeight: 2 });
    return stack.layers.map((layer) => layer.hash);
  });
  native('make', 'rook', '-o', 'rook.stl');
  native('slice', 'rook.stl', '--stats', 'rook.json', '--layer-height', '2');
  assert.deepEqual(hashes, JSON.parse(readFileSync(join(folder, 'rook.json'), 'utf8')).layers.map(({ hash }) => hash));
  await page.close();
  server.close();
});

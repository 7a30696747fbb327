// What pages draw, compared pixel by pixel with what the same layers look like to somebody else: layers with the
// pictures that the raster of `lamella slice` makes, the stack with a pinhole camera's view of the contours.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { file, lamella, open, openDrawing, redrawn, settled, shown, startBrowser, stopBrowser } from './browser.mjs';
import { colourOf, compare, scaleOf } from './drawing.mjs';

const height = 0.5; // mm, of a layer
const pitches = { rook: 0.02, calibration: 0.1 }; // mm, of the raster's pixels: finer than those of the screen

before(async () => {
  lamella('make', 'rook', '-o', 'rook.stl');
  lamella('make', 'calibration', '-o', 'calibration.stl');
  for (const [part, pitch] of Object.entries(pitches)) {
    lamella('view', `${part}.stl`, '--layer-height', `${height}`);
    lamella('slice', `${part}.stl`, '--layer-height', `${height}`, '-o', part, '--format', 'png', '--pixel-size', `${pitch}`, '--antialias', '1');
  }
  lamella('slice', 'rook.stl', '--layer-height', `${height}`, '-o', 'rook.json');
  await startBrowser();
});
after(stopBrowser);

for (const colorScheme of ['light', 'dark'])
  test(`layers look as the raster sees them, ${colorScheme}`, async () => {
    for (const [part, pitch] of Object.entries(pitches)) {
      const { page } = await open(`${part}.html`, { colorScheme });
      await shown(page);
      for (const name of ['Contours', 'Direction']) await page.getByRole('button', { name, exact: true }).click();
      const fitted = await scaleOf(page);
      const tools = await page.locator('.pane:has(canvas[data-layer]) .tools').evaluate((node) => node.offsetTop + node.offsetHeight);
      const layers = Number(await page.locator('#layer').getAttribute('max')) + 1;
      for (const [layer, zoomed] of [[0, false], [Math.floor(layers / 2), false], [layers - 1, false], [layers - 1, true]]) {
        await page.locator('#layer').fill(String(layer));
        await shown(page);
        if (zoomed) await page.getByRole('button', { name: 'Zoom in' }).first().click();
        await redrawn();
        const picture = file(`${part}/${String(layer).padStart(5, '0')}.png`);
        const { filled, different, wrong } = await compare(page, picture, pitch, await scaleOf(page), ((tools / 2) * (await scaleOf(page))) / fitted);
        const where = `${part}, layer ${layer}${zoomed ? ', zoomed in' : ''}: ${different} of ${filled} pixels`;
        assert.ok(filled > 5000, where);
        assert.equal(wrong, 0, where);
        assert.ok(different < 0.02 * filled, where);
      }
    }
  });

test('a layered SVG shows one layer, that of the address, in its true size and y upwards', async () => {
  lamella('make', 'rook', '-o', 'cut.stl', '--rotate-x', '90'); // its base is at the back
  lamella('slice', 'cut.stl', '--layer-height', '1', '-o', 'cut.svg');
  const { layers } = (lamella('convert', 'cut.svg', 'cut.json'), JSON.parse(readFileSync(file('cut.json'), 'utf8')));
  for (const [address, layer] of [['cut.svg', 0], ['cut.svg#layer15', 15]]) {
    const seen = await shapesOf(address);
    const points = layers[layer].parts[0].rings.flat();
    const range = (k) => points.filter((_, i) => i % 2 === k).reduce(([low, high], p) => [Math.min(low, p), Math.max(high, p)], [Infinity, -Infinity]);
    const [[left, right], [front, back]] = [range(0), range(1)];
    const mm = 96 / 25.4; // pixels
    assert.equal(seen.length, layers[layer].parts[0].rings.length, address);
    const box = (key, worst) => seen.map((shape) => shape[key]).reduce((a, b) => worst(a, b));
    assert.ok(Math.abs(box('right', Math.max) - box('left', Math.min) - (right - left) * mm) < 0.1, address);
    assert.ok(Math.abs(box('bottom', Math.max) - box('top', Math.min) - (back - front) * mm) < 0.1, address);
  }
  // The wide base of the rook, at the back of this pose, is at the top of the picture.
  const [outline] = await shapesOf('cut.svg#layer15');
  assert.ok(outline.wide_at_top, 'upside down');
});

/** The boxes of all polygons of a drawing that are seen. */
async function shapesOf(address) {
  const { page } = await openDrawing(address);
  return page.evaluate(() =>
    [...document.querySelectorAll('polygon')]
      .map((shape) => ({ box: shape.getBoundingClientRect(), shape }))
      .filter(({ box }) => box.width > 0)
      .map(({ box, shape }) => {
        const matrix = shape.getScreenCTM();
        const points = [...shape.points].map((p) => p.matrixTransform(matrix));
        const width = (some) => Math.max(...some.map((p) => p.x)) - Math.min(...some.map((p) => p.x));
        const [top, bottom] = [points.filter((p) => p.y < box.top + box.height / 10), points.filter((p) => p.y > box.bottom - box.height / 10)];
        return { left: box.left, right: box.right, top: box.top, bottom: box.bottom, wide_at_top: width(top) > width(bottom) };
      }),
  );
}

/** The leftmost and rightmost pixel of the stack in each row of the screen: what has not the colour of the paper. */
async function silhouette(page) {
  const paper = await colourOf(page, '--paper');
  const png = (await page.locator('canvas[data-built]').screenshot()).toString('base64');
  return page.evaluate(
    async ([png, paper]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${png}`;
      await image.decode();
      const { width, height } = image;
      const ctx = new OffscreenCanvas(width, height).getContext('2d');
      ctx.drawImage(image, 0, 0);
      const { data } = ctx.getImageData(0, 0, width, height);
      const rows = [];
      for (let row = 0; row < height; ++row) {
        let [left, right] = [null, null];
        for (let column = 0; column < width; ++column) {
          const at = 4 * (row * width + column);
          if ([0, 1, 2].reduce((sum, k) => sum + Math.abs(data[at + k] - paper[k]), 0) < 40) continue;
          left ??= column;
          right = column + 1;
        }
        rows.push([left, right]);
      }
      return { width, height, rows };
    },
    [png, paper],
  );
}

/** x, y, bottom and top of all points of contours, mm from the middle of their box. */
function pointsOf(layers) {
  const points = [];
  for (const { bottom, top, parts } of layers)
    for (const ring of parts[0].rings) for (let i = 0; i < ring.length; i += 2) points.push([ring[i], ring[i + 1], bottom, top]);
  const range = (k) => points.reduce(([low, high], p) => [Math.min(low, p[k]), Math.max(high, p[k])], [Infinity, -Infinity]);
  const [x, y] = [range(0), range(1)].map(([low, high]) => (low + high) / 2);
  const z = (range(2)[0] + range(3)[1]) / 2;
  return points.map((p) => [p[0] - x, p[1] - y, p[2] - z, p[3] - z]);
}

/**
 * The same as a camera sees the points that looks level from the front at the middle of the box, from so far away. Each
 * is seen from the bottom to the top of its layer.
 */
function pinholeView(points, { width, height }, away) {
  const focus = height / 2 / Math.tan((16 * Math.PI) / 180); // the viewer's camera sees 32 degrees of height
  const rows = Array.from({ length: height }, () => [Infinity, -Infinity]);
  for (const [x, y, bottom, top] of points) {
    const scale = focus / (away + y);
    const column = width / 2 + x * scale;
    const last = Math.min(height, Math.round(height / 2 - bottom * scale));
    for (let row = Math.max(0, Math.round(height / 2 - top * scale)); row < last; ++row) {
      rows[row][0] = Math.min(rows[row][0], column);
      rows[row][1] = Math.max(rows[row][1], column);
    }
  }
  return rows;
}

for (const colorScheme of ['light', 'dark'])
  test(`the stack has the outline that a camera sees, ${colorScheme}`, async () => {
    const { layers } = JSON.parse(readFileSync(file('rook.json'), 'utf8'));
    const points = pointsOf(layers);
    const { page } = await open('rook.html', { view: 'stack', colorScheme });
    await page.waitForSelector('canvas[data-built]');
    await page.locator('#layer').fill(String(layers.length - 1));
    await page.getByRole('button', { name: 'Front' }).click();
    await settled(page);
    const drawn = await silhouette(page);
    // Below, the bed is seen behind the part.
    const rowsOf = (view) => [...view.keys()].filter((row) => Number.isFinite(view[row][0]) && row < 0.65 * drawn.height);
    const differences = (away) => {
      const view = pinholeView(points, drawn, away);
      return rowsOf(view).map((row) => Math.max(Math.abs(view[row][0] - drawn.rows[row][0]), Math.abs(view[row][1] - drawn.rows[row][1])));
    };
    // How far away it stands is the camera's business: it is where most rows agree.
    let best = [];
    let most = -1;
    for (let away = 60; away < 300; away *= 1.005) {
      const found = differences(away);
      const agree = found.filter((d) => d <= 2).length / found.length;
      if (agree > most) [most, best] = [agree, found];
    }
    assert.ok(best.length > 100, `${best.length} rows`);
    assert.ok(most > 0.95, `${(100 * most).toFixed(1)} % of ${best.length} rows agree`);
  });

// Compares the drawing of a layer in a page with an image of the same layer.

import { readFileSync } from 'node:fs';

/** A colour of the style sheet as numbers. */
export async function colourOf(page, name) {
  return page.evaluate((name) => {
    const ctx = document.createElement('canvas').getContext('2d');
    ctx.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name);
    ctx.fillRect(0, 0, 1, 1);
    return [...ctx.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  }, name);
}

/** How many pixels an mm is long, by the scale in the corner. */
export const scaleOf = (page) =>
  page.locator('.scale').evaluate((node) => node.lastChild.getBoundingClientRect().width / parseFloat(node.textContent));

/**
 * Compares the pixels of the drawing whose colour is closer to the material's than to the paper's and its grid's with an
 * image of the raster, whose middle is `below` pixels below that of the drawing.
 * @param page a page, or a frame of one
 * @returns {Promise<{filled: number, different: number, wrong: number}>} pixels with material; those where the two are
 *     not of one mind; and such of these as no edge passes nearby, which nothing excuses
 */
export async function compare(page, picture, pitch, scale, below) {
  const colours = await Promise.all(['--fill-0', '--paper', '--grid', '--grid-strong'].map((name) => colourOf(page, name)));
  const png = readFileSync(picture).toString('base64');
  return page.locator('canvas[data-layer]').evaluate(
    async (canvas, [colours, png, scale, pitch, below]) => {
      const pixels = (source) => {
        const ctx = new OffscreenCanvas(source.width, source.height).getContext('2d', { willReadFrequently: true });
        ctx.drawImage(source, 0, 0);
        return ctx.getImageData(0, 0, source.width, source.height).data;
      };
      const image = new Image();
      image.src = `data:image/png;base64,${png}`;
      await image.decode();
      const raster = pixels(image);
      const material = (x, y) => {
        const column = Math.floor(x / scale / pitch + image.width / 2);
        const row = Math.floor(y / scale / pitch + image.height / 2);
        return column >= 0 && row >= 0 && column < image.width && row < image.height && raster[4 * (row * image.width + column)] > 127;
      };
      const drawing = pixels(canvas);
      const found = { filled: 0, different: 0, wrong: 0 };
      for (let row = 0; row < canvas.height; ++row)
        for (let column = 0; column < canvas.width; ++column) {
          const at = 4 * (row * canvas.width + column);
          const [x, y] = [column + 0.5 - canvas.width / 2, row + 0.5 - below - canvas.height / 2];
          const [fill, ...others] = colours.map((colour) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(drawing[at + k] - colour[k]), 0));
          const filled = fill < Math.min(...others);
          found.filled += filled;
          if (filled === material(x, y)) continue;
          ++found.different;
          const around = [-1, 0, 1].flatMap((dx) => [-1, 0, 1].map((dy) => material(x + dx, y + dy)));
          found.wrong += around.every((each) => each === around[0]);
        }
      return found;
    },
    [colours, png, scale, pitch, below],
  );
}

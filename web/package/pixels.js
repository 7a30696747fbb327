// Images of layers as arrays of numbers: the PNG files of the format `png` (docs/formats.md), of grey or black and white.

const signature = 8; // bytes before the first chunk of a PNG file

/** The inflated rows of a PNG file, each behind the byte of its filter. */
async function rowsOf(file) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const packed = [];
  for (let at = signature; at < file.length; ) {
    const size = view.getUint32(at);
    if (view.getUint32(at + 4) === 0x49444154) packed.push(file.subarray(at + 8, at + 8 + size)); // IDAT
    at += 12 + size;
  }
  const rows = new Blob(packed).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(rows).arrayBuffer());
}

/** Turns the bytes of each row, and the differences from the row above, into pixels. The last row becomes the first. */
function fill(pixels, rows, width, height, bits) {
  const bytes = Math.ceil((width * bits) / 8);
  let above = new Uint8Array(bytes);
  for (let r = 0; r < height; ++r) {
    const begin = r * (bytes + 1) + 1;
    const row = rows.subarray(begin, begin + bytes);
    if (rows[begin - 1] === 2) for (let i = 0; i < bytes; ++i) row[i] += above[i];
    above = row;
    const target = pixels.subarray((height - 1 - r) * width, (height - r) * width);
    if (bits === 8) target.set(row);
    else for (let c = 0; c < width; ++c) target[c] = row[c >> 3] & (128 >> (c & 7)) ? 255 : 0;
  }
}

/**
 * @param {Record<string, Uint8Array>} files of the format `png`, by name
 * @param {(bytes: number) => Uint8Array} roomFor makes the array
 */
export async function pixelsOf(files, roomFor) {
  const folder = Object.keys(files)[0].replace(/[^/]*$/, '');
  const manifest = JSON.parse(new TextDecoder().decode(files[`${folder}manifest.json`]));
  const { width, height, bits, layers, pixel_mm: size, column, row } = manifest;
  const data = roomFor(width * height * layers.length);
  for (const [i, { file }] of layers.entries()) fill(data.subarray(i * width * height, (i + 1) * width * height), await rowsOf(files[folder + file]), width, height, bits);
  return {
    data,
    shape: [layers.length, height, width],
    spacing: size,
    origin: [(0.5 - column[2]) / column[0], (height - 0.5 - row[2]) / row[1]],
    z: Float64Array.from(layers, ({ z }) => z),
  };
}

// What the playground reads of a file while it comes: LAMELLA_TREE, the sources.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const { LayerReader } = await import(pathToFileURL(join(process.env.LAMELLA_TREE, 'web/playground/preview.js')).href);

/** A binary Common Layer file with a square of each part in each layer, and hatch lines in every second one. */
function fileOf({ parts, layers }) {
  const labels = Array.from({ length: parts }, (_, i) => `$$LABEL/${i + 1},part ${i + 1}\n`).join('');
  const header = `$$HEADERSTART\n$$BINARY\n$$UNITS/0.5\n$$DIMENSION/0,0,0,9,9,9\n${labels}$$LAYERS/${layers}\n$$HEADEREND`;
  const commands = [Buffer.from(header, 'latin1')];
  const command = (id, ints, floats) => {
    const bytes = Buffer.alloc(2 + 4 * (ints.length + floats.length));
    bytes.writeUInt16LE(id, 0);
    ints.forEach((value, i) => bytes.writeInt32LE(value, 2 + 4 * i));
    floats.forEach((value, i) => bytes.writeFloatLE(value, 2 + 4 * (ints.length + i)));
    commands.push(bytes);
  };
  for (let layer = 0; layer < layers; ++layer) {
    command(127, [], [layer + 1]);
    for (let part = 1; part <= parts; ++part) {
      command(130, [part, 1, 5], [0, 0, part, 0, part, part, 0, part, 0, 0]);
      if (layer % 2 === 0) command(132, [part, 2], [0, 0, 1, 1, 2, 2, 3, 3]);
    }
  }
  return new Uint8Array(Buffer.concat(commands));
}

function read(file, chunkBytes) {
  const reader = new LayerReader();
  const found = [];
  for (let at = 0; at < file.length; at += chunkBytes) found.push(...reader.take(file.slice(at, at + chunkBytes)).layers);
  return found;
}

test('chunks of any size give the same layers', () => {
  const file = fileOf({ parts: 3, layers: 6 });
  const whole = read(file, file.length);
  assert.deepEqual(whole.map(({ z }) => z), [0.5, 1, 1.5, 2, 2.5]); // the last one has no end
  for (const { contours } of whole) assert.deepEqual(contours.map((points) => points[2]), [1, 2, 3]);
  for (const bytes of [1, 2, 3, 7, 50, 333]) assert.deepEqual(read(file, bytes), whole);
});

test('what is read of many parts costs the bytes of the file, whatever the chunks', () => {
  const file = fileOf({ parts: 10000, layers: 2 }); // its header is longer than a chunk
  let copied = 0;
  const { set } = Uint8Array.prototype;
  Uint8Array.prototype.set = function (from, at) {
    copied += from.length;
    return set.call(this, from, at);
  };
  try {
    assert.equal(read(file, 4096).length, 1);
  } finally {
    Uint8Array.prototype.set = set;
  }
  assert.ok(copied <= file.length, `${copied} of ${file.length} bytes`);
});

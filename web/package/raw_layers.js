// Reads the format `raw` (docs/formats.md) from chunks of bytes as they come.

const headerBytes = 56; // of a layer: seven numbers of 8 bytes
const numberBytes = 8;

/** Where the arrays of a layer begin. @param {Uint8Array} header */
function planOf(header) {
  const view = new DataView(header.buffer, header.byteOffset, headerBytes);
  const [index, contours, points, lines] = [0, 32, 40, 48].map((at) => Number(view.getBigUint64(at, true)));
  const [z, bottom, top] = [8, 16, 24].map((at) => view.getFloat64(at, true));
  const ends = headerBytes + 16 * points + 32 * lines;
  const closed = ends + 4 * (2 * contours + lines);
  const bytes = Math.ceil((closed + contours) / numberBytes) * numberBytes;
  return { index, z, bottom, top, contours, points, lines, ends, closed, bytes };
}

/** The arrays of a layer, views of its bytes but for `offsets`. */
function arraysOf({ buffer }, { index, z, bottom, top, contours, points, lines, ends, closed }) {
  const offsets = new Uint32Array(contours + 1);
  offsets.set(new Uint32Array(buffer, ends, contours), 1);
  return {
    index: [index],
    z: [z],
    bottom: [bottom],
    top: [top],
    points: new Float64Array(buffer, headerBytes, 2 * points),
    offsets,
    closed: new Uint8Array(buffer, closed, contours),
    layer: new Uint32Array(contours),
    part: new Uint32Array(buffer, ends + 4 * contours, contours),
    hatches: new Float64Array(buffer, headerBytes + 16 * points, 4 * lines),
    hatch_layer: new Uint32Array(lines),
    hatch_part: new Uint32Array(buffer, ends + 8 * contours, lines),
  };
}

/**
 * Returns a function that takes the next bytes of the file.
 * @param {(facts: {parts: {label: string}[], layers: number}) => void} onFacts called before the first layer
 * @param {(arrays: object) => void} onLayer called with the arrays of each layer once it is complete
 */
export function rawReader(onFacts, onLayer) {
  // The bytes that come next are gathered in an array of their own; `act` takes them once they are complete.
  let wanted;
  let filled = 0;
  let act;
  const want = (array, next) => ([wanted, act] = [array, next]);
  const wantLayer = () => {
    filled = 0;
    want(new Uint8Array(headerBytes), (header) => {
      const plan = planOf(header);
      const layer = new Uint8Array(plan.bytes);
      layer.set(header);
      want(layer, () => {
        onLayer(arraysOf(layer, plan));
        wantLayer();
      });
    });
  };
  want(new Uint8Array(16), (start) => {
    const size = Number(new DataView(start.buffer).getBigUint64(8, true));
    filled = 0;
    want(new Uint8Array(size), (text) => {
      onFacts(JSON.parse(new TextDecoder().decode(text)));
      wantLayer();
    });
  });
  return (bytes) => {
    for (let at = 0; at < bytes.length; ) {
      const part = bytes.subarray(at, at + wanted.length - filled);
      wanted.set(part, filled);
      filled += part.length;
      at += part.length;
      while (filled === wanted.length) act(wanted);
    }
  };
}

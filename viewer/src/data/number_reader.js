/** Whole numbers of variable length, as docs/viewer.md describes them. */
export class NumberReader {
  /** @param {Uint8Array} bytes */
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }

  /** The next number, 0 or above. Exact up to 2^53. */
  next() {
    const { bytes } = this;
    let byte = bytes[this.at++];
    let value = byte & 0x7f;
    for (let weight = 128; byte >= 0x80; weight *= 128) {
      byte = bytes[this.at++];
      value += (byte & 0x7f) * weight;
    }
    if (byte === undefined) throw new Error('the data end too early');
    return value;
  }

  /** The next number of either sign. */
  nextSigned() {
    const value = this.next();
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }

  get atEnd() {
    return this.at >= this.bytes.length;
  }
}

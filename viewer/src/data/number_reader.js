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
    // Nearly all numbers are ways to the next point: short ones, for which whole arithmetic will do.
    let byte = bytes[this.at++];
    if (byte < 0x80) return byte;
    let value = byte & 0x7f;
    byte = bytes[this.at++];
    if (byte < 0x80) return value | (byte << 7);
    value |= (byte & 0x7f) << 7;
    for (let weight = 0x4000; ; weight *= 128) {
      byte = bytes[this.at++];
      if (byte === undefined) throw new Error('the data end too early');
      value += (byte & 0x7f) * weight;
      if (byte < 0x80) return value;
    }
  }

  /** The next number of either sign. */
  nextSigned() {
    const value = this.next();
    if (value < 0x40000000) return (value >>> 1) ^ -(value & 1);
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }

  get atEnd() {
    return this.at >= this.bytes.length;
  }
}

// Back pressure: a counter in memory that the worker shares with its caller holds the bytes of output that have come and are
// not read. The worker waits while they are too many. Where no memory can be shared, nothing waits.

const most = 16 << 20;

/** @returns {{counter?: SharedArrayBuffer, release: (bytes: number) => void}} the caller's end */
export function newFlow() {
  if (typeof SharedArrayBuffer === 'undefined' || globalThis.crossOriginIsolated === false) return { release() {} };
  const counter = new SharedArrayBuffer(4);
  const waiting = new Int32Array(counter);
  return {
    counter,
    release(bytes) {
      Atomics.sub(waiting, 0, bytes);
      Atomics.notify(waiting, 0);
    },
  };
}

/** Called by the worker when it has sent bytes. */
export function holdBack(counter, bytes) {
  if (!counter) return;
  const waiting = new Int32Array(counter);
  Atomics.add(waiting, 0, bytes);
  for (;;) {
    const now = Atomics.load(waiting, 0);
    if (now <= most) return;
    Atomics.wait(waiting, 0, now);
  }
}

/** Lets the browser draw and answer; without the waiting that it puts on chains of timers. */
export const nextTurn = () =>
  new Promise((resolve) => {
    const channel = new MessageChannel();
    channel.port1.onmessage = resolve;
    channel.port2.postMessage(null);
  });

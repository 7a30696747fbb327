/** Returns a function that takes bytes of a text in chunks and calls `act` with each whole line. */
export function lines(act) {
  const decoder = new TextDecoder();
  let begun = []; // chunks of a line without an end
  return (bytes) => {
    const [first, ...rest] = decoder.decode(bytes, { stream: true }).split('\n');
    begun.push(first);
    for (const next of rest) {
      act(begun.join(''));
      begun = [next];
    }
  };
}

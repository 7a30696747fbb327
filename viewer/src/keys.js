/** What the keyboard does, for help texts and for the keyboard itself: [keys, what, act]. */

const inField = (target) =>
  target instanceof HTMLInputElement && (target.type === 'number' || target.type === 'text');

/**
 * Listens to keys all over the page, but leaves to fields, buttons and dialogs what is theirs.
 * @param {{keys: string[], act: (event: KeyboardEvent) => void}[]} table keys as in KeyboardEvent.key, with
 *   "Shift+" before those that need it
 */
export function listenToKeys(table) {
  const acts = new Map(table.flatMap(({ keys, act }) => keys.map((key) => [key, act])));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (inField(event.target) || document.querySelector('dialog[open]')) return;
    const pressesButton = event.target instanceof Element && event.target.closest('button, summary, input[type=checkbox]');
    if (pressesButton && (event.key === ' ' || event.key === 'Enter')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key; // Caps Lock makes letters capitals
    const name = event.shiftKey && key.startsWith('Arrow') ? `Shift+${key}` : key;
    const act = acts.get(name);
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}

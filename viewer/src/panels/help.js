import { element } from '../element.js';

/**
 * A dialog with the keys, what signs mean, and where the page comes from.
 * @param {{keys: string[], label: string, help: string}[]} table
 * @param {string[]} signs sentences
 */
export function helpDialog(table, signs) {
  const rows = table.filter(({ help }) => help).map(({ label, help }) => element('tr', {}, element('th', { scope: 'row' }, element('kbd', {}, label)), element('td', {}, help)));
  const dialog = element(
    'dialog',
    { 'aria-labelledby': 'help-title' },
    element('h2', { id: 'help-title' }, 'Keys'),
    element('table', {}, ...rows),
    element('p', {}, 'The wheel or two fingers zoom, dragging moves. In the stack, dragging rotates and the right button moves.'),
    ...signs.map((sign) => element('p', {}, sign)),
    element('p', { className: 'small' }, 'Written by Lamella. The page is complete: it opens without a network, and nothing leaves it.'),
    element('form', { method: 'dialog' }, element('button', { className: 'main' }, 'Close')),
  );
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  return dialog;
}

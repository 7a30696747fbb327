import { element } from '../element.js';

/** A dialog with the keys and where the page comes from. @param {{keys: string[], label: string, help: string}[]} table */
export function helpDialog(table) {
  const rows = table.filter(({ help }) => help).map(({ label, help }) => element('tr', {}, element('th', { scope: 'row' }, element('kbd', {}, label)), element('td', {}, help)));
  const dialog = element(
    'dialog',
    { 'aria-labelledby': 'help-title' },
    element('h2', { id: 'help-title' }, 'Keys'),
    element('table', {}, ...rows),
    element('p', {}, 'The wheel or two fingers zoom, dragging moves. In the stack, dragging turns and the right button moves.'),
    element('p', { className: 'small' }, 'Written by Lamella. The page is complete: it opens without a network, and nothing leaves it.'),
    element('form', { method: 'dialog' }, element('button', { className: 'main' }, 'Close')),
  );
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  return dialog;
}

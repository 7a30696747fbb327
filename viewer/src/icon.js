import { element } from './element.js';

/** Signs on buttons are drawn: not every machine has a font with them. In a square of 24 by 24; styles.css paints them. */
const shapes = {
  plus: 'M12 5V19M5 12H19',
  minus: 'M5 12H19',
  all: 'M9 4H4V9M15 4H20V9M20 15V20H15M9 20H4V15',
  back: 'M16 5 7 12 16 19Z',
  pause: 'M8 5V19M16 5V19',
  forth: 'M8 5 17 12 8 19Z',
  first: 'M6 5V19M19 5 10 12 19 19Z',
  last: 'M18 5V19M5 5 14 12 5 19Z',
  good: 'M5 13 10 18 19 7',
  bad: 'M6 6 18 18M18 6 6 18',
  warning: 'M12 5V14M12 18V19',
  plain: 'M12 10V19M12 5V6',
};
const filled = new Set(['back', 'forth', 'first', 'last']);

/** @param {keyof typeof shapes} name */
export function icon(name) {
  const [svg, path] = ['svg', 'path'].map((tag) => document.createElementNS('http://www.w3.org/2000/svg', tag));
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', true);
  path.setAttribute('d', shapes[name]);
  path.classList.toggle('filled', filled.has(name));
  svg.append(path);
  return svg;
}

/** A button with a sign; its name is shown to those who point at it, and read by screen readers. */
export function iconButton(label, name, act) {
  return element('button', { type: 'button', className: 'icon', title: label, 'aria-label': label, onclick: act }, icon(name));
}

// The settings: what people enter, which of it is invalid, and the options of the program that it becomes.

const $ = (id) => document.getElementById(id);
const form = $('settings');

/** Options of images alone, and those of which layers of a file take notice. */
const imageNames = ['pixelSize', 'resolution', 'displaySize', 'antialias', 'printer'];
const stepNames = ['fill', 'offset', 'bottomOffset', 'minArea'];
const kebab = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);

export const fields = () => [...form.elements].filter((field) => field.name);
const field = (name) => form.elements[name];
const valueOf = (one) => (one.type === 'checkbox' ? one.checked : one.value);

/** What was entered, also where it has no effect at the moment: it is in the address. */
export const entered = () =>
  Object.fromEntries(fields().map((one) => [one.name, valueOf(one)]).filter(([, value]) => value !== '' && value !== false));

/** Shows settings, such as those of an address; what they do not name becomes as it was at first. */
export function enter(given) {
  for (const one of fields()) {
    if (one.type === 'checkbox') one.checked = given.has(one.name);
    else one.value = given.get(one.name) ?? one.querySelector?.('option')?.value ?? one.defaultValue;
    if (given.has(one.name)) one.closest('details')?.setAttribute('open', '');
  }
}

const pair = (values, first, second, by) => (values[first] || values[second] ? `${values[first] ?? ''}${by}${values[second] ?? ''}` : undefined);

/** The options of the program, by their names in camel case. `strategy` is a file's name, if one was opened. */
export function options(strategy) {
  const { zFrom, zTo, adaptiveMin, adaptiveMax, pixelsX, pixelsY, displayX, displayY, bottomInset, bottomHeight, ...values } = entered();
  const all = {
    ...values,
    zRange: pair({ zFrom, zTo }, 'zFrom', 'zTo', ':'),
    adaptive: pair({ adaptiveMin, adaptiveMax }, 'adaptiveMin', 'adaptiveMax', ':'),
    resolution: pair({ pixelsX, pixelsY }, 'pixelsX', 'pixelsY', 'x'),
    displaySize: pair({ displayX, displayY }, 'displayX', 'displayY', ','),
    bottomOffset: pair({ bottomInset, bottomHeight }, 'bottomInset', 'bottomHeight', ':'),
    strategy,
  };
  const without = [...(all.adaptive ? ['layerHeight', 'firstLayerHeight'] : ['cusp']), ...(all.scan ? [] : vectorNames())];
  return Object.fromEntries(Object.entries(all).filter(([name, value]) => value !== undefined && !without.includes(name)));
}

const vectorNames = () => [...$('vectors').elements].map(({ name }) => name).concat('strategy');
const only = (given, takes) => Object.fromEntries(Object.entries(given).filter(([name]) => takes(name)));

export const withoutImages = (given) => only(given, (name) => !imageNames.includes(name));
export const withoutCheck = (given) => only(given, (name) => name !== 'check');
export const onlySteps = (given) => only(given, (name) => stepNames.includes(name));
export const onlyImages = (given) => only(given, (name) => imageNames.includes(name));

/** The words of a command line for options. */
export const words = (given) =>
  Object.entries(given).flatMap(([name, value]) => (value === true ? [`--${kebab(name)}`] : [`--${kebab(name)}=${value}`]));

// ---- What is invalid ----------------------------------------------------------------------------------------------------

/** Fields that go together: one alone means nothing. */
const couples = [['bottomInset', 'bottomHeight'], ['adaptiveMin', 'adaptiveMax'], ['pixelsX', 'pixelsY'], ['displayX', 'displayY']];
/** The first must not be larger than the second. */
const orders = [['adaptiveMin', 'adaptiveMax'], ['zFrom', 'zTo']];

function fault(one) {
  const { validity, min, max } = one;
  if (validity.badInput) return 'this is no number';
  if (validity.valueMissing) return 'a number is missing';
  if (validity.rangeUnderflow) return `the least is ${min}`;
  if (validity.rangeOverflow) return `the most is ${max}`;
  if (validity.stepMismatch) return 'a whole number is needed';
  if (one.dataset.not !== undefined && one.value !== '' && Number(one.value) === Number(one.dataset.not)) return `${one.dataset.not} is not possible`;
  if (!one.value && couples.some((couple) => couple.includes(one.name) && couple.some((name) => field(name).value))) return 'this number is needed, too';
  for (const [first, second] of orders)
    if (one.name === second && one.value && field(first).value && Number(one.value) < Number(field(first).value)) return `the least is ${field(first).value}`;
  return '';
}

/** The name of a field, as the page shows it. */
export const labelOf = (one) => one.labels[0].firstChild.textContent.trim() || one.labels[0].textContent.trim();

/**
 * Marks what is invalid where it stands, and at the heading of a folded section.
 * @returns {{field: HTMLInputElement, text: string}[]}
 */
export function check() {
  $('vectors').disabled = !field('scan').checked;
  const adapts = Boolean(field('adaptiveMin').value || field('adaptiveMax').value);
  field('layerHeight').disabled = field('firstLayerHeight').disabled = adapts;
  field('cusp').disabled = !adapts;
  const faults = [];
  for (const one of fields()) {
    const text = one.disabled || one.matches(':disabled') ? '' : fault(one);
    const label = one.labels[0];
    let note = label.nextElementSibling?.matches('.fault') ? label.nextElementSibling : null;
    if (!text) note?.remove();
    else if (!note) label.after((note = Object.assign(document.createElement('p'), { className: 'fault bad', id: `fault-${one.name}` })));
    if (text) note.textContent = text;
    if (text) {
      one.setAttribute('aria-invalid', 'true');
      one.setAttribute('aria-describedby', note.id);
      faults.push({ field: one, text });
    } else {
      one.removeAttribute('aria-invalid');
      one.removeAttribute('aria-describedby');
    }
  }
  for (const section of form.querySelectorAll(':scope > details')) section.classList.toggle('wrong', section.querySelector('.fault') !== null);
  return faults;
}

/** Opens the section of a field and goes there. */
export function goTo(one) {
  one.closest('details')?.setAttribute('open', '');
  one.focus();
}

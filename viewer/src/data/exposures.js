/** What the head of a page says of parts that are exposures: scan vectors, with a region, a kind and parameters. */

export const regions = ['core', 'upskin', 'downskin', 'support'];
export const kinds = ['contour', 'hatch'];

/** Whether a part is scan vectors: its chains are open by intent, while those of material are faults. */
export const isVectors = ({ exposure }) => Boolean(exposure);

export const hasVectors = (head) => head.parts.some(isVectors);
export const hasMaterial = (head) => !head.parts.every(isVectors);

/** The colour of a part that is scan vectors, of those in effect. */
export const colourOfVectors = ({ exposure }, { vectors }) => vectors[`${exposure.region} ${exposure.kind}`];

/**
 * Parts that are shown or hidden together.
 * @typedef {object} Group
 * @property {string} name
 * @property {number[]} parts their numbers
 */

/** @returns {(Group & {region: string, kind: string})[]} the exposures by region and kind */
export function kindsOf({ parts }) {
  return regions.flatMap((region) =>
    kinds.flatMap((kind) => {
      const its = parts.flatMap(({ exposure }, i) => (exposure?.region === region && exposure.kind === kind ? [i] : []));
      return its.length === 0 ? [] : [{ name: `${region} ${kind}`, region, kind, parts: its }];
    }),
  );
}

/** As the program names parts without a label. */
const nameOf = (label) => (label.trim() === '' ? 'part' : label);

/** @returns {Group[]} what is built: a part with all its exposures is one */
export function bodiesOf({ parts }) {
  const bodies = new Map();
  parts.forEach(({ label, exposure }, i) => {
    const key = exposure ? `exposures of ${exposure.part}` : i;
    if (!bodies.has(key)) bodies.set(key, { name: nameOf(exposure?.part ?? label), parts: [] });
    bodies.get(key).parts.push(i);
  });
  return [...bodies.values()];
}

/** The number of the body of each part. */
export function bodyOfParts(head) {
  const numbers = new Array(head.parts.length);
  bodiesOf(head).forEach(({ parts }, body) => parts.forEach((part) => (numbers[part] = body)));
  return numbers;
}

/** Shows or hides a group. A part is hidden as long as one of its groups is. */
export function switchGroup(store, group, shown) {
  const off = new Set(store.state.off);
  if (shown) off.delete(group);
  else off.add(group);
  store.set({ off, hidden: new Set([...off].flatMap(({ parts }) => parts)) });
}

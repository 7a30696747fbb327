// The page's words: messages of the program speak of options and of files that the page does not show.

import { fields, labelOf } from './settings.js';

const camel = (name) => name.replace(/-[a-z]/g, (letters) => letters[1].toUpperCase());
/** Options that are several fields. */
const ofSeveral = { zRange: 'zFrom', adaptive: 'adaptiveMin', resolution: 'pixelsX', displaySize: 'displayX', bottomOffset: 'bottomInset' };

/** “Layer height” for `--layer-height`; other options stay as they are. */
function fieldOf(option, kebabName) {
  const name = camel(kebabName);
  if (name === 'strategy') return '“Strategy file”';
  const one = fields().find((each) => each.name === (ofSeveral[name] ?? name));
  return one ? `“${labelOf(one)}”` : option;
}

const internal = /^(page\.html|mesh\.html|figures\.json): /;

/** The text of an error or a warning, with the names that the page shows. @param {string} [output] the name of a download */
export function inWordsOfPage(text, output) {
  return text
    .replace(/^standard output: /, output ? `${output}: ` : '')
    .replace(/^(')?out\//, '$1')
    .replace(internal, '')
    .replace(/lamella \w+ --/g, '--')
    .replace(/--([a-z]+(?:-[a-z]+)*)/g, fieldOf);
}

/** Warnings without those of what the page writes for itself alone, to draw it: losses of a format that nobody asked for. */
export const warningsOfPage = (warnings, output) => [
  ...new Set(warnings.filter((text) => output || !text.startsWith('standard output: ')).map((text) => inWordsOfPage(text, output))),
];

// ---- The equal command --------------------------------------------------------------------------------------------------

const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** A command as people enter it. @param {string[]} words */
export const commandText = (words) => ['lamella', ...words].map(quoted).join(' ');

import { isVectors } from './data/exposures.js';
import { partOf } from './data/vectors.js';

/** Files that the page saves: the table of layers, the layer as a drawing. */

const field = (value) => (/[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value));

/** The table of layers as CSV: a row for each layer, with the names of the columns that the page has. */
export function csvOf(table) {
  const columns = Object.keys(table).filter((key) => Array.isArray(table[key]) && table[key].length === table.z.length);
  const rows = table.z.map((_, i) => columns.map((key) => field(table[key][i] ?? '')).join(','));
  return `${[columns.join(','), ...rows].join('\r\n')}\r\n`;
}

const number = (value) => String(Math.round(value * 1e6) / 1e6);

function pathData({ points, ends, rings }, origin) {
  const data = [];
  ends.forEach((end, i) => {
    for (let p = i === 0 ? 0 : ends[i - 1]; p < end; ++p)
      data.push(`${p === (i === 0 ? 0 : ends[i - 1]) ? 'M' : 'L'}${number(points[2 * p] + origin[0])} ${number(-points[2 * p + 1] - origin[1])}`);
    if (i < rings) data.push('Z');
  });
  return data.join('');
}

function linesData(lines, from, to, origin) {
  const data = [];
  for (let i = from; i < to; ++i) {
    const [ax, ay, bx, by] = lines.subarray(4 * i, 4 * i + 4);
    if (i === from || ax !== lines[4 * i - 2] || ay !== lines[4 * i - 1]) data.push(`M${number(ax + origin[0])} ${number(-ay - origin[1])}`);
    data.push(`L${number(bx + origin[0])} ${number(-by - origin[1])}`);
  }
  return data.join('');
}

const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

/**
 * The layer as SVG in mm, y up: each part is one path, filled by the nonzero rule, and scan vectors are lines in the colours of the
 * page. Parts that are hidden are left out.
 * @param {import('./data/layer.js').Layer} layer
 * @param {import('./data/vectors.js').Vectors|null} vectors
 */
export function svgOf(layer, vectors, { head, origin, z, hidden, colours }) {
  const [[left, bottom], [right, top]] = head.box;
  const margin = 0.02 * Math.max(right - left, top - bottom);
  const box = [left - margin, -top - margin, right - left + 2 * margin, top - bottom + 2 * margin].map(number);
  const stroke = number(Math.max(right - left, top - bottom) / 1500);
  const paths = [];
  layer.parts.forEach((contours, part) => {
    if (hidden.has(part) || isVectors(head.parts[part])) return;
    const fill = colours.fills[part % colours.fills.length];
    const title = `<title>${escaped(head.parts[part].label)}</title>`;
    const of = (closed) => {
      const rings = closed ? contours.rings : contours.ends.length;
      const first = closed ? 0 : contours.rings;
      const begin = first === 0 ? 0 : contours.ends[first - 1];
      return { points: contours.points.subarray(2 * begin), ends: [...contours.ends.subarray(first, rings)].map((end) => end - begin), rings: closed ? rings : 0 };
    };
    paths.push(`<path fill="${fill}" fill-rule="nonzero" stroke="${colours.outer}" stroke-width="${stroke}" d="${pathData(of(true), origin)}">${title}</path>`);
    if (contours.rings < contours.ends.length)
      paths.push(`<path fill="none" stroke="${colours.open}" stroke-width="${stroke}" d="${pathData(of(false), origin)}">${title}</path>`);
    if (contours.hatches.length > 0)
      paths.push(`<path fill="none" stroke="${colours.hatch}" stroke-width="${stroke}" d="${linesData(contours.hatches, 0, contours.hatches.length / 4, origin)}">${title}</path>`);
  });
  for (let at = 0; vectors !== null && at < vectors.count; ) {
    const part = partOf(vectors, at);
    const end = vectors.ends[part];
    const { region, kind } = head.parts[part].exposure;
    if (!hidden.has(part))
      paths.push(
        `<path fill="none" stroke="${colours.vectors[`${region} ${kind}`]}" stroke-width="${stroke}" d="${linesData(vectors.lines, at, end, origin)}"><title>${escaped(head.parts[part].label)}</title></path>`,
      );
    at = end;
  }
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${box[2]}mm" height="${box[3]}mm" viewBox="${box.join(' ')}">` +
    `<title>${escaped(head.title)}, z = ${number(z)} mm</title>${paths.join('')}</svg>\n`
  );
}

/** "part" of "part.stl": files are named after it. */
export const stemOf = (title) => title.replace(/\.[^.]*$/, '').replace(/[^\p{L}\p{N}._-]+/gu, '_') || 'layers';

/** Hands a file to the browser, which asks where to put it or puts it among the downloads. */
export function saveFile(name, content, type) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // some browsers read it later
}

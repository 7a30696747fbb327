/** Numbers and counts as a person reads them. */

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

/** 1,234,567 */
export const count = (n) => whole.format(n);

/** "1 layer", "3 layers" */
export const counted = (n, one, many = `${one}s`) => `${count(n)} ${n === 1 ? one : many}`;

const least = 1e-6; // smaller numbers are shown as smaller, not as 0

/** Four digits that matter, more before the point: 0.05, 12.35, 1,235, 123,457. What is not 0 is not shown as 0. */
export function brief(value) {
  if (value === 0 || !Number.isFinite(value)) return String(value);
  if (Math.abs(value) < least) return value > 0 ? '< 0.000001' : '> −0.000001';
  const digits = Math.min(6, Math.max(0, 3 - Math.floor(Math.log10(Math.abs(value)))));
  return new Intl.NumberFormat('en', { maximumFractionDigits: digits }).format(value);
}

/** 4.87 s, 43 min 07 s, 2 h 05 min: three digits or more that matter. */
export function duration(seconds) {
  if (seconds < 60) return `${brief(seconds)} s`;
  const whole = Math.round(seconds);
  const two = (n) => String(n).padStart(2, '0');
  const minutes = Math.floor(whole / 60);
  return minutes < 60 ? `${minutes} min ${two(whole % 60)} s` : `${count(Math.floor(minutes / 60))} h ${two(minutes % 60)} min`;
}

/** As commands number layers: from 0, and those of a share of a part as in the whole. Written as for `--layers`, without commas. */
export const layerNumber = (table, layer) => String(table.index[layer]);

/** "(0 to 99)": the numbers that there are. */
export const layerNumbers = ({ index }) => (index.length > 0 ? `(${index[0]} to ${index.at(-1)})` : '');

/** A text of the program with its measures written as the page writes them: "19158.8 mm³" becomes "19,159 mm³". */
export const withBriefMeasures = (text) => text.replace(/(?<![\w.,])\d{4,}(\.\d+)?(?= mm)/g, (number) => brief(Number(number)));

const rounded = (value, digits) => new Intl.NumberFormat('en', { maximumFractionDigits: digits }).format(value);
const noise = 1e-9; // mm: what sums leave where there should be 0
const finest = 12; // digits after the point

/** What a file that keeps single precision meant: 53.1 for 53.099998474. */
function meant(value) {
  const short = Number(value.toPrecision(7)); // a float has no more digits
  return Math.fround(short) === value ? short : value;
}

/** Heights and lengths: to a millionth, so that the last digits that sums leave are gone, or four digits that matter. */
export function mm(exact) {
  const value = meant(exact);
  if (Math.abs(value) < noise) return '0';
  return rounded(value, Math.min(finest, Math.max(6, 3 - Math.floor(Math.log10(Math.abs(value))))));
}

/** A coordinate of a place, with as many digits as `lamella info` writes: 1,353.22. */
export const position = (value) => new Intl.NumberFormat('en', { maximumSignificantDigits: 6 }).format(Math.abs(value) < noise ? 0 : value);

/** A coordinate under the pointer: to a thousandth, or further where a pixel is as small as `pixel` mm. */
export const coordinate = (value, pixel) => rounded(value, Math.min(finest, Math.max(3, Math.ceil(-Math.log10(pixel)))));

export const size = (box) => box[0].map((low, k) => brief(box[1][k] - low)).join(' × ');

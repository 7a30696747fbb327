/** The smallest of 1, 2 or 5 times a power of ten that is at least `least`. */
export function roundStep(least) {
  const decade = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((digit) => digit * decade).find((step) => step >= least * 0.999999);
}

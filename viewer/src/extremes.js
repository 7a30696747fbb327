/**
 * The least and the largest number of a list, Infinity and -Infinity for an empty one. Lists grow with layers and edges, and a call
 * such as Math.min(...values) takes some 125,000 arguments and no more.
 */
export const least = (values) => values.reduce((best, value) => Math.min(best, value), Infinity);
export const largest = (values) => values.reduce((best, value) => Math.max(best, value), -Infinity);

/** The index of the value nearest to the one wanted. */
export const nearest = (values, wanted) => values.reduce((best, value, i) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? i : best), 0);

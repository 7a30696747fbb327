/**
 * On a canvas with the class `drawing`: where the page scrolls, one finger that moves up or down scrolls it (styles.css), and two
 * fingers are for the drawing.
 * @param {() => () => void} keep keeps what the drawing shows, and returns what shows that again. A finger may move the drawing
 *     a little before the browser takes it for scrolling.
 */
export function scrollOrPinch(canvas, keep) {
  canvas.style.touchAction = ''; // the style sheet decides
  canvas.addEventListener('touchstart', (event) => event.touches.length > 1 && event.preventDefault(), { passive: false });
  let restore = () => {};
  canvas.addEventListener('pointerdown', (event) => event.isPrimary && (restore = keep()), { capture: true });
  canvas.addEventListener('pointercancel', (event) => event.isPrimary && restore());
}

/** Tells the style sheet whether the page scrolls. */
export function watchScrolling() {
  const { documentElement, body } = document;
  new ResizeObserver(() => documentElement.classList.toggle('scrolls', documentElement.scrollHeight > innerHeight)).observe(body);
}

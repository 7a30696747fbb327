/** Which piece of the plane a canvas shows: mm to pixels, y up. */
export class Camera {
  constructor() {
    this.x = 0; // mm, in the middle of the canvas
    this.y = 0;
    this.scale = 1; // pixels per mm
    this.width = 1;
    this.height = 1;
    this.top = 0; // pixels at the upper edge that `fit` leaves free
    this.fitted = true; // follows the size of the canvas until somebody moves it
    this.box = [0, 0, 1, 1];
  }

  /** @param {number[]} box left, bottom, right, top: what `fit` shows */
  frame(box) {
    this.box = box;
    this.fit();
  }

  resize(width, height) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    if (this.fitted) this.fit();
  }

  get fitScale() {
    const [left, bottom, right, top] = this.box;
    const margin = 0.86;
    return margin * Math.min(this.width / Math.max(right - left, 1e-9), (this.height - this.top) / Math.max(top - bottom, 1e-9));
  }

  /** How many times larger than fitted. */
  get zoom() {
    return this.scale / this.fitScale;
  }

  fit() {
    const [left, bottom, right, top] = this.box;
    this.x = (left + right) / 2;
    this.scale = this.fitScale;
    this.y = (bottom + top) / 2 + this.top / 2 / this.scale;
    this.fitted = true;
  }

  moveBy(pixelsX, pixelsY) {
    this.x -= pixelsX / this.scale;
    this.y += pixelsY / this.scale;
    this.fitted = false;
  }

  /** The place under the pixel stays there. */
  zoomBy(factor, pixelX = this.width / 2, pixelY = this.height / 2) {
    const [x, y] = this.toPlane(pixelX, pixelY);
    const fit = this.fitScale;
    this.scale = Math.min(fit * 5e4, Math.max(fit / 20, this.scale * factor));
    this.x = x - (pixelX - this.width / 2) / this.scale;
    this.y = y + (pixelY - this.height / 2) / this.scale;
    this.fitted = false;
  }

  toPixelX(x) {
    return this.width / 2 + (x - this.x) * this.scale;
  }

  toPixelY(y) {
    return this.height / 2 - (y - this.y) * this.scale;
  }

  toPlane(pixelX, pixelY) {
    return [this.x + (pixelX - this.width / 2) / this.scale, this.y - (pixelY - this.height / 2) / this.scale];
  }

  /** Whether a box of mm, number `at` in an array, reaches into the canvas. */
  sees(boxes, at) {
    return (
      this.toPixelX(boxes[at]) <= this.width &&
      this.toPixelX(boxes[at + 2]) >= 0 &&
      this.toPixelY(boxes[at + 3]) <= this.height &&
      this.toPixelY(boxes[at + 1]) >= 0
    );
  }
}

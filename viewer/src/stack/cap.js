import { CanvasTexture, DoubleSide, LinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';
import { Camera } from '../layer/camera.js';
import { fillMaterial, pathOf } from '../layer/draw_layer.js';

const longest = 1024; // pixels
const margin = 4;

/** The material of one layer as a flat face: its fill, painted on a rectangle at its height. */
export class Cap {
  constructor(size) {
    const scale = (longest - 2 * margin) / Math.max(size.x, size.y, 1e-9);
    this.canvas = document.createElement('canvas');
    this.canvas.width = Math.max(2 * margin + 1, Math.ceil(size.x * scale) + 2 * margin);
    this.canvas.height = Math.max(2 * margin + 1, Math.ceil(size.y * scale) + 2 * margin);
    this.camera = new Camera();
    Object.assign(this.camera, {
      x: size.x / 2,
      y: size.y / 2,
      scale,
      width: this.canvas.width,
      height: this.canvas.height,
    });
    this.texture = new CanvasTexture(this.canvas);
    this.texture.minFilter = LinearFilter;
    this.texture.generateMipmaps = false;
    this.texture.anisotropy = 8;
    this.mesh = new Mesh(
      new PlaneGeometry(this.canvas.width / scale, this.canvas.height / scale),
      new MeshBasicMaterial({ map: this.texture, side: DoubleSide, alphaTest: 0.5 }),
    );
    this.mesh.position.set(size.x / 2, size.y / 2, 0);
  }

  /**
   * @param {import('../data/layer.js').Layer} layer
   * @param {number} z mm above the bottom of the scene
   * @param {string[]} colours of the parts
   * @param {Set<number>} hidden parts
   * @param {string} faultColour of what is inside out
   * @param {string|null} rim colour of its edge, where it shall have one
   */
  show(layer, z, colours, hidden, faultColour, rim = null) {
    const ctx = this.canvas.getContext('2d');
    ctx.clearRect(0, 0, this.canvas.width, this.canvas.height);
    layer.parts.forEach((contours, part) => {
      if (hidden.has(part)) return;
      const path = pathOf(contours, this.camera);
      fillMaterial(ctx, path, this.camera, colours[part], layer.insideOut.deepest, faultColour);
      if (rim === null) return;
      ctx.strokeStyle = rim;
      ctx.lineWidth = 5;
      ctx.save();
      ctx.clip(path, 'nonzero');
      ctx.stroke(path);
      ctx.restore();
    });
    this.texture.needsUpdate = true;
    this.mesh.position.z = z;
  }
}

import { NumberReader } from './number_reader.js';

/**
 * @typedef {object} Mesh
 * @property {Float32Array} vertices x, y, z in turn: mm from the corner of the box
 * @property {Uint32Array} triangles three vertices each
 * @property {Uint32Array} shells of each triangle
 */

/**
 * @param {Uint8Array} bytes unpacked
 * @param {number} step mm: the edge of the cubes in whose middles vertices lie
 * @returns {Mesh}
 */
export function readMesh(bytes, step) {
  const reader = new NumberReader(bytes);
  const mesh = { vertices: new Float32Array(3 * reader.next()) };
  const count = reader.next();
  mesh.triangles = new Uint32Array(3 * count);
  mesh.shells = new Uint32Array(count);
  const cell = [0, 0, 0];
  for (let i = 0; i < mesh.vertices.length; ++i) {
    cell[i % 3] += reader.nextSigned();
    mesh.vertices[i] = (cell[i % 3] + 0.5) * step;
  }
  let shell = 0;
  let corner = 0;
  for (let t = 0; t < count; ++t) {
    shell += reader.nextSigned();
    mesh.shells[t] = shell;
    for (let k = 0; k < 3; ++k) {
      corner += reader.nextSigned();
      mesh.triangles[3 * t + k] = corner;
    }
  }
  if (!reader.atEnd) throw new Error('the data of the mesh go on after their end');
  return mesh;
}

import { BufferAttribute, BufferGeometry, Color, DoubleSide, Mesh, ShaderMaterial, Vector3 } from 'three';
import { element } from '../element.js';
import { placeMarks } from '../stack/place_marks.js';
import { Space } from '../stack/space.js';

const vertex = /* glsl */ `
  attribute vec3 colour;
  varying vec3 seen;
  varying vec3 painted;

  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    seen = place.xyz;
    painted = colour;
    gl_Position = projectionMatrix * place;
  }
`;

const fragment = /* glsl */ `
  uniform vec3 inside;
  varying vec3 seen;
  varying vec3 painted;

  void main() {
    vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
    float key = max(0.0, dot(n, normalize(vec3(-0.45, 0.65, 0.7))));
    float side = max(0.0, dot(n, normalize(vec3(0.9, 0.1, 0.35))));
    vec3 colour = gl_FrontFacing ? painted : inside;
    gl_FragColor = vec4(colour * (0.34 + 0.58 * key + 0.2 * side), 1.0);
  }
`;

/** A mesh in space, each shell in a colour of its own, what is seen from inside in another one. */
export class MeshView {
  #space;
  #mesh;
  #colours;
  #origin;
  #marks;
  #surface;

  /** @param {import('../data/mesh.js').Mesh} mesh */
  constructor(page, mesh, store) {
    this.#mesh = mesh;
    this.#origin = page.head.box[0];
    this.#space = new Space(page.head.box, 'The mesh in space. Buttons look at it from several sides.', () => this.#bulk());
    this.#surface = this.#build();
    this.#marks = placeMarks(page.notes.places, this.#origin);
    this.#space.bulk.add(this.#surface);
    this.#space.over.add(this.#marks);
    this.node = element(
      'section',
      { className: 'pane', 'aria-label': 'The mesh in space' },
      this.#space.canvas,
      element(
        'div',
        { className: 'tools', role: 'toolbar', 'aria-label': 'How the mesh is seen' },
        ...this.#space.tools,
        this.#space.zoomTools,
      ),
    );
    store.on(['theme', 'shell'], (state) => this.#paint(state));
  }

  /** Triangles share no corners, so that shells that touch keep their colours. */
  #build() {
    const { vertices, triangles } = this.#mesh;
    const positions = new Float32Array(3 * triangles.length);
    for (let i = 0; i < positions.length; ++i) positions[i] = vertices[3 * triangles[Math.floor(i / 3)] + (i % 3)];
    this.#colours = new BufferAttribute(new Uint8Array(3 * triangles.length), 3, true);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('colour', this.#colours);
    const uniforms = { inside: { value: new Color() } };
    return new Mesh(geometry, new ShaderMaterial({ vertexShader: vertex, fragmentShader: fragment, side: DoubleSide, uniforms }));
  }

  #bulk() {
    return { bulk: [{ mesh: this.#surface, first: 0, count: this.#mesh.shells.length, vertices: 3 }], coarse: false };
  }

  /** All shells, or one of them with the others greyed. */
  #paint({ theme, shell }) {
    const bytes = (css) => new Color(css).toArray().map((c) => Math.round(255 * c));
    const walls = theme.walls.map(bytes);
    const grey = bytes(theme.gridStrong);
    const bytesOf = this.#colours.array;
    this.#mesh.shells.forEach((of, t) => {
      const colour = shell === null || shell === of ? walls[of % walls.length] : grey;
      for (let k = 0; k < 9; ++k) bytesOf[9 * t + k] = colour[k % 3];
    });
    this.#colours.needsUpdate = true;
    this.#surface.material.uniforms.inside.value.set(theme.wallCut);
    this.#marks.paint(theme);
    this.#space.paint(theme);
  }

  /** @param {number[]} place mm of the part's coordinates @param {number} reach mm around it */
  lookAt(place, reach) {
    this.#space.lookAt(this.#inScene(place), reach);
  }

  /** From where the outside of the surface around the place faces. */
  lookAtOutside(place, reach) {
    const middle = this.#inScene(place);
    this.#space.lookAt(middle, reach, this.#outwards(middle, reach));
  }

  #inScene(place) {
    return new Vector3(...place.map((value, k) => value - this.#origin[k]));
  }

  /** The mean normal of the triangles with a corner near the place; undefined where they face all ways. */
  #outwards(middle, reach) {
    const { vertices, triangles } = this.#mesh;
    const corners = [new Vector3(), new Vector3(), new Vector3()];
    const sum = new Vector3();
    let area = 0;
    for (let t = 0; t < triangles.length; t += 3) {
      corners.forEach((corner, k) => corner.fromArray(vertices, 3 * triangles[t + k]));
      if (!corners.some((corner) => corner.distanceToSquared(middle) < reach * reach)) continue;
      const normal = corners[1].clone().sub(corners[0]).cross(corners[2].clone().sub(corners[0]));
      sum.add(normal);
      area += normal.length();
    }
    return sum.length() > area / 10 ? sum : undefined;
  }

  turnBy(sideways, upwards) {
    this.#space.turnBy(sideways, upwards);
  }

  zoomBy(factor) {
    this.#space.zoomBy(factor);
  }

  /** From where one looks, in the mesh's coordinates; see Space. */
  get outlook() {
    return this.#space.outlookFrom(this.#origin);
  }

  set outlook(given) {
    this.#space.lookAsFrom(given, this.#origin);
  }

  fit() {
    this.#space.fit();
  }
}

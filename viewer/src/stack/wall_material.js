import { Color, DataTexture, DoubleSide, FloatType, FrontSide, RGFormat, ShaderMaterial, Vector3 } from 'three';
import { lineKinds, linesOfRow } from './walls.js';

/** How far ledges reach inwards, in thicknesses of the layer: over slopes of 18 degrees and more there are no gaps. */
const ledgeWidth = 3;
// Cards take a few thousand texels in a row.
const heightsOfRow = 1024;
const partsOfRow = 1024;

/** Bottom and top of each layer, mm, for the material to look up. */
export function heightsTexture(bottoms, tops) {
  const rows = Math.ceil(bottoms.length / heightsOfRow);
  const data = new Float32Array(2 * heightsOfRow * rows);
  bottoms.forEach((bottom, i) => data.set([bottom, tops[i]], 2 * i));
  const texture = new DataTexture(data, heightsOfRow, rows, RGFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

/** Four bytes for each part: its colour, and 255 where it is shown. To be filled. */
export function partsTexture(parts) {
  const rows = Math.ceil(parts / partsOfRow);
  return new DataTexture(new Uint8Array(4 * partsOfRow * rows), partsOfRow, rows);
}

/**
 * Each line of a contour has eight vertices: a wall, and on its top a ledge inwards. They are made here from what the
 * texture says of the line, since renderers without a graphics card take a thousand instances for a thousand pictures.
 */
const vertex = /* glsl */ `
  uniform highp usampler2D lines;
  uniform highp sampler2D heights;
  uniform sampler2D parts;
  uniform int layer;
  uniform int last;
  uniform int stride;
  uniform bool above;
  varying vec3 normalSeen;
  varying float upward;
  flat varying float isLedge;
  flat varying int number;
  flat varying int kind;
  flat varying vec3 own;

  vec2 heightsOf(int which) {
    return texelFetch(heights, ivec2(which % ${heightsOfRow}, which / ${heightsOfRow}), 0).rg;
  }

  void main() {
    int line = gl_VertexID >> 3;
    int corner = gl_VertexID & 7;
    float along = ((corner + 1) & 2) == 0 ? 0.0 : 1.0;
    float inward = corner < 6 ? 0.0 : 1.0;
    bool ledge = corner > 3;
    ivec2 at = ivec2(2 * (line % ${linesOfRow}), line / ${linesOfRow});
    vec4 ends = uintBitsToFloat(texelFetch(lines, at, 0));
    uvec4 info = texelFetch(lines, at + ivec2(1, 0), 0);
    number = int(info.x);
    int part = int(info.y) >> 2;
    kind = int(info.y) & 3;
    // A layer stands for those above it that are not drawn, too.
    vec2 span = heightsOf(number);
    float top = heightsOf(min(number + stride - 1, above ? last : layer)).y;
    upward = corner < 2 ? 0.0 : 1.0;
    vec3 place = vec3(mix(ends.xy, ends.zw, along), mix(span.x, top, upward));
    vec2 outward = mix(unpackSnorm2x16(info.z), unpackSnorm2x16(info.w), along);
    place.xy -= outward * inward * ${ledgeWidth.toFixed(1)} * (span.y - span.x);
    isLedge = ledge ? 1.0 : 0.0;
    normalSeen = normalize(normalMatrix * (ledge ? vec3(0.0, 0.0, 1.0) : vec3(outward, 0.0)));
    gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
    vec4 look = texelFetch(parts, ivec2(part % ${partsOfRow}, part / ${partsOfRow}), 0);
    own = look.rgb;
    bool isHidden = look.a < 0.5;
    // Ledges of open contours would lie nowhere, those of ghosts would hide them, and the top layer has a cap.
    bool isBare = ledge && (above || number + stride > layer || kind != ${lineKinds.ring});
    if (isHidden || isBare) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  }
`;

const light = /* glsl */ `
  /** Light from above left and behind the eye, softer from the right, and from the sky. */
  float lit(vec3 n) {
    float key = max(0.0, dot(n, normalize(vec3(-0.45, 0.65, 0.7))));
    float side = max(0.0, dot(n, normalize(vec3(0.9, 0.1, 0.35))));
    return 0.36 + 0.58 * key + 0.2 * side;
  }
`;

const fragment = /* glsl */ `
  uniform int layer;
  uniform bool above;
  uniform vec3 current;
  uniform vec3 fault;
  uniform vec3 up;
  varying vec3 normalSeen;
  varying float upward;
  flat varying float isLedge;
  flat varying int number;
  flat varying int kind;
  flat varying vec3 own;
  ${light}

  void main() {
    bool isFault = kind == ${lineKinds.fault};
    if (above) {
      gl_FragColor = vec4(isFault ? fault : own, isFault ? 0.3 : 0.07);
      return;
    }
    if (isFault) {
      gl_FragColor = vec4(fault * (0.8 + 0.3 * lit(normalSeen)), 1.0);
      return;
    }
    vec3 colour = number == layer ? current : own;
    // What is seen from inside is seen through a gap beside a ledge, so it gets the light of a ledge.
    // Where layers are thinner than a pixel or two, ledges and walls alternate as the raster will: they are
    // brought closer to each other.
    float pixels = fwidth(upward);
    float thin = smoothstep(0.3, 0.8, pixels);
    float wall = lit(normalize(normalSeen));
    bool isWall = gl_FrontFacing && isLedge < 0.5;
    float brightness = isWall ? mix(wall, 0.75 * wall + 0.17, thin) : lit(up) * mix(0.94, 0.8, thin);
    // The seams between layers, where they are large enough to be distinguished.
    float seam = 1.0 - smoothstep(0.0, max(0.06, pixels), min(upward, 1.0 - upward));
    brightness *= 1.0 - 0.22 * seam * (1.0 - smoothstep(0.15, 0.45, pixels)) * (isWall ? 1.0 : 0.0);
    gl_FragColor = vec4(colour * brightness, 1.0);
  }
`;

/**
 * @param {boolean} above the ghosts of the layers above instead of the stack up to the layer
 * @param {import('three').DataTexture} heights of the layers
 * @param {number} last layer
 * @param {import('three').DataTexture} parts as partsTexture makes it
 */
export function wallMaterial(above, heights, last, parts) {
  return new ShaderMaterial({
    vertexShader: vertex,
    fragmentShader: fragment,
    side: above ? FrontSide : DoubleSide,
    transparent: above,
    depthWrite: !above,
    uniforms: {
      lines: { value: null },
      heights: { value: heights },
      parts: { value: parts },
      layer: { value: 0 },
      last: { value: last },
      stride: { value: 1 },
      above: { value: above },
      current: { value: new Color() },
      fault: { value: new Color() },
      up: { value: new Vector3(0, 0, 1) },
    },
  });
}

/** The light on a flat top, for what is drawn without this material. */
export function topBrightness(up) {
  const key = new Vector3(-0.45, 0.65, 0.7).normalize();
  const side = new Vector3(0.9, 0.1, 0.35).normalize();
  return 0.36 + 0.58 * Math.max(0, up.dot(key)) + 0.2 * Math.max(0, up.dot(side));
}

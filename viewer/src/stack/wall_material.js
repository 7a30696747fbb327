import { Color, DoubleSide, FrontSide, ShaderMaterial, Vector3 } from 'three';

const mostParts = 8;
/** How far ledges reach inwards, in thicknesses of the layer: over slopes of 18 degrees and more there are no gaps. */
const ledgeWidth = 3;

const vertex = /* glsl */ `
  attribute float ledge;
  attribute vec4 ends;
  attribute vec2 heights;
  attribute vec4 normals;
  attribute vec2 info;
  uniform float layer;
  uniform bool above;
  uniform sampler2D hidden;
  varying vec3 normalSeen;
  varying float upward;
  flat varying float isLedge;
  flat varying vec2 which;

  void main() {
    vec3 place = vec3(mix(ends.xy, ends.zw, position.x), mix(heights.x, heights.y, position.y));
    vec2 outward = mix(normals.xy, normals.zw, position.x);
    place.xy -= outward * position.z * ${ledgeWidth.toFixed(1)} * (heights.y - heights.x);
    upward = position.y;
    isLedge = ledge;
    which = info;
    normalSeen = normalize(normalMatrix * (ledge > 0.5 ? vec3(0.0, 0.0, 1.0) : vec3(outward, 0.0)));
    gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
    // Out of sight: what is above the layer that is shown, or below it among the ghosts; and hidden parts.
    bool isHidden = texelFetch(hidden, ivec2(int(info.y), 0), 0).r > 0.5;
    // Ledges of open contours would lie nowhere, those of ghosts would hide them, and the top layer has a cap.
    bool isBare = ledge > 0.5 && (above || info.x == layer || fract(info.y) > 0.25);
    if (isHidden || isBare || (info.x > layer) != above) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
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
  uniform float layer;
  uniform bool above;
  uniform vec3 parts[${mostParts}];
  uniform vec3 current;
  uniform vec3 open;
  uniform vec3 up;
  varying vec3 normalSeen;
  varying float upward;
  flat varying float isLedge;
  flat varying vec2 which;
  ${light}

  void main() {
    int part = int(which.y + 0.1);
    vec3 colour = parts[part - (part / ${mostParts}) * ${mostParts}];
    bool isOpen = fract(which.y) > 0.25;
    if (above) {
      gl_FragColor = vec4(isOpen ? open : colour, isOpen ? 0.3 : 0.07);
      return;
    }
    if (isOpen) {
      gl_FragColor = vec4(open * (0.8 + 0.3 * lit(normalSeen)), 1.0);
      return;
    }
    if (which.x == layer) colour = current;
    // What is seen from inside is seen through a gap beside a ledge, so it gets the light of a ledge.
    // Where layers are thinner than a pixel or two, ledges and walls alternate as the raster will: they are
    // brought closer to each other.
    float pixels = fwidth(upward);
    float thin = smoothstep(0.3, 0.8, pixels);
    float wall = lit(normalize(normalSeen));
    bool isWall = gl_FrontFacing && isLedge < 0.5;
    float brightness = isWall ? mix(wall, 0.75 * wall + 0.17, thin) : lit(up) * mix(0.94, 0.8, thin);
    // The seams between layers, where they are large enough to be told apart.
    float seam = 1.0 - smoothstep(0.0, max(0.06, pixels), min(upward, 1.0 - upward));
    brightness *= 1.0 - 0.22 * seam * (1.0 - smoothstep(0.15, 0.45, pixels)) * (isWall ? 1.0 : 0.0);
    gl_FragColor = vec4(colour * brightness, 1.0);
  }
`;

/**
 * @param {boolean} above the ghosts of the layers above instead of the stack up to the layer
 * @param {import('three').DataTexture} hidden a byte for each part: 255 for those that are not shown
 */
export function wallMaterial(above, hidden) {
  return new ShaderMaterial({
    vertexShader: vertex,
    fragmentShader: fragment,
    side: above ? FrontSide : DoubleSide,
    transparent: above,
    depthWrite: !above,
    uniforms: {
      layer: { value: 0 },
      above: { value: above },
      hidden: { value: hidden },
      parts: { value: Array.from({ length: mostParts }, () => new Color()) },
      current: { value: new Color() },
      open: { value: new Color() },
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

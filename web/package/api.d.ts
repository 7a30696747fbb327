// Types of the package. The options are those of the program, in camel case: `lamella slice --help` describes them.
/// <reference lib="esnext.disposable" />

export type Bytes = Uint8Array | ArrayBuffer | ArrayBufferView | string;
export type Triple = readonly [number, number, number];
export type Range = readonly [from: number | null, to: number | null];

export interface Progress {
  stage: 'read' | 'weld' | 'link' | 'slice' | 'polygon' | 'write';
  done: number;
  total: number;
  seconds: number;
}

export interface CallOptions {
  /** Ends the call; its promise is rejected with the reason of the signal. */
  signal?: AbortSignal;
  onProgress?: (progress: Progress) => void;
}

export type ErrorKind = 'internal' | 'usage' | 'input' | 'defect' | 'limit' | 'output' | 'cancelled';

/** A failure that the program reports; its message is the text of the program. */
export class LamellaError extends Error {
  constructor(message: string, exitCode: number);
  readonly kind: ErrorKind;
  readonly exitCode: number;
  readonly warnings?: string[];
}

export type Unit = 'mm' | 'cm' | 'm' | 'inch' | 'ft' | 'um' | number;
export type Box = [min: [number, number, number], max: [number, number, number]];

/** A mesh file that was read without an error. */
export class Mesh {
  private constructor();
  /** Frees the memory of this object earlier than the garbage collector does. The object must not be used afterwards. */
  dispose(): void;
  [Symbol.dispose](): void;
  readonly name: string;
  /** The file. */
  readonly bytes: Uint8Array;
  /** Such as `stl-binary` or `3mf`. */
  readonly format: string;
  /** In the file. */
  readonly triangles: number;
  readonly unit: string;
  /** Of all parts, mm. */
  readonly box: Box;
  readonly parts: { label: string; support: boolean; box: Box }[];
  readonly warnings: string[];
}

export interface ReadOptions extends CallOptions {
  /** The unit of a file that does not give it. */
  unit?: Unit;
  /** Roles of bodies in 3MF and AMF files that are read as solids, too. */
  include?: string | string[];
  maxTriangles?: number;
}

/** Reads a mesh file (STL, OBJ, PLY, OFF, 3MF, AMF); its format is recognised by its content. */
export function readMesh(data: Bytes, name?: string, options?: ReadOptions): Promise<Mesh>;
/**
 * Makes a mesh of arrays, as three.js, manifold-3d and others have them.
 * `positions` has x, y and z of each vertex, in turn. Its numbers are kept: single precision in a `Float32Array`, double precision
 * otherwise. `indices` has three vertices for each triangle, counter-clockwise seen from outside; without it, vertices follow one
 * another. `name` (`mesh` unless given) names the mesh in messages and its part on a plate.
 * Rejects with kind `usage` if an index is no vertex.
 */
export function meshOf(
  positions: ArrayLike<number>,
  indices?: ArrayLike<number> | null,
  options?: ReadOptions & { name?: string },
): Promise<Mesh>;
/** Reads a slice file (CLI, SVG, SLC, 3MF, JSON, NPZ, ILT, OVF); its format is recognised by its content. */
export function readLayers(data: Bytes, name?: string, options?: CallOptions): Promise<Stack>;
/** Reads a mesh or layers, whatever the file holds. */
export function readFile(data: Bytes, name?: string, options?: ReadOptions): Promise<Mesh | Stack>;

export type Body =
  | 'sheet' | 'rook' | 'dodecahedra' | 'calibration' | 'head' | 'sole' | 'lattice' | 'box' | 'sphere' | 'torus' | 'cylinder';
export interface BodyOptions {
  format?: 'stl' | 'ply' | 'obj';
  ascii?: boolean;
  shuffle?: number;
  holes?: number;
  segments?: number;
  size?: number | Triple;
  thickness?: number;
  cells?: number;
  detail?: number;
  order?: 'wall' | 'hole' | 'split' | 'shuffle';
  scale?: number | Triple;
  rotate?: Triple;
  rotateX?: number;
  rotateY?: number;
  rotateZ?: number;
  translate?: Triple;
  signal?: AbortSignal;
}
/** Makes a test body. */
export function makeBody(body: Body, options?: BodyOptions): Promise<Mesh>;

/** What `lamella info --json` prints. */
export interface Diagnosis {
  triangles: number;
  vertices: number;
  bbox: Box;
  volume_mm3: number;
  area_mm2: number;
  closed: boolean;
  shells: number;
  cavities: number;
  defects: Record<string, number>;
  places: Record<string, unknown[]>;
  warnings: string[];
  [fact: string]: unknown;
}
export function diagnose(mesh: Mesh, options?: CallOptions & { selfIntersections?: boolean; unit?: Unit }): Promise<Diagnosis>;

export interface Placement {
  unit?: Unit;
  scale?: number | Triple;
  rotate?: Triple;
  rotateX?: number;
  rotateY?: number;
  rotateZ?: number;
  translate?: Triple;
  /** Slices along this direction instead of z. */
  direction?: Triple;
  copies?: number;
  spacing?: number;
  label?: string;
  support?: boolean;
}

/** Options of the files of some formats. */
export interface WriteOptions extends CallOptions {
  unitsMm?: number;
  short?: boolean;
  maxOutput?: number | string;
  strict?: boolean;
  pixelSize?: number | readonly [number, number];
  resolution?: readonly [number, number];
  displaySize?: readonly [number, number];
  /** Name of a resin printer, or a part of it that no other has: determines the display. */
  printer?: string;
  orientation?: 'landscape' | 'portrait';
  mirror?: 'none' | 'x' | 'y' | 'xy';
  antialias?: number;
  gamma?: number;
  /** Grey values (0 to 255) of pixels by their covered part (0 to 1), interpolated between, instead of gamma. */
  greyCurve?: (readonly [covered: number, value: number])[];
  /** png, png-zip: 'auto', or '#rrggbb' for each part: pixels have the colour of the part in which their middle lies. */
  partColours?: 'auto' | string[];
  exposure?: number;
  firstExposure?: number;
  fadeLayers?: number;
}

export interface SliceOptions extends WriteOptions, Placement {
  layerHeight?: number;
  firstLayerHeight?: number;
  sliceAt?: 'bottom' | 'middle' | 'top';
  /** Number of cuts of each layer whose mean its image shows. */
  zAntialias?: number;
  zRange?: Range;
  layers?: Range;
  /** Cuts at exactly these heights. */
  zList?: number[];
  /** Layers of a height from here to there above the bottom. */
  heights?: (readonly [from: number, to: number, layerHeight: number])[];
  adaptive?: readonly [min: number, max: number];
  cusp?: number;
  snap?: number;
  weldTolerance?: number;
  dropDuplicates?: boolean;
  orient?: boolean;
  closeGaps?: number;
  fill?: 'none' | 'nonzero' | 'evenodd' | 'positive';
  offset?: number;
  /** Against the bulge of the first layers (elephant's foot): inwards by `inset` at the plate, by less up to `height` above it. */
  bottomOffset?: readonly [inset: number, height: number];
  offsetCorners?: 'mitre' | 'bevel' | 'round';
  largestOnly?: boolean;
  minArea?: number;
  simplify?: number;
  /** Scan vectors instead of contours. */
  scan?: boolean;
  /** The text of a strategy file. */
  strategy?: string;
  contours?: number;
  beamOffset?: number;
  contourDistance?: number;
  pattern?: 'lines' | 'meander' | 'stripes' | 'chessboard' | 'hexagons';
  hatchDistance?: number;
  hatchAngle?: number;
  hatchTurn?: number;
  hatchBorder?: number;
  shortest?: number;
  cellSize?: number;
  uniteParts?: boolean;
  skinLayers?: number;
  buildVolume?: Triple;
  engine?: 'sweep' | 'conventional' | 'ecc' | 'ecc-edge-match' | 'eecc';
  inspect?: boolean;
  include?: string | string[];
  maxTriangles?: number;
  maxMemory?: number | string;
  /** Where threads can share memory: in Node.js and in isolated pages. The layers are the same for any number. */
  threads?: number;
}

/** The contours of one plane. `points`, `closed` and `hatches` are views of the stack's memory. */
export class Layer {
  private constructor();
  readonly index: number;
  /** Heights of the cut, and of the bottom and top of the material, mm. */
  readonly z: number;
  readonly bottom: number;
  readonly top: number;
  /** Number of contours. */
  readonly contours: number;
  /** x and y of all points, in turn, mm. */
  readonly points: Float64Array;
  /** Contour i has the points from offsets[i] to offsets[i + 1]; a ring does not repeat its first point. */
  readonly offsets: Uint32Array;
  /** 1 for each ring, 0 for each open contour. */
  readonly closed: Uint8Array;
  /** The part of each contour: an index of `Stack.labels`. */
  readonly parts: Uint32Array;
  /** x and y of the first and last point of each hatch line, in turn. */
  readonly hatches: Float64Array;
  readonly hatchParts: Uint32Array;
  /** x and y of the points of contour i, in turn. */
  contour(i: number): Float64Array;

  // Of sliced layers:
  /** Content hash of the contours: equal on every machine. */
  readonly hash?: string;
  readonly thickness?: number;
  readonly holes?: number;
  readonly areaMm2?: number;
  readonly perimeterMm?: number;
  readonly openChains?: number;
}

/** Layers in ascending z. */
export class Stack {
  private constructor();
  /** Frees the memory of this object earlier than the garbage collector does. The object must not be used afterwards. */
  dispose(): void;
  [Symbol.dispose](): void;
  readonly layers: Layer[];
  /** Of the parts. */
  readonly labels: string[];
  /** What `lamella slice --stats` writes; null for layers that were read. */
  readonly statistics: Record<string, any> | null;
  readonly warnings: string[];
  /** An NPZ file of the layers. */
  readonly bytes: Uint8Array;
}

export type PlacedMesh = Mesh | ({ mesh: Mesh } & Placement);

/** Slices one mesh, or several on one plate. */
export function slice(meshes: Mesh | readonly PlacedMesh[], options?: SliceOptions): Promise<Stack>;

/** Layers in ascending z, each as soon as it and all below it are sliced. Leaving the loop stops the computation. */
export interface LayerStream extends AsyncGenerator<Layer, void, void> {
  /** Of the parts; complete before the first layer. */
  readonly labels: string[];
  /** Complete behind the last layer. */
  readonly warnings: string[];
}
/**
 * Slices like `slice`, and yields the layers one by one. They have neither `hash` nor figures. Where threads can share memory (in
 * Node.js and isolated pages), slicing waits while 16 MB of layers wait for the loop.
 */
export function sliceLayers(meshes: Mesh | readonly PlacedMesh[], options?: SliceOptions): LayerStream;

export type FileFormat =
  | 'cli' | 'cli-ascii' | 'svg' | 'slc' | '3mf' | 'dxf' | 'geojson' | 'json' | 'npz' | 'raw' | 'ilt' | 'ovf' | '3mf-toolpath' | 'html'
  | 'svg-layers' | 'png-zip' | 'sl1' | 'sl1s' | 'goo' | 'ctb' | 'cbddlp' | 'anycubic' | 'chitubox-zip' | 'nanodlp';

/** Slices into a slice file, without layers in between. */
export function sliceToFile(
  meshes: Mesh | readonly PlacedMesh[],
  format: FileFormat,
  options?: SliceOptions,
): Promise<{ bytes: Uint8Array; statistics: Record<string, any>; warnings: string[] }>;

/** Writes layers in a slice format. */
export function writeLayers(stack: Stack, format: FileFormat, options?: WriteOptions & { label?: string }): Promise<Uint8Array>;
/** Writes one file for each layer. */
export function writeLayers(stack: Stack, format: 'png', options?: WriteOptions): Promise<Record<string, Uint8Array>>;

/** Material, or a space, over consecutive layers of a print; lengths in mm. */
export interface PrintRegion {
  layer: number;
  /** The bottom of the first layer and the top of the last one. */
  z: [number, number];
  /** The centroid in the first layer. */
  centre: [number, number];
  area_mm2: number;
  largest_mm2: number;
  volume_mm3: number;
}
/** Layers as pixels. */
export interface Pixels {
  /** Layer by layer, each row by row in ascending y, each row in ascending x: 255 times the covered part of a pixel. */
  data: Uint8Array;
  shape: [layers: number, rows: number, columns: number];
  /** Size of a pixel along x and y, mm. */
  spacing: [x: number, y: number];
  /** Centre of the first pixel, mm. */
  origin: [x: number, y: number];
  /** Height of the cut of each layer, mm. */
  z: Float64Array;
}
/** Draws the layers. By default pixels are 0.05 mm wide, and the images are as large as the part. */
export function pixels(
  stack: Stack,
  options?: CallOptions & Pick<WriteOptions, 'pixelSize' | 'resolution' | 'displaySize' | 'antialias' | 'gamma' | 'greyCurve'>,
): Promise<Pixels>;

/** What `lamella check --json` prints. */
export interface PrintCheck {
  ok: boolean;
  layers: number;
  islands: number;
  overhangs: number;
  overhangs_mm2: number;
  cups: number;
  traps: number;
  traps_mm3: number;
  empty_layers: number;
  area_jumps: number;
  list_of_islands: (PrintRegion & { joins: boolean; support: boolean })[];
  list_of_cavities: (PrintRegion & { trap: boolean; on_plate: boolean; opens: boolean })[];
  findings: string[];
  warnings: string[];
  [fact: string]: unknown;
}
/** Finds islands, overhangs and enclosed resin. `touch` is an area in mm2, `overhangAngle` an angle in degrees. */
export function checkPrint(meshOrStack: Mesh | Stack, options?: SliceOptions & { touch?: number; overhangAngle?: number }): Promise<PrintCheck>;

/** A page that shows the layers, as `lamella view` writes it: HTML. */
export function view(meshOrStack: Mesh | Stack, options?: SliceOptions): Promise<Uint8Array>;

export interface RunOptions extends CallOptions {
  /** Called with the bytes of standard output as they come; `RunResult.text` is then empty. */
  onOutput?: (bytes: Uint8Array) => void;
}
export interface RunResult {
  /** Exit code of the program. */
  code: number;
  /** Standard output. */
  text: string;
  warnings: string[];
  /** Other lines of standard error. */
  notes: string[];
  /** The files that the program wrote, by name. */
  files: Record<string, Uint8Array>;
}
/** Runs the program with the words of a command line, on files given by name. Throws LamellaError if it fails. */
export function run(words: string[], files?: Record<string, Bytes>, options?: RunOptions): Promise<RunResult>;

/** Terminates idle workers. The next call starts new ones. */
export function releaseWorkers(): void;

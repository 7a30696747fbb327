// Compiled by tsc: the types of the package fit the way in which it is used.

import { LamellaError, Mesh, Stack, diagnose, makeBody, meshOf, readFile, readMesh, run, slice, sliceLayers, sliceToFile, view, writeLayers } from 'lamella';

const mesh: Mesh = await readMesh(new Uint8Array(), 'part.stl', { unit: 'inch' });
const stack: Stack = await slice([mesh, { mesh, translate: [1, 2, 3] }], {
  layerHeight: 0.1,
  heights: [[0, 1, 0.05]],
  layers: [0, null],
  onProgress: ({ stage, done, total }) => console.log(stage, done / total),
  signal: AbortSignal.timeout(1000),
});
for await (const layer of sliceLayers(mesh, { layerHeight: 0.1, threads: 2 })) console.log(layer.z, layer.points.length);
const points: Float64Array = stack.layers[0].points;
const cli: Uint8Array = await writeLayers(stack, 'cli', { short: true });
const images: Record<string, Uint8Array> = await writeLayers(stack, 'png');
const { bytes, warnings } = await sliceToFile(mesh, 'ilt', { scan: true, strategy: '' });
const found: boolean = (await diagnose(mesh, { selfIntersections: true })).closed;
const either: Mesh | Stack = await readFile(cli);
const { files } = await run(['info', 'part.stl'], { 'part.stl': mesh.bytes });
const triangle: Mesh = await meshOf(new Float32Array(9), [0, 1, 2], { name: 'triangle', unit: 'cm' });
{
  using disposed = await slice(triangle);
  console.log(disposed.layers.length);
}
const page: Uint8Array = await view(await makeBody('rook'));
try {
  // @ts-expect-error: there is no such option
  await slice(mesh, { layerHight: 0.1 });
} catch (error) {
  if (error instanceof LamellaError && error.kind === 'usage') console.log(error.message);
}
console.log(points, images, bytes, warnings, found, either, files, page);

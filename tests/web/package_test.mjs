// The npm package against the program of this computer: LAMELLA_PROGRAM, LAMELLA_PACKAGE (its folder).

import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';

process.env.SOURCE_DATE_EPOCH = '0';
const program = process.env.LAMELLA_PROGRAM;
const packageFolder = process.env.LAMELLA_PACKAGE;
const lamella = await import(pathToFileURL(join(packageFolder, 'node.js')).href);
const { LamellaError, Mesh, Stack, checkPrint, diagnose, makeBody, meshOf, pixels, readFile, readLayers, readMesh, run, slice, sliceLayers, sliceToFile, view, writeLayers } = lamella;

const folder = mkdtempSync(join(tmpdir(), 'lamella-web-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const native = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 });
const bytesOf = (name) => new Uint8Array(readFileSync(join(folder, name)));
const same = (a, b) => Buffer.compare(Buffer.from(a), Buffer.from(b)) === 0;

/** Each test body, small enough for a moment, with a layer height that gives some dozens of layers. */
const bodies = [
  ['sheet', { holes: 25, segments: 64 }, 0.2],
  ['rook', {}, 1],
  ['dodecahedra', {}, 2],
  ['calibration', {}, 1],
  ['head', {}, 8],
  ['sole', {}, 1],
  ['lattice', { cells: 2 }, 0.5],
  ['box', { size: 10, rotate: [10, 20, 30] }, 0.5],
  ['sphere', { size: 20 }, 0.5],
  ['torus', { size: 20 }, 0.5],
  ['cylinder', { size: 20 }, 0.5],
];

const kebab = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
const words = (options) => Object.entries(options).flatMap(([name, value]) => [`--${kebab(name)}`, String(value)]);

for (const [body, options, layerHeight] of bodies)
  test(`${body} has the bytes of the program's file and the content hash of each of its layers`, async () => {
    native('make', body, '-o', `${body}.stl`, ...words(options));
    const mesh = await makeBody(body, options);
    assert.ok(same(mesh.bytes, bytesOf(`${body}.stl`)));
    native('slice', `${body}.stl`, '--stats', 'stats.json', '--layer-height', String(layerHeight));
    const expected = JSON.parse(readFileSync(join(folder, 'stats.json'), 'utf8'));
    const stack = await slice(mesh, { layerHeight });
    assert.equal(stack.layers.length, expected.layers.length);
    expected.layers.forEach(({ hash, z, contours, points }, i) => {
      const layer = stack.layers[i];
      assert.deepEqual([layer.hash, layer.z, layer.contours, layer.points.length / 2], [hash, z, contours, points]);
    });
    assert.equal(mesh.triangles, expected.input.triangles);
    assert.deepEqual(mesh.box, expected.input.bbox);
  });

/** A bipyramid of so many vertices: its vertices and triangles. */
function bipyramid(vertices) {
  const around = vertices - 2;
  const ring = Array.from({ length: around }, (_, i) => [10 * Math.cos((2 * Math.PI * i) / around), 10 * Math.sin((2 * Math.PI * i) / around), 0]);
  const faces = ring.flatMap((_, i) => [[i, (i + 1) % around, around], [(i + 1) % around, i, around + 1]]);
  return { points: [...ring, [0, 0, 10], [0, 0, -10]], faces };
}

/** A file of it, in a format whose vertices are doubles. */
const offOf = ({ points, faces }) =>
  `OFF\n${points.length} ${faces.length} 0\n${points.map((p) => p.join(' ')).join('\n')}\n${faces.map((f) => `3 ${f.join(' ')}`).join('\n')}\n`;

test('rotated meshes of any number of vertices have the layers of the program', async () => {
  for (const vertices of [7, 8, 9, 10, 11]) {
    const text = offOf(bipyramid(vertices));
    writeFileSync(join(folder, 'bipyramid.off'), text);
    native('slice', 'bipyramid.off', '--stats', 'bipyramid.json', '--layer-height', '0.5', '--rotate', '25,40,10');
    const stack = await slice(await readMesh(text, 'bipyramid.off'), { layerHeight: 0.5, rotate: [25, 40, 10] });
    const expected = JSON.parse(readFileSync(join(folder, 'bipyramid.json'), 'utf8')).layers.map(({ hash }) => hash);
    assert.deepEqual(stack.layers.map(({ hash }) => hash), expected, `${vertices} vertices`);
  }
});

test('a mesh of arrays has the layers of a file of the same numbers', async () => {
  const { points, faces } = bipyramid(9);
  const text = offOf({ points, faces });
  const hashes = async (mesh) => (await slice(mesh, { layerHeight: 0.5, rotate: [25, 40, 10] })).layers.map(({ hash }) => hash);
  const expected = await hashes(await readMesh(text, 'bipyramid.off'));
  const [positions, indices] = [points.flat(), faces.flat()];
  assert.deepEqual(await hashes(await meshOf(positions, indices)), expected);
  assert.deepEqual(await hashes(await meshOf(Float64Array.from(positions), Uint16Array.from(indices))), expected);
  assert.deepEqual(await hashes(await meshOf(indices.flatMap((i) => points[i]))), expected);
  const single = Float32Array.from(positions);
  assert.deepEqual(await hashes(await meshOf(single, Uint32Array.from(indices))), await hashes(await meshOf(Array.from(single), indices)));
  const mesh = await meshOf(single, indices, { name: 'pyramid', unit: 'cm' });
  assert.deepEqual([mesh.name, mesh.triangles, mesh.box[1][2]], ['pyramid.ply', faces.length, 100]);
  const plate = await slice([mesh, { mesh, translate: [300, 0, 0] }], { layerHeight: 50 });
  for (const label of plate.labels) assert.match(label, /^pyramid/);
});

test('arrays that are no mesh are refused with the number that is wrong', async () => {
  for (const [positions, indices, message] of [
    [[0, 0, 0, 1], [], /4 positions/],
    [[0, 0, 0], [0, 0], /2 indices/],
    [[0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 3], /index 2 is 3, but the vertices are 0 to 2/],
    [[0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, -1], /index 2 is -1/],
    [[0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 1.5], /index 2 is 1.5/],
    [[0, 0, 0, 1, 0, 0], undefined, /2 vertices/],
  ])
    await assert.rejects(meshOf(positions, indices), { name: 'LamellaError', kind: 'usage', message });
  await assert.rejects(meshOf([NaN, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2]), { name: 'LamellaError', kind: 'input' });
  await assert.rejects(meshOf({ length: 9 }, [0, 1, 2]), TypeError);
  await assert.rejects(meshOf(new ArrayBuffer(36)), TypeError);
});

test('a mesh keeps the options with which it was read', async () => {
  const { bytes } = await makeBody('box', { size: 1 });
  const inches = await readMesh(bytes, 'box.stl', { unit: 'inch' });
  assert.equal(inches.box[1][2], 25.4);
  const top = async (meshes, options) => (await slice(meshes, { layerHeight: 1, ...options })).layers.at(-1).top;
  assert.ok(Math.abs((await top(inches)) - 25.4) <= 1);
  assert.ok(Math.abs((await top([inches, { mesh: inches, translate: [50, 0, 0] }])) - 25.4) <= 1);
  assert.ok(Math.abs((await top(inches, { unit: 'cm' })) - 10) <= 1);
  assert.ok(Math.abs((await diagnose(inches)).volume_mm3 - 25.4 ** 3) < 1e-6);
});

test('what is no mesh or was disposed of is refused by name', async () => {
  const box = await makeBody('box');
  const stack = await slice(box, { layerHeight: 5 });
  for (const [wrong, found] of [[{}, 'object'], [stack, 'a Stack'], [null, 'null'], [undefined, 'undefined'], [box.bytes, 'object'], [[{ mesh: stack }], 'a Stack']])
    for (const call of [slice, (one) => sliceToFile(one, 'cli'), (one) => sliceLayers(one).next()])
      await assert.rejects(call(wrong), { name: 'TypeError', message: new RegExp(`takes a Mesh, not ${found}`) });
  await assert.rejects(writeLayers(box, 'cli'), { name: 'TypeError', message: 'writeLayers takes a Stack, not a Mesh' });
  await assert.rejects(diagnose(stack), { name: 'TypeError', message: 'diagnose takes a Mesh, not a Stack' });
  await assert.rejects(view({}), { name: 'TypeError', message: /a Mesh or a Stack/ });
  box.dispose();
  stack.dispose();
  await assert.rejects(slice(box), { kind: 'usage', message: 'slice: the Mesh was disposed of and has no data any more' });
  await assert.rejects(writeLayers(stack, 'cli'), { kind: 'usage', message: /^writeLayers: the Stack was disposed of/ });
  await assert.rejects(view(stack), { kind: 'usage', message: /^view: the Stack was disposed of/ });
});

test('an exception of a callback rejects the promise, and the next call works', async () => {
  const mesh = await makeBody('rook');
  const failing = () => {
    throw new RangeError('of the callback');
  };
  const refused = { name: 'RangeError', message: 'of the callback' };
  await assert.rejects(slice(mesh, { onProgress: failing }), refused);
  await assert.rejects(sliceLayers(mesh, { onProgress: failing }).next(), refused);
  await assert.rejects(run(['slice', 'rook.stl', '-o', '-', '--format', 'cli'], { 'rook.stl': mesh.bytes }, { onOutput: failing }), refused);
  await assert.rejects(readMesh(mesh.bytes, 'rook.stl', { onProgress: failing }), refused);
  assert.ok((await slice(mesh, { layerHeight: 10 })).layers.length > 0);
});

test('a file that becomes too large for an array is a limit and is named', async () => {
  const { growFile, mostInFile } = await import(pathToFileURL(join(packageFolder, 'program.js')).href);
  const node = { name: 'layers.npz', contents: Uint8Array.of(1, 2, 3), usedBytes: 3 };
  const refused = [];
  const grow = (bytes) => growFile(node, bytes, (number) => new Error(String(number)), (name) => refused.push(name));
  grow(4);
  assert.deepEqual([...node.contents.subarray(0, 3)], [1, 2, 3]);
  assert.ok(node.contents.length >= 4);
  assert.throws(() => grow(mostInFile + 1), /^Error: 22$/);
  assert.deepEqual(refused, ['layers.npz']);
  assert.deepEqual([...node.contents.subarray(0, 3)], [1, 2, 3]);
});

/** The formats that the program lists. */
function formats() {
  const help = native('help', 'slice').replace(/\s+/g, ' ');
  return /its name does not determine it: ([^;]*?) --/.exec(help)[1].split(', ');
}

for (const format of formats())
  test(`slicing into ${format} gives the bytes of the program`, async () => {
    const mesh = await makeBody('rook');
    writeFileSync(join(folder, 'rook.stl'), mesh.bytes);
    const vectors = ['ilt', 'ovf', '3mf-toolpath'].includes(format);
    const printers = {
      goo: 'Mars 4 Max',
      ctb: 'Elegoo Mars',
      cbddlp: 'Anycubic Photon',
      anycubic: 'Photon Mono X 6K',
      'chitubox-zip': 'Kelant S400',
      nanodlp: 'Athena 8K',
    };
    const options = {
      layerHeight: 4,
      ...(vectors ? { scan: true, hatchDistance: 0.5 } : {}),
      ...(format.startsWith('png') ? { pixelSize: 0.4 } : {}),
      ...(format in printers ? { printer: printers[format] } : {}),
    };
    const given = words(options).filter((word) => word !== 'true');
    native('slice', 'rook.stl', '-o', 'layers', '--format', format, ...given);
    const { bytes } = await sliceToFile(mesh, format, options);
    if (!(bytes instanceof Uint8Array)) { // a folder
      const names = readdirSync(join(folder, 'layers'));
      assert.deepEqual(Object.keys(bytes).sort(), names.map((name) => `layers/${name}`).sort());
      for (const name of names) assert.ok(same(bytes[`layers/${name}`], bytesOf(join('layers', name))), name);
    } else {
      assert.ok(same(bytes, bytesOf('layers')), format);
    }
    rmSync(join(folder, 'layers'), { recursive: true });
  });

test('layers are written, read and changed like those of the program', async () => {
  const stack = await slice(await makeBody('rook'), { layerHeight: 2 });
  const cli = await writeLayers(stack, 'cli');
  const again = await readLayers(cli, 'rook.cli');
  assert.ok(again instanceof Stack);
  assert.equal(again.layers.length, stack.layers.length);
  const npz = await readLayers(stack.bytes, 'rook.npz');
  stack.layers.forEach((layer, i) => assert.deepEqual(npz.layers[i].points, layer.points));
  assert.ok((await readFile(cli, 'rook.cli')) instanceof Stack);
  await assert.rejects(readMesh(cli, 'rook.cli'), { name: 'LamellaError', kind: 'input', message: /readLayers/ });
});

test('points are views of the memory of the stack', async () => {
  const stack = await slice(await makeBody('torus'), { layerHeight: 2 });
  for (const layer of stack.layers) {
    assert.equal(layer.points.buffer, stack.bytes.buffer);
    assert.equal(layer.points.length, 2 * layer.offsets.at(-1));
    assert.equal(layer.contours, layer.offsets.length - 1);
    for (let i = 0; i < layer.contours; ++i) assert.equal(layer.contour(i).buffer, stack.bytes.buffer);
  }
});

test('several meshes on a plate stay apart, each with its placement', async () => {
  const box = await makeBody('box', { size: 10 });
  const stack = await slice([box, { mesh: box, translate: [30, 0, 0], label: 'second', copies: 2 }], { layerHeight: 5 });
  assert.equal(stack.labels.length, 3);
  assert.deepEqual([...stack.layers[0].parts], [0, 1, 2]);
  assert.equal(stack.layers[0].areaMm2, 300);
});

test('scan vectors come with their hatches, and are written with their parameters', async () => {
  const box = await makeBody('box', { size: 10 });
  const strategy = (await run(['strategy', 'show'])).text;
  const stack = await slice(box, { layerHeight: 5, scan: true, strategy });
  assert.ok(stack.layers[0].hatches.length > 100);
  assert.equal(stack.layers[0].hatches.length, 4 * stack.layers[0].hatchParts.length);
  writeFileSync(join(folder, 'box.stl'), box.bytes);
  native('slice', 'box.stl', '-o', 'box.ilt', '--layer-height', '5', '--scan');
  assert.ok(same(await writeLayers(stack, 'ilt'), bytesOf('box.ilt')));
});

test('heights of every kind reach the program', async () => {
  const box = await makeBody('box', { size: 10 });
  const z = async (options) => (await slice(box, options)).layers.map((layer) => layer.z);
  assert.deepEqual(await z({ zList: [1, 2.5] }), [1, 2.5]);
  assert.equal((await z({ heights: [[0, 5, 1]], layerHeight: 2.5 })).length, 7);
  assert.deepEqual(await z({ layerHeight: 1, layers: [2, 4] }), [2.5, 3.5]);
  assert.deepEqual(await z({ layerHeight: 1, zRange: [null, 2] }), [0.5, 1.5]);
  assert.equal((await z({ adaptive: [1, 5], cusp: 5 })).length, 2);
});

test('the first layers shrink as in the program', async () => {
  const mesh = await makeBody('rook');
  writeFileSync(join(folder, 'rook.stl'), mesh.bytes);
  native('slice', 'rook.stl', '-o', 'shrunk.cli', '--layer-height', '0.5', '--bottom-offset', '0.3:2');
  const { bytes } = await sliceToFile(mesh, 'cli', { layerHeight: 0.5, bottomOffset: [0.3, 2] });
  assert.ok(same(bytes, bytesOf('shrunk.cli')));
});

test('a diagnosis and a page are those of the program', async () => {
  const mesh = await makeBody('rook');
  writeFileSync(join(folder, 'rook.stl'), mesh.bytes);
  const { warnings, ...facts } = await diagnose(mesh);
  assert.deepEqual(facts, JSON.parse(native('info', 'rook.stl', '--json')));
  assert.deepEqual(warnings, []);
  assert.match(Buffer.from(await view(mesh, { layerHeight: 5 })).toString(), /<title>Lamella<\/title>/);
});

test('errors have the texts of the program, and kinds', async () => {
  for (const [name, content, options] of [
    ['empty.stl', '', {}],
    ['text.stl', 'solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0\n', {}],
    ['picture.png', '\x89PNG\r\n\x1a\n', {}],
  ]) {
    writeFileSync(join(folder, name), content, 'latin1');
    const { stderr } = spawnSync(program, ['info', name], { cwd: folder, encoding: 'utf8' });
    await assert.rejects(readMesh(bytesOf(name), name, options), (error) => {
      assert.ok(error instanceof LamellaError);
      assert.equal(`lamella: error: ${error.message}\n`, stderr);
      assert.equal(error.kind, 'input');
      return true;
    });
  }
  const box = await makeBody('box');
  await assert.rejects(slice(box, { layerHeight: -1 }), { kind: 'usage', exitCode: 2, message: /--layer-height/ });
  await assert.rejects(slice(box, { layerHight: 1 }), { kind: 'usage', message: /--layer-height/ });
  await assert.rejects(sliceToFile(box, 'png', { maxOutput: 10, layerHeight: 1 }), { kind: 'limit' });
  await assert.rejects(readMesh({}, 'x.stl'), TypeError);
  const strategy = { scan: true, hatchDistance: 0.001, maxMemory: '1M' };
  await assert.rejects(slice(await makeBody('rook'), strategy), { kind: 'limit', message: /memory.*WebAssembly can use 4 GB at most/ });
});

test('a call reports progress and ends when its signal is aborted', async () => {
  const mesh = await makeBody('lattice', { cells: 8 });
  const stages = [];
  await slice(mesh, { layerHeight: 1, onProgress: ({ stage }) => stages.push(stage) });
  assert.ok(stages.includes('read') && stages.includes('slice'));
  const abort = new AbortController();
  const call = slice(mesh, { layerHeight: 0.001, signal: abort.signal, onProgress: () => abort.abort(new Error('enough')) });
  await assert.rejects(call, { message: 'enough' });
  await assert.rejects(slice(mesh, { signal: AbortSignal.abort() }), { name: 'AbortError' });
  assert.ok((await slice(mesh, { layerHeight: 10 })).layers.length > 0);
});

test('any number of threads gives the same bytes', async () => {
  const mesh = await makeBody('lattice', { cells: 5 });
  for (const options of [{ layerHeight: 0.2 }, { layerHeight: 1, scan: true, hatchDistance: 0.5 }]) {
    const [first, ...others] = await Promise.all([undefined, 1, 2, 5].map((threads) => sliceToFile(mesh, 'cli', { ...options, threads })));
    for (const { bytes } of others) assert.ok(same(bytes, first.bytes));
    assert.deepEqual(others.map(({ statistics }) => statistics.threads), [1, 2, 5]);
  }
});

test('without shared memory there is one thread, and the same layers', async () => {
  const body = `
    import { makeBody, run, sliceToFile } from ${JSON.stringify(pathToFileURL(join(packageFolder, 'node.js')).href)};
    import { writeFileSync } from 'node:fs';
    const { bytes, statistics } = await sliceToFile(await makeBody('rook'), 'cli', { layerHeight: 1, threads: 4 });
    writeFileSync('alone.cli', bytes);
    if (typeof SharedArrayBuffer !== 'undefined' || statistics.threads !== 1) throw new Error(String(statistics.threads));
    await run(['slice', 'missing.stl', '-o', 'x.cli']).catch((error) => console.log(error.message));
    await run(['make', 'box', '-o', 'box.stl']).then(({ files }) => run(['slice', 'box.stl', '-o', 'x.cli', '--timeout', '9'], files)).catch((error) => console.log(error.message));`;
  writeFileSync(join(folder, 'alone.mjs'), body);
  const { stdout, stderr } = spawnSync(process.execPath, ['--enable-sharedarraybuffer-per-context', 'alone.mjs'], { cwd: folder, encoding: 'utf8' });
  assert.equal(stderr, '');
  const [missing, timeout] = stdout.split('\n');
  assert.match(missing, /^missing.stl/);
  assert.match(timeout, /thread/);
  const mesh = await makeBody('rook');
  assert.ok(same(bytesOf('alone.cli'), (await sliceToFile(mesh, 'cli', { layerHeight: 1 })).bytes));
});

test('a time limit ends a run, and the next one works', async () => {
  const mesh = await makeBody('lattice', { cells: 8 });
  const words = ['slice', 'lattice.stl', '-o', 'x.cli', '--layer-height', '0.001', '--timeout', '0.2'];
  await assert.rejects(run(words, { 'lattice.stl': mesh.bytes }), { kind: 'limit', message: /stopped after 0.2 s \(--timeout\)/ });
  assert.ok((await slice(mesh, { layerHeight: 10 })).layers.length > 0);
});

test('layers come one by one, those of the whole stack', async () => {
  const open = (await readMesh((await makeBody('box', { ascii: true })).bytes, 'box.stl')).bytes;
  const withoutLid = new TextDecoder().decode(open).replace(/ *facet[\s\S]*?endfacet\n/, '');
  const meshes = [
    [await makeBody('rook'), { layerHeight: 2 }],
    [await readMesh(withoutLid, 'open.stl'), { layerHeight: 3 }],
    [[await makeBody('box', { size: 5 }), { mesh: await makeBody('torus'), label: 'ring' }], { layerHeight: 1, scan: true, hatchDistance: 1 }],
  ];
  for (const [mesh, options] of meshes) {
    const stack = await slice(mesh, options);
    const stream = sliceLayers(mesh, options);
    let i = 0;
    for await (const layer of stream) {
      const expected = stack.layers[i++];
      for (const name of ['index', 'z', 'bottom', 'top', 'points', 'offsets', 'closed', 'parts', 'hatches', 'hatchParts'])
        assert.deepEqual(layer[name], expected[name], `${name} of layer ${i}`);
    }
    assert.equal(i, stack.layers.length);
    assert.deepEqual(stream.labels, stack.labels);
    assert.deepEqual(stream.warnings, stack.warnings.map((text) => text.replace('layers.npz: ', 'layers: ')));
  }
});

test('slicing waits for the loop over coming layers', async () => {
  const mesh = await makeBody('lattice', { cells: 4 });
  let last = { done: 0, total: Infinity };
  const stream = sliceLayers(mesh, { layerHeight: 0.0005, onProgress: (progress) => (last = progress.stage === 'slice' ? progress : last) });
  await stream.next();
  // Until nothing is done any more: more layers than fit the memory that they may take would come otherwise.
  for (let before = -1; before !== last.done; ) {
    before = last.done;
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
  assert.ok(last.done < last.total, `${last.done} of ${last.total}`);
  await stream.return();
});

test('coming layers end with the loop, a signal or an error, and come before all are done', async () => {
  const mesh = await makeBody('lattice', { cells: 6 });
  const endless = { layerHeight: 0.0005 };
  for await (const { index } of sliceLayers(mesh, endless)) if (index === 3) break;
  const abort = new AbortController();
  await assert.rejects(async () => {
    for await (const { index } of sliceLayers(mesh, { ...endless, signal: abort.signal })) if (index === 2) abort.abort(new Error('enough'));
  }, /^Error: enough$/);
  await assert.rejects(sliceLayers(mesh, { layerHeight: -1 }).next(), { kind: 'usage' });
  await assert.rejects(sliceLayers(mesh, { signal: AbortSignal.abort() }).next(), { name: 'AbortError' });
  assert.ok((await slice(mesh, { layerHeight: 10 })).layers.length > 0);
});

test('a mesh and a stack give up their memory', async () => {
  const mesh = await makeBody('box');
  const stack = await slice(mesh, { layerHeight: 1 });
  for (const one of [mesh, stack]) {
    one.dispose();
    assert.equal(one.bytes.length, 0);
    if (Symbol.dispose) assert.equal(one[Symbol.dispose], one.dispose);
  }
  assert.deepEqual(stack.layers, []);
});

test('files of a run may lie in folders, also in empty ones', async () => {
  const { bytes } = await makeBody('box');
  const { files } = await run(['slice', 'in/part.stl', '-o', 'out/part.npz'], { 'in/part.stl': bytes, 'out/': '' });
  assert.deepEqual(Object.keys(files), ['out/part.npz']);
});

test('a thousand slices leave no memory behind, with threads or without', async () => {
  const box = await makeBody('sphere', { size: 20, detail: 3 });
  const some = async (count) => {
    for (let i = 0; i < count; ++i) await slice(box, { layerHeight: 1, ...(i % 4 === 0 ? { threads: 2 } : {}) });
    globalThis.gc?.();
    return process.memoryUsage().rss;
  };
  const before = await some(200);
  const after = await some(1000);
  assert.ok(after - before < 64e6, `${((after - before) / 1e6).toFixed(1)} MB more`);
});

/** Numbers that look random, the same in every run. */
function* random(seed) {
  for (let state = seed; ; ) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state / 2 ** 32;
  }
}

test('changed files give an error or a result, never a trap', async () => {
  const rook = await makeBody('cylinder', { size: 10, segments: 8 });
  const stack = await slice(rook, { layerHeight: 2 });
  const seeds = [['part.stl', rook.bytes]];
  for (const name of ['part.obj', 'part.ply']) seeds.push([name, (await makeBody('cylinder', { segments: 8, format: name.slice(-3) })).bytes]);
  seeds.push(['ascii.stl', (await makeBody('cylinder', { segments: 8, ascii: true })).bytes]);
  for (const format of ['cli', 'cli-ascii', 'svg', 'slc', '3mf', 'json', 'npz']) seeds.push([`layers.${format}`, await writeLayers(stack, format)]);
  const numbers = random(7);
  const next = (n) => Math.floor(numbers.next().value * n);
  const rounds = Number(process.env.LAMELLA_MUTATIONS ?? 2000) / seeds.length;
  let results = 0;
  const calls = [];
  for (let i = 0; i < rounds; ++i)
    for (const [name, original] of seeds) {
      const bytes = original.slice(0, next(4) === 0 ? next(original.length) : original.length);
      for (let k = next(8); k >= 0 && bytes.length > 0; --k) bytes[next(bytes.length)] = next(256);
      calls.push(
        readFile(bytes, name).then(
          () => ++results,
          (error) => {
            assert.ok(error instanceof LamellaError, error.stack);
            assert.ok(['input', 'limit', 'defect', 'usage'].includes(error.kind), error.message);
            assert.doesNotMatch(error.message, /stopped by WebAssembly/);
          },
        ),
      );
      if (calls.length >= 50) await Promise.all(calls.splice(0));
    }
  await Promise.all(calls);
  assert.ok(results > 0);
});

test('the program of the package works on the files of this computer', () => {
  native('make', 'rook', '-o', 'rook.stl');
  native('slice', 'rook.stl', '-o', 'native.cli', '--layer-height', '1');
  const cli = (...words) => spawnSync(process.execPath, [join(packageFolder, 'cli.js'), ...words], { cwd: folder, maxBuffer: 1 << 28 });
  const sliced = cli('slice', 'rook.stl', '-o', 'web.cli', '--layer-height', '1');
  assert.equal(sliced.status, 0, String(sliced.stderr));
  assert.ok(same(bytesOf('web.cli'), bytesOf('native.cli')));
  assert.ok(same(cli('slice', join(folder, 'rook.stl'), '-o', '-', '--format', 'cli', '--layer-height', '1').stdout, bytesOf('native.cli')));
  const piped = spawnSync(process.execPath, [join(packageFolder, 'cli.js'), 'slice', '-', '-o', 'piped.cli', '--layer-height', '1'], { cwd: folder, input: bytesOf('rook.stl') });
  assert.equal(piped.status, 0, String(piped.stderr));
  assert.equal(bytesOf('piped.cli').length, bytesOf('native.cli').length);
  const refused = cli('slice', 'missing.stl', '-o', 'x.cli');
  const expected = spawnSync(program, ['slice', 'missing.stl', '-o', 'x.cli'], { cwd: folder });
  assert.equal(refused.status, expected.status);
  assert.equal(String(refused.stderr), String(expected.stderr));
  assert.ok(!readdirSync(folder).includes('x.cli'));
});

test('Ctrl-C ends the program of the package and leaves nothing behind', async () => {
  const place = mkdtempSync(join(folder, 'cancelled-'));
  native('make', 'lattice', '--cells', '12', '-o', 'large.stl');
  const running = spawn(process.execPath, [join(packageFolder, 'cli.js'), 'slice', join(folder, 'large.stl'), '-o', 'x.cli', '--layer-height', '0.01'], {
    cwd: place,
    stdio: ['ignore', 'ignore', 'pipe'],
  });
  const ended = new Promise((resolve) => running.on('exit', (code) => resolve(code)));
  let text = '';
  running.stderr.on('data', (data) => (text += data));
  while (readdirSync(place).length === 0) await new Promise((resolve) => setTimeout(resolve, 10));
  running.kill('SIGINT');
  assert.equal(await ended, 130);
  assert.equal(text, 'lamella: error: cancelled\n');
  assert.deepEqual(readdirSync(place), []);
});

test('the samples of the documentation run', async () => {
  const page = readFileSync(process.env.LAMELLA_PAGE, 'utf8');
  const samples = [...page.matchAll(/^```js\n(import [^`]*from 'lamella';\n[^`]*)^```$/gm)].map(([, text]) => text).filter((text) => !text.includes('document.'));
  assert.ok(samples.length > 1);
  native('make', 'rook', '-o', 'part.stl');
  native('slice', 'part.stl', '-o', 'native.cli');
  for (const sample of samples) {
    writeFileSync(join(folder, 'sample.mjs'), sample.replaceAll("'lamella'", JSON.stringify(pathToFileURL(join(packageFolder, 'node.js')).href)));
    const { status, stderr } = spawnSync(process.execPath, ['sample.mjs'], { cwd: folder, encoding: 'utf8' });
    assert.equal(status, 0, stderr);
    native('compare', 'part.cli', 'native.cli');
  }
});

test('a print is checked as the program checks it, from a mesh and from its layers', async () => {
  native('make', 'sphere', '--size', '10', '-o', 'ball.stl');
  const { path, ...expected } = JSON.parse(native('check', 'ball.stl', '--layer-height', '0.2', '--json'));
  const mesh = await readMesh(readFileSync(join(folder, 'ball.stl')), 'ball.stl');
  const { path: name, warnings, ...found } = await checkPrint(mesh, { layerHeight: 0.2 });
  assert.deepEqual(found, expected);
  assert.equal(path, name);
  assert.deepEqual(warnings, []);
  assert.equal((await checkPrint(await slice(mesh, { layerHeight: 0.2 }), { overhangAngle: 80 })).ok, true);
});

test('pixels are those of the images, where the layers are', async () => {
  const mesh = await meshOf(
    [[1, 2, 0], [4, 2, 0], [4, 3, 0], [1, 3, 0], [1, 2, 2], [4, 2, 2], [4, 3, 2], [1, 3, 2]].flat(),
    [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]].flat(),
  );
  const box = await pixels(await slice(mesh, { layerHeight: 1 }), { pixelSize: [0.5, 0.4] });
  assert.deepEqual(box.shape, [2, 3, 6]);
  assert.deepEqual([...box.z], [0.5, 1.5]);
  assert.deepEqual(box.spacing, [0.5, 0.4]);
  const near = (value, expected) => assert.ok(Math.abs(value - expected) < 1e-9, `${value}`);
  near(box.origin[0], 1.25);
  near(box.origin[1], 2.1); // the images are 1.2 mm high around the middle of the box
  assert.deepEqual([...box.data], [...Array(6).fill(191), ...Array(6).fill(255), ...Array(6).fill(191), ...Array(6).fill(191), ...Array(6).fill(255), ...Array(6).fill(191)]);
  const stack = await slice(await makeBody('rook'), { layerHeight: 2 });
  for (const antialias of [1, 8]) {
    const { data, shape, spacing } = await pixels(stack, { pixelSize: 0.1, antialias });
    const size = shape[1] * shape[2];
    stack.layers.forEach(({ areaMm2 }, i) => {
      const covered = data.subarray(i * size, (i + 1) * size).reduce((sum, value) => sum + value / 255, 0) * spacing[0] * spacing[1];
      assert.ok(Math.abs(covered - areaMm2) < (antialias === 1 ? 0.02 : 0.001) * areaMm2, `${covered} instead of ${areaMm2}`);
    });
  }
  await assert.rejects(pixels(stack, { mirror: 'x' }), /mirror is for images/);
});

test('only what is documented is exported', () => {
  assert.deepEqual(Object.keys(lamella).sort(), [
    'LamellaError', 'Layer', 'Mesh', 'Stack', 'checkPrint', 'diagnose', 'makeBody', 'meshOf', 'pixels', 'readFile', 'readLayers', 'readMesh', 'releaseWorkers', 'run', 'slice',
    'sliceLayers', 'sliceToFile', 'usePlatform', 'view', 'writeLayers',
  ]);
  assert.ok(Mesh);
});

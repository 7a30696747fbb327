// Puts the package for npm together: node build_package.mjs LAMELLA.JS LAMELLA.WASM VERSION TREE OUTPUT

import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [glue, wasm, version, tree, output] = process.argv.slice(2);
const sources = join(tree, 'web/package');

rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });
for (const name of readdirSync(sources)) {
  const text = readFileSync(join(sources, name), 'utf8');
  writeFileSync(join(output, name.replace(/\.in$/, '')), name.endsWith('.in') ? text.replaceAll('@version@', version) : text);
}
// What emscripten makes is a script that in Node.js asks for CommonJS. As a module it is told what that has.
writeFileSync(
  join(output, 'lamella.js'),
  `// Made by Emscripten.\nexport default function createLamellaIn(require, __dirname, __filename) {\n${readFileSync(glue, 'utf8')}\nreturn createLamella;\n}\n`,
);
copyFileSync(wasm, join(output, 'lamella.wasm'));
for (const name of ['LICENSE', 'LICENSES-third-party.txt']) copyFileSync(join(tree, name), join(output, name));

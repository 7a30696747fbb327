#!/bin/sh
# Tests the npm package and the playground that `make web` has built. usage: tests/web/run.sh BUILD
# BUILD has the program, web/package and web/playground.html.
set -eu

build=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
work=$build/web/tests
mkdir -p "$work"
cp "$here"/*.mjs "$here"/*.ts "$here"/package.json "$here"/package-lock.json "$here"/../viewer/drawing.mjs "$work"
cd "$work"
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null

# As a user gets it: packed, and installed into a folder of its own.
rm -rf user
mkdir user
(cd user && npm pack --silent "$build/web/package" >/dev/null && echo '{"private": true, "type": "module"}' >package.json &&
    npm install --offline --no-audit --no-fund --loglevel=error ./lamella-*.tgz >/dev/null)

export LAMELLA_PROGRAM="$build/lamella" LAMELLA_PACKAGE="$work/user/node_modules/lamella" \
    LAMELLA_PLAYGROUND="$build/web/playground.html" LAMELLA_PAGE="$here/../../docs/javascript.md" \
    LAMELLA_LAYER_HASHES="$here/../fixtures/layer_hashes.tsv" LAMELLA_SHARED="${LAMELLA_SHARED:-$here/../../../shared}" \
    LAMELLA_TREE="$here/../.."
cp types_test.ts user/
(cd user && "$work/node_modules/.bin/tsc" --noEmit --strict --module nodenext --target es2022 --lib es2022,dom \
    --typeRoots "$work/node_modules/@types" --types node types_test.ts)
shift
for test; do node --expose-gc --test "$test"; done

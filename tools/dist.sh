#!/bin/bash
# Makes the files of a release in FOLDER: a source archive, which contains the finished page of the viewer, so that its
# build needs no Node.js or npm; a Debian package of the program in BUILD; and a wheel, built from that archive. The
# sources are the files that git tracks, with local changes; the same sources give the same archive.
# usage: tools/dist.sh BUILD FOLDER
set -euo pipefail
build=$(realpath "$1")
mkdir -p "$2"
dist=$(realpath "$2")
cd "$(dirname "$0")/.."
umask 022

fail() {
    echo "dist: $1" >&2
    exit 1
}

page=$build/viewer/viewer_page.cpp
grep --quiet 'constexpr char page' "$page" 2>/dev/null || fail "the build in $build has no viewer; its log says why"
tree=$(git -c safe.directory="$PWD" stash create 2>/dev/null) || fail "this is no checkout by git"
tree=${tree:-HEAD}
SOURCE_DATE_EPOCH=$(git -c safe.directory="$PWD" log -1 --format=%ct)
export SOURCE_DATE_EPOCH
name=lamella-$(sed -n 's/^#define LAMELLA_VERSION "\(.*\)"/\1/p' include/lamella/core/version.hpp)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git -c safe.directory="$PWD" archive --prefix="$name/" "$tree" | tar --extract --directory "$work"
cp "$page" "$work/$name/viewer/"
cp "$build/viewer/packages/dist/index.html" "$work/$name/viewer/viewer.html"
# The modes are set, since tar keeps those of the files as root and applies the umask otherwise.
tar --create --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=a+rX,u+w,go-w \
    --directory "$work" "$name" |
    gzip --no-name >"$dist/$name.tar.gz"

cpack --config "$build/CPackConfig.cmake" -B "$work/debian" >"$work/log" || {
    cat "$work/log" >&2
    fail "cpack made no Debian package"
}
mv "$work"/debian/*.deb "$dist/"

# Debian's packages work only with Debian's interpreter, which need not be the first in the path. A compiler cache may
# have the objects of these sources from another folder.
export CMAKE_ARGS="${CMAKE_ARGS:-} -D CMAKE_UNITY_BUILD=ON -D CMAKE_MODULE_LINKER_FLAGS=-s"
CCACHE_BASEDIR=$work/$name /usr/bin/python3 -m pip --quiet wheel "$work/$name" --no-build-isolation --no-deps --no-index --wheel-dir "$dist"

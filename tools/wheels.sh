#!/bin/bash
# Makes wheels of the Python package in FOLDER for every Linux with glibc 2.28 or later, on x86-64 and ARM64, for the
# version of the interpreter PYTHON, by default Debian's. Zig compiles them (tools/install_zig.sh); all libraries but that
# of C are linked statically. The sources are the files that git tracks, with local changes, and the viewer of build/.
# usage: tools/wheels.sh FOLDER [PROCESSOR]..., PROCESSOR is x86_64 or arm64
set -euo pipefail
mkdir -p "$1"
wheels=$(realpath "$1")
shift
[ $# -gt 0 ] || set -- x86_64 arm64
cd "$(dirname "$0")/.."
root=$PWD
umask 022

python=${PYTHON:-/usr/bin/python3}
ask() { "$python" -c "import sys, sysconfig; print($1)"; }
tree=$(git -c safe.directory="$PWD" stash create 2>/dev/null) || {
    echo "wheels: this is no checkout by git" >&2
    exit 1
}
SOURCE_DATE_EPOCH=$(git -c safe.directory="$PWD" log -1 --format=%ct)
export SOURCE_DATE_EPOCH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Headers of this system's C library must not be found, so those of Python and pybind11 are copied. Python's differ between
# processors only where the interpreter itself is compiled.
headers=$work/python
mkdir "$headers"
cp -r "$(ask 'sysconfig.get_path("include")')/." "$headers"
settings=/usr/include/$(ask 'sysconfig.get_config_var("MULTIARCH")')/$(basename "$(ask 'sysconfig.get_path("include")')")/pyconfig.h
if [ -f "$settings" ]; then cp "$settings" "$headers"; fi # Debian's other one only includes this
if ! pybind11=$("$python" -m pybind11 --cmakedir 2>/dev/null); then
    pybind11=$work/pybind11/lib/cmake/pybind11
    mkdir -p "$work/pybind11/include" "$work/pybind11/lib/cmake"
    cp -r /usr/include/pybind11 "$work/pybind11/include"
    cp -r /usr/lib/cmake/pybind11 "$work/pybind11/lib/cmake"
fi

# pybind11 would ask the interpreter for the extension of modules, and measure optimisation that modules here do not use.
executable=$(ask sys.executable)
for processor; do
    case $processor in
    x86_64) name=x86_64 ;;
    arm64) name=aarch64 ;;
    *) echo "wheels: there is no processor '$processor'; x86_64 and arm64 are known" >&2 && exit 2 ;;
    esac
    tools/build_libraries.sh "manylinux-$processor"
    source=$work/$processor
    mkdir "$source"
    git -c safe.directory="$PWD" archive "${tree:-HEAD}" | tar --extract --directory "$source"
    cp build/viewer/viewer_page.cpp "$source/viewer/" # without it, each build would fetch what the viewer is made from
    suffix=.$(ask 'sys.implementation.cache_tag')-$name-linux-gnu.so
    printf '[bdist_wheel]\nplat_name = manylinux_2_28_%s\n' "$name" >"$work/setup.cfg"
    CCACHE_BASEDIR=$source DIST_EXTRA_CONFIG=$work/setup.cfg SETUPTOOLS_EXT_SUFFIX=$suffix \
        CMAKE_ARGS="-D CMAKE_TOOLCHAIN_FILE=$root/cmake/toolchains/manylinux-$processor.cmake -D CMAKE_UNITY_BUILD=ON
                    -D pybind11_DIR=$pybind11 -D HAS_FLTO=OFF -D HAS_FLTO_THIN=OFF
                    -D PYTHON_MODULE_EXTENSION=$suffix -D PYBIND11_PYTHON_EXECUTABLE_LAST=$executable
                    -D Python3_INCLUDE_DIR=$headers -D Python3_NumPy_INCLUDE_DIR=$headers" \
        "$python" -m pip --quiet wheel "$source" --no-build-isolation --no-deps --no-index --wheel-dir "$wheels"
done
ls -l "$wheels"

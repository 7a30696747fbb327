#!/bin/sh
# Builds the libraries that Lamella needs as static libraries for another system, from Debian's source packages.
#
# usage: tools/build_libraries.sh TARGET [CMAKE OPTION]...
#
# TARGET is the name of a toolchain file, cmake/toolchains/TARGET.cmake: mingw for Windows, wasm for WebAssembly, and so
# on. The libraries, headers, CMake packages and licences go to build/libraries/TARGET, where the toolchain file finds
# them. Nothing is done if they are there and neither the options nor this script have changed. CFLAGS and CXXFLAGS are
# used, as by CMake.
#
# apt fetches the sources with a configuration of its own, from the mirrors of this system, and checks them: the index is
# signed with Debian's key, and contains the hashes of the archives. No setting of the system is changed.
set -eu

[ $# -ge 1 ] || { sed -n 's/^# usage: /usage: /p' "$0" >&2; exit 2; }
target=$1
shift

root=$(cd "$(dirname "$0")/.." && pwd)
toolchain=$root/cmake/toolchains/$target.cmake
folder=$root/build/libraries
prefix=$folder/$target
sources=$folder/sources
apt=$folder/apt

[ -f "$toolchain" ] || { echo "build_libraries: there is no $toolchain" >&2; exit 2; }

say() { echo "build_libraries: $*"; }

# One directory for each source package: the package, and the directory in which it is unpacked.
packages="expat zlib libdeflate fmtlib libpng1.6"

# Fetches and unpacks the sources, once for all targets.
fetch() {
    if [ -f "$sources/complete" ] && [ "$(cat "$sources/complete")" = "$packages" ]; then
        return
    fi
    command -v dpkg-source >/dev/null || { echo "build_libraries: please install dpkg-dev" >&2; exit 1; }
    rm -rf "$sources" "$apt"
    mkdir -p "$sources" "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/parts"
    keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    signed=
    if [ -f "$keyring" ]; then signed="[signed-by=$keyring] "; fi
    # shellcheck disable=SC2016 # apt replaces these variables
    apt-get indextargets --format '$(SITE) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' | sort -u |
        sed "s|^|deb-src $signed|" >"$apt/sources.list"
    [ -s "$apt/sources.list" ] || { echo "build_libraries: apt knows no mirror of Debian" >&2; exit 1; }
    options="-o Dir::Etc::sourcelist=$apt/sources.list -o Dir::Etc::sourceparts=$apt/parts -o Dir::State=$apt/state
             -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache=$apt/cache -o APT::Sandbox::User=$(id -un)"
    say "fetching the sources of $packages"
    # Word splitting is intended: these are lists of arguments.
    # shellcheck disable=SC2086
    apt-get $options --quiet=2 update
    release=$(sed 's/.* \([^ ]*\) [^ ]*$/\1/' "$apt/sources.list" | grep --invert-match -e - | head -n 1)
    for package in $packages; do
        # A mirror may lack the newest update. The release itself is then good enough.
        # shellcheck disable=SC2086
        (cd "$sources" && { apt-get $options --quiet=2 source --download-only "$package" ||
            { say "the update of $package cannot be fetched; using the one of the release"
              apt-get $options --quiet=2 source --download-only "$package/$release"; }; })
    done
    for description in "$sources"/*.dsc; do
        package=$(sed -n 's/^Source: //p' "$description")
        # The signatures of the packages' makers are not needed, since apt has checked the hashes.
        dpkg-source --no-check --extract "$description" "$sources/$package" >/dev/null
        say "unpacked $package $(sed -n 's/^Version: //p' "$description")"
    done
    rm -rf "$apt"
    echo "$packages" >"$sources/complete"
}

build() {
    # The settings of this build; equal settings give equal libraries.
    settings=$(cat "$0" "$root/tools/libraries/CMakeLists.txt" "$toolchain"; echo "$* ${CFLAGS:-} ${CXXFLAGS:-}")
    if [ -f "$prefix/settings" ] && [ "$(cat "$prefix/settings")" = "$settings" ]; then
        say "$prefix is up to date"
        return
    fi
    rm -rf "$prefix" "$folder/$target-build"
    say "building for $target"
    cmake -S "$root/tools/libraries" -B "$folder/$target-build" -G Ninja -D CMAKE_BUILD_TYPE=Release \
        -D "CMAKE_TOOLCHAIN_FILE=$toolchain" -D "CMAKE_INSTALL_PREFIX=$prefix" -D "LAMELLA_SOURCES=$sources" "$@" >/dev/null
    cmake --build "$folder/$target-build" >/dev/null
    cmake --install "$folder/$target-build" >/dev/null
    rm -rf "$folder/$target-build"
    printf '%s\n' "$settings" >"$prefix/settings"
    say "installed to $prefix:"
    (cd "$prefix" && du -k lib/*.a | sort -k 2 | sed 's/^/  /')
}

mkdir -p "$folder"
fetch
build "$@"

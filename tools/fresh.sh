#!/bin/bash
# `make demo` and `make test` on a Debian 12 that is up to date and has git and make, and nothing else. Such a machine is
# made in a folder, from the mirror that apt uses here, and removed at the end; the files are those that git tracks, as
# they are now. Of this machine it knows only how to reach mirror and npm's registry. What has been done here with the very
# same bytes is not done again: what a compiler cache has is not compiled, and test programs of modules that passed are built
# and compared instead of run. Where no machine can be made, this says why and ends well.
# usage: tools/fresh.sh
# shellcheck disable=SC2317 # functions are called by the shell that unshare starts
set -euo pipefail
cd "$(dirname "$0")/.."
umask 022

readonly no_machine=77 # the status of what cannot make one
readonly aside=/var/cache/compiled

skip() {
    echo "fresh: skipped, since $1"
    exit 0
}

make_machine() {
    # Users other than root, too, must get into it.
    mkdir "$root" && chmod 0755 "$root" || return
    # What need not have reached the disk is installed sooner.
    mkdir -p "$root/etc/dpkg/dpkg.cfg.d" && echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/no-hurry"
    debootstrap --variant=minbase --include=git,make bookworm "$root" "$mirror" >"$folder/log" 2>&1 || return
    mount -t proc proc "$root/proc" && mount --rbind /dev "$root/dev" && mount --rbind /sys "$root/sys" || return

    printf '%s\n' "$sources" >"$root/etc/apt/sources.list"
    apt-config dump | grep -E '^Acquire::(https?|Check-)' >"$root/etc/apt/apt.conf.d/90here"
    cp --dereference /etc/resolv.conf /etc/hosts "$root/etc/"
    if [ -e "$certificates" ]; then
        mkdir -p "$root/etc/ssl/certs"
        cp "$certificates" "$root$certificates"
        cp -R /usr/local/share/ca-certificates "$root/usr/local/share/"
    fi
    { on_it / apt-get update --quiet=2 && on_it / apt-get upgrade --quiet=2 --yes; } >>"$folder/log" 2>&1
}

# What the same compiler made here of the same source and headers, as these are found there, need not be made again. The
# cache lies where nothing finds it that is not told of it: there is still nothing but git and make.
bring_compiled() {
    local program library
    program=$(command -v ccache) || return 0
    mkdir -p "$root$aside/objects" && cp --dereference "$program" "$root$aside/"
    for library in $(ldd "$program" | sed -n 's/.* => \(\/[^ ]*\).*/\1/p'); do
        [ -e "$root$library" ] || cp --dereference "$library" "$root$aside/"
    done
    on_it / env LD_LIBRARY_PATH="$aside" "$aside/ccache" --version >/dev/null 2>&1 || return 0
    mount --bind "$(ccache --get-config cache_dir)" "$root$aside/objects" 2>/dev/null || return 0
    cache=(CMAKE_CXX_COMPILER_LAUNCHER="env;LD_LIBRARY_PATH=$aside;$aside/ccache" CCACHE_DIR="$aside/objects"
        CCACHE_BASEDIR="$PWD" CCACHE_SLOPPINESS=locale)
    echo "fresh: what was compiled here is not compiled there again" >>"$folder/summary"
}

# Runs a command in a folder of that machine. Nothing comes along from here but the way to the network, and `cache`.
on_it() {
    local name way=("${cache[@]}")
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
        [ -z "${!name:-}" ] || way+=("$name=${!name}")
    done
    chroot "$root" env --ignore-environment --chdir="$1" "${way[@]}" NODE_EXTRA_CA_CERTS="$certificates" \
        npm_config_registry="$registry" HOME=/root DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${@:2}"
}

make_demo() {
    on_it "$PWD" make demo
}

make_test() {
    local passed others=
    on_it "$PWD" make test CTEST=true || return
    passed=$(passed_here)
    if [ -n "$passed" ]; then
        others="--label-exclude '^($passed)\$\$'"
        echo "fresh: not run again, as the same bytes passed here: ${passed//|/, }" >>"$folder/summary"
    fi
    on_it "$PWD" make test TESTS="$others"
}

# The modules whose tests `make test` has run here, as the program that was built there, too, byte for byte.
passed_here() {
    local program module modules=
    for program in build/tests/*/lamella_*_test; do
        module=${program#build/tests/}
        module=${module%/*}
        # That of the whole way stands for tests of the program, too, which differ by what a machine has.
        if [ "$module" != agreement ] && [ "$program" = "build/tests/$module/lamella_${module}_test" ] &&
            [ build/tests/passed -nt "$program" ] && cmp --quiet "$program" "$root$PWD/$program"; then
            modules=$modules${modules:+|}$module
        fi
    done
    echo "$modules"
}

run() {
    local cache=()
    make_machine || exit "$no_machine"
    bring_compiled
    # In a folder of the same name, since objects contain it; as private as root's own, where users often clone to.
    mkdir -p "$root$PWD" && chmod 0700 "$root$PWD"
    git -c safe.directory="$PWD" archive "$tree" | tar --extract --directory "$root$PWD"

    local target status=0
    exec 3>&2
    for target in demo test; do
        TIMEFORMAT="fresh: make $target took %0R s, and %0U s + %0S s of the processors"
        { time "make_$target" 2>&3; } 2>>"$folder/summary" || {
            echo "fresh: make $target failed" >>"$folder/summary"
            status=1
        }
    done
    # A registry out of reach is no fault of ours; what else leaves the page out is.
    if [ ! -e "$root$PWD/out/rook.html" ]; then
        echo "fresh: make demo left the page out" >>"$folder/summary"
        [ ! -e "$root$PWD/build/viewer/packages/installed" ] || status=1
    fi
    cat "$folder/summary"
    exit "$status"
}

[ "$(id -u)" -eq 0 ] || skip "only root can make a machine in a folder"
unshare --mount-proc --pid --fork true 2>/dev/null || skip "this system does not allow mounts of one's own"
tools/install_packages.sh tools/packages-fresh.txt || skip "debootstrap cannot be installed"
command -v debootstrap >/dev/null || skip "there is no debootstrap"
# shellcheck disable=SC2016 # apt fills these in
sources=$(apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
    grep -E ' bookworm(-updates|-security)? main$' | sort --unique) || skip "apt knows no mirror of Debian 12 here"
mirror=$(sed -n 's/^deb \(.*\) bookworm main$/\1/p' <<<"$sources" | head -n 1)
tree=$(git -c safe.directory="$PWD" stash create 2>/dev/null) || skip "this is no checkout by git"
tree=${tree:-HEAD}
certificates=/etc/ssl/certs/ca-certificates.crt
registry=$(npm config get registry 2>/dev/null || true) # without one, npm knows its own

# The mounts end with the processes that see them, and these with the first of them, the one that unshare starts.
folder=$(mktemp -d "${TMPDIR:-/var/tmp}/lamella-fresh.XXXXXX")
root=$folder/root
trap 'rm -rf --one-file-system "$folder"' EXIT
export folder root mirror sources tree certificates registry no_machine aside
export -f make_machine bring_compiled on_it make_demo make_test passed_here run
unshare --mount-proc --pid --fork --kill-child bash -euo pipefail -c run &
machine=$!
trap 'kill -KILL $(cat "/proc/$machine/task/$machine/children"); wait "$machine" || true; exit 1' HUP INT TERM
status=0
wait "$machine" || status=$?
[ "$status" -ne "$no_machine" ] || skip "no machine could be made: $(tail -n 1 "$folder/log")"
exit "$status"

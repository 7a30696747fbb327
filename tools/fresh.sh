#!/bin/bash
# Runs `make demo` and `make test` on an up-to-date Debian 12 with git, make and nothing else. Such a machine is
# made in a folder, from the mirror that apt uses here, and removed at the end. The sources are the files that git tracks,
# with local changes. From this machine it takes only the settings to reach the mirror and npm's registry. Work done here
# on the same bytes is not repeated: objects in a compiler cache are reused, and test programs of modules that passed are
# built and compared instead of run. If no machine can be made, the script prints the reason and exits with 0.
# usage: tools/fresh.sh
# shellcheck disable=SC2317 # functions are called by the shell that unshare starts
set -euo pipefail
cd "$(dirname "$0")/.."
umask 022

readonly no_machine=77 # exit status if no machine can be made
readonly aside=/var/cache/compiled

skip() {
    echo "fresh: skipped, since $1"
    exit 0
}

make_machine() {
    # Users other than root must be able to enter it.
    mkdir "$root" && chmod 0755 "$root" || return
    # Packages are installed faster without waiting for the disk.
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

# Lets the machine reuse objects that the same compiler made here from the same source and headers. The cache is in a
# folder that only `cache` refers to, so the machine still has only git and make.
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

# Runs a command in a folder of that machine. Only the network settings and `cache` are passed on from here.
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

# Prints the modules whose tests passed here in `make test` and whose test program was built there with the same bytes.
passed_here() {
    local program module modules=
    for program in build/tests/*/lamella_*_test; do
        module=${program#build/tests/}
        module=${module%/*}
        # The module agreement also runs tests of the program, which depend on the machine.
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
    # The folder has the same name, since objects contain it, and the modes of root's home, where users often clone to.
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
    # An unreachable registry is no failure; any other reason for a missing page is.
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
registry=$(npm config get registry 2>/dev/null || true) # without one, npm uses its default

# The mounts disappear with the processes that see them, and those end with the first one, which unshare starts.
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

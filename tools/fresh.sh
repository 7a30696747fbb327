#!/bin/bash
# `make demo` and `make test` on a Debian 12 that is up to date and has git and make, and nothing else. Such a machine is
# made in a folder, from the mirror that apt uses here, and removed at the end; the files are those that git tracks, as
# they are now. Of this machine it knows only how to reach mirror and npm's registry. Where none can be made, this says
# why and ends well.
# usage: tools/fresh.sh
# shellcheck disable=SC2317 # functions are called by the shell that unshare starts
set -euo pipefail
cd "$(dirname "$0")/.."
umask 022

readonly no_machine=77 # the status of what cannot make one

skip() {
    echo "fresh: skipped, since $1"
    exit 0
}

make_machine() {
    # Users other than root, too, must get into it.
    mkdir "$root" && chmod 0755 "$root" || return
    # What is in no hurry to reach the disk is made sooner; packages that are installed later do hurry, as anywhere.
    local hurry=$root/etc/dpkg/dpkg.cfg.d/no-hurry
    mkdir -p "${hurry%/*}" && echo force-unsafe-io >"$hurry"
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
    { on_it / apt-get update --quiet=2 && on_it / apt-get upgrade --quiet=2 --yes; } >>"$folder/log" 2>&1 || return
    rm "$hurry"
}

# Runs a command in a folder of that machine. Nothing comes along from here (a compiler cache, for instance) but
# the way to the network.
on_it() {
    local name way=()
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
        [ -z "${!name:-}" ] || way+=("$name=${!name}")
    done
    chroot "$root" env --ignore-environment --chdir="$1" "${way[@]}" NODE_EXTRA_CA_CERTS="$certificates" \
        npm_config_registry="$registry" HOME=/root DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${@:2}"
}

run() {
    make_machine || exit "$no_machine"
    mkdir "$root/lamella"
    git -c safe.directory="$PWD" archive "$tree" | tar --extract --directory "$root/lamella"

    local target status=0
    exec 3>&2
    for target in demo test; do
        TIMEFORMAT="fresh: make $target took %0R s, and %0U s + %0S s of the processors"
        { time on_it /lamella make "$target" 2>&3; } 2>>"$folder/summary" || {
            echo "fresh: make $target failed" >>"$folder/summary"
            status=1
        }
    done
    # A registry out of reach is no fault of ours; what else leaves the page out is.
    if [ ! -e "$root/lamella/out/rook.html" ]; then
        echo "fresh: make demo left the page out" >>"$folder/summary"
        [ ! -e "$root/lamella/build/viewer/work/installed" ] || status=1
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
export folder root mirror sources tree certificates registry no_machine
export -f make_machine on_it run
unshare --mount-proc --pid --fork --kill-child bash -euo pipefail -c run &
machine=$!
trap 'kill -KILL $(cat "/proc/$machine/task/$machine/children"); wait "$machine" || true; exit 1' HUP INT TERM
status=0
wait "$machine" || status=$?
[ "$status" -ne "$no_machine" ] || skip "no machine could be made: $(tail -n 1 "$folder/log")"
exit "$status"

#!/bin/sh
# Installs the Debian packages of the given lists, skipping those that are installed. An entry PACKAGE=COMMAND is also
# skipped if the command exists; an entry PACKAGE:ARCHITECTURE is the package for another kind of processor.
# usage: tools/install_packages.sh LIST...
set -eu

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "install_packages: this is not a Debian system; please install what these lists name: $*" >&2
    exit 0
fi

native=$(dpkg --print-architecture)

# dpkg-query lists a package for each architecture that is installed, unless one is given.
is_installed() {
    case $1 in
    *:*) kind=${1#*:} ;;
    *) kind="($native|all)" ;;
    esac
    dpkg-query --show --showformat '${Architecture} ${db:Status-Status}\n' "$1" 2>/dev/null |
        grep --quiet --extended-regexp "^$kind installed$"
}

missing=
foreign=
for entry in $(sed 's/#.*//' "$@"); do
    package=${entry%%=*}
    case $entry in
    *=*) if command -v "${entry#*=}" >/dev/null 2>&1; then continue; fi ;;
    esac
    if is_installed "$package"; then continue; fi
    missing="$missing $package"
    case $package in
    *:*) foreign="$foreign ${package#*:}" ;;
    esac
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
    as_root=
elif command -v sudo >/dev/null 2>&1; then
    as_root=sudo
else
    echo "install_packages: missing packages, and neither root nor sudo to install them." >&2
    for kind in $foreign; do
        echo "Please run as root: dpkg --add-architecture $kind" >&2
    done
    echo "Please run as root: apt-get install --no-install-recommends$missing" >&2
    exit 1
fi

echo "Installing:$missing"
for kind in $foreign; do
    $as_root dpkg --add-architecture "$kind"
done
$as_root apt-get update --quiet=2
# Word splitting is intended: one argument per package.
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install --quiet=2 --yes --no-install-recommends \
    --option Dpkg::Use-Pty=0 $missing >/dev/null

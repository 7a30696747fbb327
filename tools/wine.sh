#!/bin/sh
# Runs a program for Windows under Wine, without a screen and without Wine's messages. The settings and the drives of Wine
# are in the folder of the environment variable WINEPREFIX, by default build/wine beside this script's folder.
# usage: tools/wine.sh PROGRAM [ARGUMENT]...
set -eu
export WINEPREFIX="${WINEPREFIX:-$(cd "$(dirname "$0")/.." && pwd)/build/wine}"
export WINEDEBUG="${WINEDEBUG:--all}" WINEDLLOVERRIDES="${WINEDLLOVERRIDES:-mscoree,mshtml=}"
export LC_ALL=C.UTF-8 # names of files are UTF-8
unset DISPLAY WAYLAND_DISPLAY
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
# The first program of several at once prepares the folder; the others wait.
if [ ! -f "$WINEPREFIX/prepared" ]; then
    mkdir -p "$WINEPREFIX"
    (
        flock 9
        if [ ! -f "$WINEPREFIX/prepared" ]; then
            "$wine" wineboot --init >/dev/null 2>&1 9>&-
            touch "$WINEPREFIX/prepared"
        fi
    ) 9>"$WINEPREFIX/.lock" </dev/null
fi
# The server of Wine must outlive each program: one that starts while the server ends would wait for ever. Services that
# start with the first program would keep its output open.
if ! pgrep -x 'wineserver(64)?' >/dev/null; then
    (
        flock 9
        if ! pgrep -x 'wineserver(64)?' >/dev/null; then
            wineserver --persistent=60 9>&- </dev/null >/dev/null 2>&1
            "$wine" cmd.exe /c exit 9>&- </dev/null >/dev/null 2>&1
        fi
    ) 9>"$WINEPREFIX/.lock"
fi
exec "$wine" "$@"

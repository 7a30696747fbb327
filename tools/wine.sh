#!/bin/sh
# Runs a program for Windows under Wine, without a screen and without Wine's messages. The settings and the drives of Wine
# are in the folder of the environment variable WINEPREFIX, by default build/wine beside this script's folder.
# usage: tools/wine.sh PROGRAM [ARGUMENT]...
set -eu
export WINEPREFIX="${WINEPREFIX:-$(cd "$(dirname "$0")/.." && pwd)/build/wine}"
export WINEDEBUG="${WINEDEBUG:--all}" WINEDLLOVERRIDES="${WINEDLLOVERRIDES:-mscoree,mshtml,winemenubuilder.exe=}"
export LC_ALL=C.UTF-8 # names of files are UTF-8
unset DISPLAY WAYLAND_DISPLAY
unset TMPDIR # another folder for temporary files would mean another server
export PATH="$PATH:/usr/lib/wine" # Debian's wine64 has its programs only here
wine=wine64
# Wine needs certain addresses, and does not start if the system has chosen these for something else: once in a thousand
# times, unless it chooses the same ones each time.
if setarch --addr-no-randomize true 2>/dev/null; then wine="setarch --addr-no-randomize $wine"; fi
# The first of several programs at once starts the server of this folder and its services; the others wait until these run.
# A program that starts them itself passes its standard output on to them. They run as long as any program does, so whoever
# reads that output to its end would wait until the last program has ended. The server stays for ten minutes without
# programs, since one that starts while the services end waits some seconds for them.
mkdir -p "$WINEPREFIX"
(
    flock 9
    if ! wineserver -k0 2>/dev/null; then # signal 0 only finds out whether there is a server
        # The server opens the files of programs. So that permissions hold for root, too, it lacks the privileges by which
        # root reads and writes everything.
        as_user=
        if [ "$(id -u)" = 0 ]; then as_user="setpriv --bounding-set=-dac_override,-dac_read_search"; fi
        $as_user wineserver --persistent=600 9>&-
        $wine wineboot 9>&-
    fi
) 9>"$WINEPREFIX/.lock" </dev/null >/dev/null 2>&1
exec $wine "$@"

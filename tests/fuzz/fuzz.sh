#!/bin/sh
# Runs each fuzz target for some minutes, on as many threads as there are: fuzz.sh PROGRAMS WORK [MINUTES]
# PROGRAMS: the folder of the fuzz targets. WORK: keeps the inputs found on the way, and those that break something.
set -eu
programs=$1
work=$2
minutes=${3:-10}
corpus=$(dirname "$0")/corpus

for program in "$programs"/fuzz_*; do
    [ -x "$program" ] && [ ! -d "$program" ] || continue
    target=${program##*/fuzz_}
    seeds=$corpus/$target
    [ -d "$seeds" ] || seeds=$corpus/${target%%_*} # a target for one of several formats
    mkdir -p "$work/$target"
    "$program" -max_len=4096 -max_total_time=$((60 * minutes)) -fork="$(nproc)" \
        -artifact_prefix="$work/$target-" "$work/$target" "$seeds"
done

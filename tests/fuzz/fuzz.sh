#!/bin/sh
# Runs each fuzz target for some minutes, on as many threads as there are: fuzz.sh PROGRAMS WORK [MINUTES]
# PROGRAMS: the folder of the fuzz targets. WORK: keeps the inputs found on the way, and those that break something.
set -eu
programs=$1
work=$2
minutes=${3:-10}
corpus=$(dirname "$0")/corpus

for target in mesh package layers arrays ilt pictures strategy; do
    mkdir -p "$work/$target"
    "$programs/fuzz_$target" -max_len=4096 -max_total_time=$((60 * minutes)) -fork="$(nproc)" \
        -artifact_prefix="$work/$target-" "$work/$target" "$corpus/$target"
done

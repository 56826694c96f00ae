#!/usr/bin/env bash
# Runs every level for many frames and fails where memory grows: more than 2 MiB allocated and not freed after the first
# 6,700, in which every camera path comes round twice, buffers find their sizes (the steps of GPU particles are kept for a
# minute) and the driver compiles its variants. The least of a round of the camera counts, at the end of both: what is in
# view varies.
# `million` runs with a sixteenth of its particles: a software OpenGL needs a second a frame for all of them, and what could
# grow (steps, births, buffers) does not depend on how many there are.
# Resident memory is printed, too: it may grow in steps where the heap is fragmented or more is visible than before.
#
#     tests/soak.sh build/release/limn [FRAMES=10000] [LEVEL ...]
set -euo pipefail
limn=$1
frames=${2:-10000}  # in all, more than 6,700
shift $(($# < 2 ? $# : 2))
levels=("$@")
if [ ${#levels[@]} -eq 0 ]; then
    mapfile -t levels < <("$limn" levels | awk 'NF {print $1}')
fi
levels_folder=$(dirname "$0")/../content/levels
failed=0
for level in "${levels[@]}"; do
    settings=()
    if [ "$level" = million ]; then
        for emitter in "young stars:32768" "nurseries:16384" "dust:12288" "old stars:4096"; do
            settings+=(--set "${emitter%:*}.particle_emitter.capacity=${emitter#*:}")
        done
    fi
    # As a file: `bench lights` would be the table of the methods.
    json=$("$limn" bench "$levels_folder/$level.level.json" --warmup 6700 --frames $((frames - 6700)) --size 64x36 "${settings[@]}" --json - 2>/dev/null)
    value() { sed -nE "s/.*\"$1\": ([0-9.]+).*/\1/p" <<<"$json"; }
    grown() { awk "BEGIN {printf \"%.1f\", $(value "$2") - $(value "$1")}"; }
    growth=$(grown heap_begin_mib heap_mib)
    printf '%-18s heap %7.1f MiB  %+5.1f   resident %7.1f MiB  %+6.1f   in %d frames\n' "$level" \
        "$(value heap_mib)" "$growth" "$(value resident_mib)" "$(grown resident_begin_mib resident_mib)" "$frames"
    awk "BEGIN {exit !($growth > 2.0)}" && failed=1
done
[ $failed -eq 0 ] || { echo "memory grows" >&2; exit 1; }

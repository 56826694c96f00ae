#!/usr/bin/env bash
# Renders two frames of every level, and of the models of a folder, with a program built with sanitizers.
#
#     tests/sanitize_levels.sh build/fuzz/limn [FOLDER]
set -euo pipefail
export limn=$1
here=$(cd "$(dirname "$0")" && pwd)
export out
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export LSAN_OPTIONS=suppressions=$here/lsan.supp:print_suppressions=0
# The leak checker itself crashes now and then while the driver's threads end ("Tracer caught signal 11"); what it
# reports then says nothing about the level, so the level is drawn again, three times at most.
render() {
    local place
    place=$(mktemp -d -p "$out")
    for _ in 1 2 3; do
        if "$limn" render "$1" --frames 0:1 --size 64x36 -o "$place/frame_%04d.png" >"$place/log" 2>&1; then
            echo "$1: clean"
            return
        fi
        grep -q 'LeakSanitizer has encountered a fatal error' "$place/log" || break
    done
    cat "$place/log"
    echo "$1: failed under the sanitizers" >&2
    return 1
}
export -f render
{
    "$limn" levels | awk 'NF {print $1}'
    [ $# -lt 2 ] || find "$2" -name '*.gl[tb]*' | sort
} | xargs -d '\n' -P "$(nproc)" -I {} bash -c 'render "$1"' _ {}

#!/usr/bin/env bash
# Renders three frames of every level, and of the models of a folder, with a program built with sanitizers.
#
#     tests/sanitize_levels.sh build/fuzz/limn [FOLDER]
set -euo pipefail
limn=$1
here=$(cd "$(dirname "$0")" && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export LSAN_OPTIONS=suppressions=$here/lsan.supp:print_suppressions=0
render() {
    "$limn" render "$1" --frames 0:2 --size 64x36 -o "$out/frame_%04d.png" >"$out/log" 2>&1 \
        || { cat "$out/log"; echo "$1: failed under the sanitizers" >&2; exit 1; }
    echo "$1: clean"
}
"$limn" levels | awk 'NF {print $1}' | while read -r level; do render "$level"; done
if [ $# -gt 1 ]; then
    find "$2" -name '*.gl[tb]*' | sort | while read -r model; do render "$model"; done
fi

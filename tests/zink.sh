#!/usr/bin/env bash
# Renders every level with two OpenGL implementations, llvmpipe and zink on lavapipe (Debian: mesa-vulkan-drivers), and
# fails if the PSNR of a level is below 45 dB.
#
#   tests/zink.sh build/release/limn [LEVEL...]
set -euo pipefail
limn=$1
shift
minimum=45
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

on_zink() {
    MESA_LOADER_DRIVER_OVERRIDE=zink LIBGL_ALWAYS_SOFTWARE=1 XDG_RUNTIME_DIR="$folder" \
        VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json "$@"
}

levels=("$@")
[ $# -gt 0 ] || mapfile -t levels < <("$limn" levels | awk '{ print $1 }')
export limn folder minimum
compare() {
    local level=$1 size=(--size 320x180 --time 1) psnr=failed
    "$limn" render "$level" --quiet -o "$folder/$level.llvmpipe.png" "${size[@]}"
    if on_zink "$limn" render "$level" --quiet -o "$folder/$level.zink.png" "${size[@]}"; then
        psnr=$("$limn" compare "$folder/$level.llvmpipe.png" "$folder/$level.zink.png" | awk '/^psnr/ { print $2 }')
    fi
    printf '%-20s %s dB\n' "$level" "$psnr"
    awk -v p="$psnr" -v minimum="$minimum" 'BEGIN { exit !(p == "inf" || p + 0 >= minimum) }'
}
export -f compare on_zink
printf '%s\n' "${levels[@]}" | xargs -P "$(nproc)" -I {} bash -c 'compare {}'

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
failed=0
for level in "${levels[@]}"; do
    size=(--size 320x180 --time 1)
    "$limn" render "$level" --quiet -o "$folder/llvmpipe.png" "${size[@]}"
    psnr=failed
    if on_zink "$limn" render "$level" --quiet -o "$folder/zink.png" "${size[@]}"; then
        psnr=$("$limn" compare "$folder/llvmpipe.png" "$folder/zink.png" | awk '/^psnr/ { print $2 }')
    fi
    printf '%-20s %s dB\n' "$level" "$psnr"
    awk -v p="$psnr" -v minimum="$minimum" 'BEGIN { exit !(p == "inf" || p + 0 >= minimum) }' || failed=1
done
exit "$failed"

#!/usr/bin/env bash
# Draws every level with a second OpenGL implementation, zink on lavapipe (Debian: mesa-vulkan-drivers), and compares
# the images with those in tests/golden.
#
#     tests/zink.sh build/release
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export MESA_LOADER_DRIVER_OVERRIDE=zink LIBGL_ALWAYS_SOFTWARE=1 XDG_RUNTIME_DIR=$folder
export VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json
says=$("$1"/limn play lights --headless-frames 1 --size 64x36 -o "$folder/frames" 2>&1)
[[ $says == *zink* ]] || { echo "OpenGL is not zink: $says" >&2; exit 1; }
"$1"/limn_app_tests --no-intro --source-file='*/level_golden_test.cpp' --test-case='*looks as agreed*'

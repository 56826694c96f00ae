#!/usr/bin/env bash
# Runs on a real GPU what depends on one: the tests of the renderer, the golden images of all levels, and every effect
# beside its oracle. Fails if OpenGL is a software one. CI has no GPU; this is for a machine that has.
#
#     tests/gpu.sh build/release
set -euo pipefail
folder=$(realpath "$1")
export LIMN_GL_DEVICE=gpu
says=$("$folder"/limn bench lights --size 64x36 --frames 1 --warmup 0)
echo "$says" | sed -n 2p
ctest --test-dir "$folder" -j "$(nproc)" -L render --output-on-failure --no-tests=error
"$folder"/limn_app_tests --no-intro --source-file='*/level_golden_test.cpp'
"$folder"/limn quality

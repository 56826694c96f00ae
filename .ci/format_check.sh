#!/usr/bin/env bash
# format_check.sh FILE...: "file:line: not formatted", a line each, for what the target `format` would change.
set -uo pipefail
found=$(clang-format --dry-run "$@" 2>&1 | sed -nE 's/^([^:]+:[0-9]+):[0-9]+: (warning|error): code should be clang-formatted.*/\1: not formatted/p' | uniq)
[ -z "$found" ] && exit 0
printf '%s\n' "$found"
exit 1

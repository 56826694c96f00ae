#!/usr/bin/env bash
# format_check.sh: "file:line: not formatted", a line each and nothing else, for what the target `format` would change.
set -uo pipefail
cd "$(dirname "$0")/.."
found=$(git ls-files -z --cached --others --exclude-standard 'ecs/*.h' 'ecs/*.cpp' 'systems/*.h' 'systems/*.cpp' 'render/*.h' 'render/*.cpp' 'content/*.h' 'content/*.cpp' \
    'tests/*.h' 'tests/*.cpp' 'bench/*.h' 'bench/*.cpp' | xargs -0 clang-format --dry-run 2>&1 |
    sed -nE 's/^([^:]+:[0-9]+):[0-9]+: (warning|error): code should be clang-formatted.*/\1: not formatted/p' | uniq)
[ -z "$found" ] && exit 0
printf '%s\n' "$found"
exit 1

#!/bin/bash
# Gate 22: how long the smallest useful source takes to compile at -O2 [s of CPU time], best of five.
# Usage: bench/micro/compile_time.sh [compiler]
set -e
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/smallest.cpp" <<'END'
#include "ecs/world.h"

struct Position {
    float x;
};
struct Velocity {
    float x;
};

void move(limn::World& world) {
    world.query<const Velocity, Position>().each(
        [](const Velocity& velocity, Position& position) { position.x += velocity.x; });
}
void drag(limn::World& world) {
    world.query<Velocity>().each([](Velocity& velocity) { velocity.x *= 0.5f; });
}
END
best=
for run in 1 2 3 4 5; do
    times=$( (TIMEFORMAT='%U %S'; time "${1:-c++}" -std=c++20 -O2 -I "$root" -c "$folder/smallest.cpp" -o "$folder/smallest.o") 2>&1)
    best=$(printf '%s\n' "$times" "$best" | awk 'NF == 2 { print $1 + $2 } NF == 1 { print $1 }' | sort -n | head -1)
done
echo "smallest source at -O2: $best s, gate 1.1, goal 0.6"

// expects: chunks: sparse components come row by row; use each or par_each
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position, Burning> all) {
    all.chunks([](limn::ChunkView, std::span<Position>, std::span<Burning>) {});
}

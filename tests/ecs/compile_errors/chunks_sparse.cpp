// expects: chunks: sparse components are not in chunks; use each or par_each
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position, Burning> all) {
    all.chunks([](limn::ChunkView, std::span<Position>, std::span<Burning>) {});
}

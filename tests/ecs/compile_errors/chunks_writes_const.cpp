// expects: chunks: the function takes a ChunkView and one std::span per component, in order
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<const Position> all) {
    all.par_chunks([](limn::ChunkView, std::span<Position> positions) { positions[0].x += 1; });
}

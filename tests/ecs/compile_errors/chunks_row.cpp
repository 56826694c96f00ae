// expects: chunks: the function takes a ChunkView and one std::span per component, in order:
// std::span<const A>, std::span<B>
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position> all) {
    all.chunks([](Position& position) { position.x += 1; });
}

// expects: chunks: tags have no array; use With<Tag>
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position, Hidden> all) {
    all.chunks([](limn::ChunkView, std::span<Position>, std::span<Hidden>) {});
}

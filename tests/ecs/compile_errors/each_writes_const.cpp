// expects: each: the function takes the query's components in order
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<const Position> all) {
    all.par_each([](Position& position) { position.x += 1; });
}

// expects: each: the function takes the query's components in order
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position, limn::Optional<const Velocity>> all) {
    all.each([](Position& position, const Velocity& velocity) { position.x += velocity.x; });
}

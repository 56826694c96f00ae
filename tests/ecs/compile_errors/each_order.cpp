// expects: each: the function takes the query's components in order (const A&, B&, Optional as C*),
// optionally preceded by an Entity
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<const Velocity, Position> moving) {
    moving.each([](Position& position, const Velocity& velocity) { position.x += velocity.x; });
}

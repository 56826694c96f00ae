// expects: a query that both requires and excludes a component matches no entities
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    (void)world.query<Position, limn::With<Hidden>, limn::Without<Hidden>>().count();
}

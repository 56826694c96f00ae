// expects: a query that asks for a component Without itself has no entities
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    (void)world.query<Position, limn::With<Hidden>, limn::Without<Hidden>>().count();
}

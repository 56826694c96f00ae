// expects: components are values, not pointers, arrays or entities
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world, limn::Entity parent) {
    world.create(Position{}, parent);
}

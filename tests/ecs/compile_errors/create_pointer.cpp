// expects: components are values, not pointers, arrays or entities
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world, Position* position) {
    world.create(position);
}

// expects: an entity has each component only once
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    world.create(Position{}, Velocity{}, Position{});
}

// expects: get, find: a split component has no address; use value<T>(entity) and set(entity, value)
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world, limn::Entity entity) {
    world.get<Drift>(entity).x += 1;
}

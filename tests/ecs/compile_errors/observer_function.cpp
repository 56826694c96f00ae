// expects: an observer is a function of (World&, std::span<const Entity>)
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    world.on_add<Position>([](limn::Entity) {});
}

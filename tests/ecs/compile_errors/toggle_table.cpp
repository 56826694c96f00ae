// expects: T cannot be disabled: its storage is not Storage::Toggle
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world, limn::Entity entity) {
    world.disable<Position>(entity);
}

// expects: a const World has only const components: query<const A>()
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(const limn::World& world) {
    world.query<Position>().each([](Position& position) { position.x += 1; });
}

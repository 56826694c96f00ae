// expects: a parameter of a system is Query<..>, Res<T>, OptionalRes<T>, Commands, World& or const
// World&; components come through a Query
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    world.run([](Position& position) { position.x += 1; });
}

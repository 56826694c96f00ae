// expects: a query term is T, const T, Optional<T>, With<..>, Without<..>, AnyOf<..> or
// Changed<..>; an Entity parameter needs no term
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    world.query<limn::Entity, Position>().each(
        [](limn::Entity, Position& position) { position.x += 1; });
}

// expects: Optional takes one component type
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    (void)world.query<limn::Optional<Position*>>().count();
}

// expects: a system takes the World by reference
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Schedule& schedule) {
    schedule.add("blow", [](limn::Query<Position>, const limn::World) {});
}

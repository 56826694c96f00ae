// expects: a system takes Query, Res, Commands and the like by value, without &
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position>& positions);

void add_to(limn::Schedule& schedule) {
    schedule.add<blow>();
}

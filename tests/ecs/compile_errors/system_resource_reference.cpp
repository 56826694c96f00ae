// expects: a system takes Query, Res, Commands and the like by value, without &
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<Position> positions, const limn::Res<FrameStep>& step);

void add_to(limn::Schedule& schedule) {
    schedule.add<blow>();
}

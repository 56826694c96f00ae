// expects: a system takes Commands only once
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Commands first, limn::Commands second);

void add_to(limn::Schedule& schedule) {
    schedule.add<blow>();
}

// expects: a system has one Commands
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Commands first, limn::Commands second);

void add_to(limn::Schedule& schedule) {
    schedule.add<blow>();
}

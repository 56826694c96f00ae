// expects: a query must list each component only once
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<const Position, Position> all) {
    all.each([](const Position& from, Position& to) { to = from; });
}

// expects: find: T must be a term of the query, const if the term is const
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::Query<const Position> all, limn::Entity entity) {
    all.find<Position>(entity)->x += 1;
}

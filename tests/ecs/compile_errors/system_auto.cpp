// expects: a system is a function or a lambda without auto parameters
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(limn::World& world) {
    world.run([](auto positions) { positions.each([](Position&) {}); });
}

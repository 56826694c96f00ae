// expects: a component is moved and destroyed without exceptions: give it a noexcept move
// constructor
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

struct Stubborn {
    Stubborn() = default;
    Stubborn(const Stubborn&) {}
    int value = 0;
};

void blow(limn::World& world) {
    world.create(Stubborn{});
}

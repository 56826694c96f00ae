// expects: Storage::Split: the component must be trivially copyable and made of 4-byte scalars
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

struct Precise {
    double x = 0;
};
template <>
struct limn::ComponentTraits<Precise> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};

void blow(limn::World& world) {
    world.create(Precise{});
}

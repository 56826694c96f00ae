// expects: a field of this type needs LIMN_FIELDS
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

struct Wind {
    Velocity velocity;
};
template <typename Visitor>
void visit_fields(Wind& wind, Visitor&& visit) {
    visit("velocity", wind.velocity);
}

void blow() {
    limn::register_component<Wind>();
}

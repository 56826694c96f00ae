#include "ecs/any_component.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"
#include "systems/particles/emitter_restart.h"
#include "systems/update_world.h"

#include <doctest/doctest.h>

namespace limn::emitter_restart_test {

TEST_CASE("emitter: another seed restarts it, another rate does not") {
    World world;
    ParticleEmitter emitter;
    emitter.rate = 100;
    const Entity fire = world.create(Transform{}, emitter);
    start_world(world);
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 20; ++i) {
        step_world(world, schedule);
    }
    const auto born = [&] { return world.get<const ParticlePool>(fire).clock.born; };
    REQUIRE(born() > 0);
    emitter = world.value<ParticleEmitter>(fire);
    emitter.rate = 50;
    write_fields(world, fire, AnyComponent::of(emitter));
    CHECK(born() > 0);
    emitter.seed += 1;
    write_fields(world, fire, AnyComponent::of(emitter));
    CHECK(born() == 0);
    CHECK(world.get<const ParticlePool>(fire).size() == 0);
}

}  // namespace limn::emitter_restart_test

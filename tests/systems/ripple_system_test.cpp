#include "ecs/world.h"
#include "systems/ripple_system.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

namespace limn::ripple_system_test {

TEST_CASE("ripples: a ring ages by the step and is removed at its end") {
    World world;
    world.insert_resource(FrameTime{.step = 0.25f});
    const Entity e = world.create(RippleRing{.age = -0.25f, .duration = 0.75f});
    for (const float age : {0.0f, 0.25f, 0.5f}) {
        world.run(update_ripples);
        REQUIRE(world.find<RippleRing>(e) != nullptr);
        CHECK(world.get<RippleRing>(e).age == age);
    }
    world.run(update_ripples);
    CHECK(world.find<RippleRing>(e) == nullptr);
    CHECK(world.alive(e));
}

TEST_CASE("ripples: a ring with a period restarts") {
    World world;
    world.insert_resource(FrameTime{.step = 0.25f});
    const Entity e = world.create(RippleRing{.duration = 0.5f, .period = 1});
    for (const float age : {0.25f, 0.5f, 0.75f, 0.0f, 0.25f}) {
        world.run(update_ripples);
        CHECK(world.get<RippleRing>(e).age == age);
    }
}

TEST_CASE("ripples: a screen ripple ends after its duration") {
    World world;
    world.insert_resource(FrameTime{.step = 0.25f});
    const Entity e = world.create(ScreenRipple{.duration = 0.5f});
    world.run(update_ripples);
    CHECK(world.get<ScreenRipple>(e).age == 0.25f);
    world.run(update_ripples);
    CHECK(world.find<ScreenRipple>(e) == nullptr);
}

TEST_CASE(
    "ripples: they fade in and out with age, and are 0 before and after"
    * technique("post.scene-ripple")) {
    for (const float age : {-1.0f, 0.0f, 0.5f, 2.0f}) {
        CHECK(ripple_fade(ScreenRipple{.age = age, .duration = 0.5f}) == 0);
    }
    CHECK(ripple_fade(ScreenRipple{.age = 0.25f, .duration = 0.5f}) == 1);
    CHECK(ripple_fade(RippleRing{.age = -0.1f, .duration = 1}) == 0);
    CHECK(ripple_fade(RippleRing{.age = 0.25f, .duration = 1}) == 0.75f);
    CHECK(ripple_fade(RippleRing{.age = 1, .duration = 1}) == 0);
    CHECK(ripple_fade(RippleRing{.age = 1, .duration = 0}) == 0);
}

}  // namespace limn::ripple_system_test

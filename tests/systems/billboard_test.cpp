#include "ecs/components/all.h"
#include "ecs/components/billboard.h"
#include "ecs/components/time.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/particles/billboard_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <limits>

namespace limn::test::billboard_test {

TEST_CASE(
    "billboard: one that does not loop dies after its last image, with its children"
    * technique("engine.billboard")) {
    register_all_components();
    World world;
    world.insert_resource(FrameTime{});
    ParticleLook look;
    look.columns = 4;
    look.rows = 3;
    ParticleLook film = look;
    film.frame_rate = 30;
    const Entity ends = world.create(Billboard{.loop = false}, film);
    const Entity child = world.create(Parent{ends});
    const Entity loops = world.create(Billboard{}, film);
    const Entity still = world.create(Billboard{.loop = false}, look);
    int steps = 0;
    while (world.alive(ends) && steps < 1000) {
        update_billboards(world);
        ++steps;
    }
    CHECK(steps == 24);  // 12 images of 1/30 s
    CHECK_FALSE(world.alive(child));
    CHECK(world.alive(loops));
    CHECK(world.alive(still));
    CHECK(world.get<const Billboard>(loops).time == near(0.4));
}

TEST_CASE(
    "billboard: thirty frames a second show image 15 after half a second, then begin again"
    * technique("engine.billboard")) {
    CHECK(billboard_frame(30, 64, 0.5) == 15);
    CHECK(billboard_frame(30, 64, 0.4999) == 14);
    CHECK(billboard_frame(30, 12, 0.5) == 3);
    CHECK(billboard_frame(0, 12, 0.5) == 0);
    CHECK(billboard_frame(30, 0, 0.5) == 0);
    CHECK(billboard_frame(std::numeric_limits<float>::quiet_NaN(), 12, 1) == 0);
    CHECK_FALSE(billboard_life({.loop = true}, 30, 12).has_value());
    CHECK_FALSE(billboard_life({.loop = false}, 0, 12).has_value());
    CHECK(billboard_life({.loop = false}, 30, 12).value() == near(0.4));
}

}  // namespace limn::test::billboard_test

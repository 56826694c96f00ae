#include "ecs/components/camera.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "systems/autofocus_system.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace limn::autofocus_test {
namespace {

/// A camera at the origin that looks along -z, and what it is to be focused on.
struct Scene {
    World world;
    Schedule schedule = make_world_schedule();
    Entity target;
    Entity camera;

    explicit Scene(const Autofocus& wanted, float step = 1.0f / 60.0f) {
        world.insert_resource(FrameTime{.step = step});
        target = world.create(Transform{.position = {0.5f, 0, -4}});
        Autofocus autofocus = wanted;
        autofocus.target = target;
        camera = world.create(Transform{}, Camera{}, Lens{.focus_distance = 1}, autofocus);
        start_world(world);
    }
    void run(float seconds) {
        const int steps = static_cast<int>(std::lround(seconds / world.resource<FrameTime>().step));
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    void move_target(const Vec3& place) { world.get<Transform>(target).position = place; }
    [[nodiscard]] float focus() const { return world.get<Lens>(camera).focus_distance; }
};

}  // namespace

TEST_CASE("autofocus: the first frame is in focus") {
    CHECK(Scene({.response = 0.5f}).focus() == test::near(4));
}

TEST_CASE("autofocus: it is the distance along the view axis that counts, of the point meant") {
    Scene scene({.offset = {0, 3, 1}, .response = 0});
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(3));
    scene.world.get<Transform>(scene.camera).rotation =
        glm::angleAxis(radians(-90.0f), Vec3(0, 1, 0));
    scene.world.get<Transform>(scene.camera).scale = {3, 3, 3};
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(0.5f));  // looks along +x now
}

TEST_CASE(
    "autofocus: after the response time 63 % of the way in 1 / z is gone, whatever the step") {
    for (const float step : {1.0f / 240.0f, 1.0f / 60.0f, 1.0f / 15.0f}) {
        Scene scene({.response = 0.4f}, step);
        scene.run(0.2f);
        scene.move_target({0, 0, -2});
        scene.run(0.4f);
        const float gone = (1 / scene.focus() - 0.25f) / (0.5f - 0.25f);
        CHECK(gone == test::near(1 - std::exp(-1.0f)).epsilon(1e-4));
    }
}

TEST_CASE("autofocus: two half steps are one whole step") {
    const float whole = pull_focus(3, 0.5f, 0.2f, 0.1f);
    CHECK(pull_focus(pull_focus(3, 0.5f, 0.2f, 0.05f), 0.5f, 0.2f, 0.05f) == test::near(whole));
    CHECK(pull_focus(3, 3, 0.2f, 0.1f) == test::near(3));
    CHECK(pull_focus(3, 0.5f, 0, 0.1f) == 0.5f);
    CHECK(pull_focus(3, 0.5f, 0.2f, 0) == test::near(3));
}

TEST_CASE("autofocus: without a target in front of the camera the focus stays") {
    Scene scene({.response = 0});
    scene.run(0.1f);
    scene.move_target({0, 0, 5});
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(4));  // behind
    scene.move_target({0, 0, -std::numeric_limits<float>::infinity()});
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(4));
    scene.world.destroy(scene.target);
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(4));  // gone
    scene.world.get<Autofocus>(scene.camera).target = Entity{};
    scene.run(0.1f);
    CHECK(scene.focus() == test::near(4));  // null
}

TEST_CASE("autofocus: it jumps with what is teleported, and mends a focus that is none") {
    Scene scene({.response = 10});
    scene.run(0.1f);
    scene.move_target({0, 0, -7});
    scene.world.add(scene.target, Teleport{});
    scene.run(1.0f / 60.0f);
    CHECK(scene.focus() == test::near(7));
    scene.world.get<Lens>(scene.camera).focus_distance = std::numeric_limits<float>::quiet_NaN();
    scene.run(1.0f / 60.0f);
    CHECK(scene.focus() == test::near(7));
}

}  // namespace limn::autofocus_test

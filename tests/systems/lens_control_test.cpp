#include "ecs/components/camera.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/transform.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "systems/lens_control_system.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::lens_control_test {
namespace {

/// Two cameras with lenses, one of them active and with an autofocus.
struct Scene {
    World world;
    Schedule schedule = make_world_schedule();
    Entity target;
    Entity camera;
    Entity other;

    Scene() {
        target = world.create(Transform{.position = {0, 0, -4}});
        camera =
            world.create(Transform{}, Camera{}, Lens{}, Autofocus{.target = target, .response = 0});
        other = world.create(Transform{}, Camera{.active = false}, Lens{});
        world.insert_resource(MotionBlur{.shutter = 180});
        start_world(world);
    }
    void turn(const Vec3& lens, int steps = 30) {
        Input& input = world.resource<Input>();
        set_action(input, "focus_farther", lens.x);
        set_action(input, "aperture_open", lens.y);
        set_action(input, "shutter_longer", lens.z);
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
        world.resource<Input>() = {};
    }
};

}  // namespace

TEST_CASE("lens_control: nobody's hand turns nothing") {
    Scene scene;
    scene.turn(Vec3(0));
    const auto& lens = scene.world.get<Lens>(scene.camera);
    CHECK(lens.focus_distance == test::near(4));
    CHECK(lens.f_number == Lens{}.f_number);
    CHECK(scene.world.resource<MotionBlur>().shutter == 180);
}

TEST_CASE(
    "lens_control: a hand pulls focus of the active camera, and keeps it from the autofocus") {
    Scene scene;
    scene.turn({-1, 0, 0});
    const float pulled = scene.world.get<Lens>(scene.camera).focus_distance;
    CHECK(pulled < 3.5f);
    scene.turn(Vec3(0));
    CHECK(scene.world.get<Lens>(scene.camera).focus_distance == pulled);
    CHECK(scene.world.get<Lens>(scene.other).focus_distance == Lens{}.focus_distance);
}

TEST_CASE("lens_control: aperture and shutter open and close") {
    Scene scene;
    scene.turn({0, 1, 0.5f});
    CHECK(scene.world.get<Lens>(scene.camera).f_number < Lens{}.f_number);
    CHECK(scene.world.get<Lens>(scene.camera).focus_distance == test::near(4));
    CHECK(scene.world.resource<MotionBlur>().shutter == test::near(210));
    scene.turn({0, -1, -0.5f});
    CHECK(scene.world.get<Lens>(scene.camera).f_number == test::near(Lens{}.f_number));
    CHECK(scene.world.resource<MotionBlur>().shutter == test::near(180));
    scene.world.remove_resource<MotionBlur>();
    scene.turn({0, 0, 1});
}

TEST_CASE("lens_control: two half steps are one, back is where it was, and the rings have ends") {
    CHECK(adjust_focus(adjust_focus(3, 1, 0.1f), 1, 0.1f) == test::near(adjust_focus(3, 1, 0.2f)));
    CHECK(adjust_focus(adjust_focus(3, 1, 0.3f), -1, 0.3f) == test::near(3));
    CHECK(adjust_aperture(2, 1, 2.0f / 1.5f) == test::near(1));  // two stops
    CHECK(adjust_focus(3, 1, 1e6f) == 1000);
    CHECK(adjust_focus(3, -1, 1e6f) == 0.02f);
    CHECK(adjust_aperture(2, 1, 1e6f) == 0.5f);
    CHECK(adjust_aperture(2, -1, 1e6f) == 64);
    CHECK(adjust_shutter(90, 1, 1e6f) == 360);
    CHECK(adjust_shutter(90, -1, 1e6f) == 0);
}

}  // namespace limn::lens_control_test

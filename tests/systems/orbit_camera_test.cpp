#include "ecs/schedule.h"
#include "systems/orbit_camera_system.h"
#include "systems/transform_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::orbit_camera_test {
namespace {

bool near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    return glm::length(a - b) <= tolerance;
}

/// A target with its camera, and the systems that move them.
struct Scene {
    World world;
    Schedule schedule;
    Entity target;
    Entity camera;

    explicit Scene(const OrbitCamera& orbit) {
        schedule.add<add_world_transforms>();
        schedule.sync();
        schedule.add<update_transforms>();
        schedule.add<update_orbit_cameras>();
        world.insert_resource(Input{});
        world.insert_resource(FrameTime{.step = 1.0f / 60.0f});
        target = world.create(Transform{});
        OrbitCamera about_target = orbit;
        about_target.target = target;
        camera = world.create(Transform{}, Camera{}, about_target);
    }
    void step() {
        schedule.run(world);
        ++world.resource<FrameTime>().frame;
    }
    [[nodiscard]] Vec3 position() const { return world.get<Transform>(camera).position; }
};

}  // namespace

TEST_CASE(
    "orbit_camera: the book's five positions about a target at rest"
    * technique("engine.camera-orbit")) {
    const Affine identity;
    CHECK(near(orbit_position_z_up(identity, 0, 0, 10), {0, 10, 0}));
    CHECK(near(orbit_position_z_up(identity, radians(90), 0, 10), {10, 0, 0}));
    CHECK(near(orbit_position_z_up(identity, 0, radians(90), 10), {0, 0, 10}));
    CHECK(near(orbit_position_z_up(identity, radians(180), 0, 10), {0, -10, 0}));
    CHECK(near(
        orbit_position_z_up(identity, radians(30), radians(45), 10),
        {3.535534f, 6.123724f, 7.071068f}));
}

TEST_CASE("orbit_camera: ours is the book's with y up" * technique("engine.camera-orbit")) {
    const Affine identity;
    CHECK(near(orbit_position(identity, 0, 0, 10), {0, 0, 10}));
    CHECK(near(orbit_position(identity, radians(90), 0, 10), {10, 0, 0}));
    CHECK(near(orbit_position(identity, 0, radians(90), 10), {0, 10, 0}));
    const Vec3 book = orbit_position_z_up(identity, 0.4f, 0.9f, 3);
    CHECK(near(orbit_position(identity, 0.4f, 0.9f, 3), {book.x, book.z, book.y}));
}

TEST_CASE(
    "orbit_camera: its distance is the requested one, whatever the target's pose and scale"
    * technique("engine.camera-orbit")) {
    const Affine target =
        affine_from({1, -2, 3}, glm::normalize(Quat(0.4f, 0.1f, -0.7f, 0.2f)), {2, 0.1f, 7});
    for (const float azimuth : {0.0f, 1.0f, 4.0f}) {
        for (const float elevation : {-1.2f, 0.0f, 0.8f}) {
            const Vec3 to = orbit_position(target, azimuth, elevation, 6) - Vec3(1, -2, 3);
            CHECK(glm::length(to) == test::near(6.0f).epsilon(1e-5));
        }
    }
}

TEST_CASE(
    "camera_lag: 1 is rigid; 0.9 leaves a tenth after one frame and a hundredth after two"
    * technique("engine.camera-lag")) {
    const float dt = 1.0f / 60.0f;
    CHECK(lag_position({5, 0, 0}, {1, 2, 3}, 1, dt) == Vec3(1, 2, 3));
    const Vec3 one = lag_position({1, 0, 0}, {0, 0, 0}, 0.9f, dt);
    CHECK(one.x == test::near(0.1f));
    CHECK(lag_position(one, {0, 0, 0}, 0.9f, dt).x == test::near(0.01f));
    CHECK(lag_position({1, 0, 0}, {0, 0, 0}, 0, dt).x == test::near(1.0f));
}

TEST_CASE(
    "camera_lag: the path does not depend on the frame rate, and never overshoots"
    * technique("engine.camera-lag")) {
    const Vec3 start = {1, -4, 2};
    const Vec3 wanted = {0, 3, 7};
    const Vec3 long_step = lag_position(start, wanted, 0.3f, 1.0f / 30.0f);
    const Vec3 two_steps =
        lag_position(lag_position(start, wanted, 0.3f, 1.0f / 60.0f), wanted, 0.3f, 1.0f / 60.0f);
    CHECK(near(long_step, two_steps));
    for (const float dt : {0.001f, 0.1f, 1.0f, 100.0f}) {
        for (const float follow : {0.0f, 0.1f, 0.99f, 1.0f}) {
            CHECK(lag_fraction(follow, dt) >= 0);
            CHECK(lag_fraction(follow, dt) <= 1);
        }
    }
}

TEST_CASE(
    "camera_lag: the printed code moves a sixtieth of the distance where it claims to be rigid"
    * technique("engine.camera-lag")) {
    CHECK(near(lag_position_legacy({0, 0, 0}, {60, 0, 0}, 1, 1.0f / 60.0f), {1, 0, 0}));
    CHECK(lag_position_legacy({0, 0, 0}, {1, 0, 0}, 1, 3).x > 1);  // overshoots
}

TEST_CASE(
    "look_at: the frame is orthonormal, faces z and leans toward up"
    * technique("engine.look-at")) {
    CHECK(look_at_frame({0, 0, 1}, {0, 1, 0}) == Mat3(1.0f));
    for (int i = 0; i < 200; ++i) {
        const float a = 0.37f * static_cast<float>(i);
        const Vec3 z = glm::normalize(Vec3(std::cos(a), std::sin(1.7f * a), std::sin(a)));
        const Vec3 up = i % 3 == 0   ? Vec3(0, 1, 0)
                        : i % 3 == 1 ? Vec3(0, 0, 1)
                                     : glm::normalize(Vec3(1, 2, -1));
        const Mat3 frame = look_at_frame(z, up);
        CHECK(glm::determinant(frame) == test::near(1.0f).epsilon(1e-5));
        CHECK(near(frame[2], z));
        CHECK(glm::dot(frame[1], up) >= 0);
        CHECK(std::abs(glm::dot(frame[0], frame[1])) < 1e-6f);
        CHECK(std::abs(glm::dot(frame[1], frame[2])) < 1e-6f);
    }
}

TEST_CASE(
    "look_at: a direction along up, or none at all, still has a frame"
    * technique("engine.look-at")) {
    for (const Vec3 z : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 0)}) {
        const Mat3 frame = look_at_frame(z, {0, 1, 0});
        CHECK(glm::determinant(frame) == test::near(1.0f));
        CHECK(std::isfinite(frame[0].x + frame[1].y));
    }
    CHECK(glm::determinant(look_at_frame({1, 2, 3}, {0, 0, 0})) == test::near(1.0f));
}

TEST_CASE("orbit_camera: the target is in the center of the image, where the lens points") {
    Scene scene(
        {.target = {},
         .offset = {0, 1, 0},
         .azimuth = 0.7f,
         .elevation = 0.4f,
         .distance = 8,
         .follow = 1});
    scene.world.get<Transform>(scene.target) = {
        .position = {3, -1, 2}, .rotation = glm::angleAxis(1.1f, glm::normalize(Vec3(1, 1, 0)))};
    scene.step();
    const Affine pose = scene.world.get<WorldTransform>(scene.camera).world;
    const Vec3 point =
        transform_point(scene.world.get<WorldTransform>(scene.target).world, {0, 1, 0});
    const Vec3 seen = glm::inverse(to_mat4(pose)) * Vec4(point, 1);
    CHECK(near(seen, {0, 0, -8}, 1e-4f));
    CHECK(near(scene.position(), transform_point(pose, {0, 0, 0})));
}

TEST_CASE(
    "orbit_camera: a target that is moved before a step is centered, after it not"
    * technique("engine.main-loop")) {
    Scene scene({.target = {}, .azimuth = 0, .elevation = 0, .distance = 5, .follow = 1});
    scene.step();
    const auto target_in_view = [&] {
        const Vec3 point =
            transform_point(scene.world.get<WorldTransform>(scene.target).world, {0, 0, 0});
        const Affine pose = scene.world.get<WorldTransform>(scene.camera).world;
        return Vec3(glm::inverse(to_mat4(pose)) * Vec4(point, 1));
    };
    scene.world.get<Transform>(scene.target).position = {2, 1, 0};
    scene.step();
    CHECK(near(target_in_view(), {0, 0, -5}));
    // Between the step and the image, when nothing may change: the camera has turned already.
    scene.world.get<WorldTransform>(scene.target).world.row[0].w += 0.5f;
    CHECK(near(target_in_view(), {0.5f, 0, -5}));
}

TEST_CASE(
    "orbit_camera: it follows with its lag, is rigid in the first frame and after a teleport") {
    Scene scene({.target = {}, .azimuth = 0, .elevation = 0, .distance = 5, .follow = 0.9f});
    scene.step();
    CHECK(near(scene.position(), {0, 0, 5}));
    CHECK(scene.world.get<PreviousWorldTransform>(scene.camera).world.row[2].w == test::near(5));
    scene.world.get<Transform>(scene.target).position.x = 10;
    scene.step();
    CHECK(near(scene.position(), {9, 0, 5}, 1e-4f));
    CHECK(
        scene.world.get<PreviousWorldTransform>(scene.camera).world.row[0].w
        == test::near(0).scale(1));
    scene.step();
    CHECK(near(scene.position(), {9.9f, 0, 5}, 1e-4f));
    CHECK(scene.world.get<PreviousWorldTransform>(scene.camera).world.row[0].w == test::near(9));

    scene.world.get<Transform>(scene.target).position.x = -50;
    scene.world.add(scene.target, Teleport{});
    scene.step();
    CHECK(near(scene.position(), {-50, 0, 5}, 1e-4f));
    CHECK(scene.world.get<PreviousWorldTransform>(scene.camera).world.row[0].w == test::near(-50));
}

TEST_CASE("orbit_camera: it does not move if its target is destroyed") {
    Scene scene({.target = {}, .distance = 5});
    scene.step();
    const Vec3 before = scene.position();
    scene.world.destroy(scene.target);
    scene.step();
    CHECK(scene.position() == before);
}

TEST_CASE("orbit_camera: mouse and wheel rotate and zoom only the active camera") {
    Scene scene({.target = {}, .azimuth = 0, .elevation = 0, .distance = 5, .follow = 1});
    scene.world.resource<Input>() = {.look = {-100, 20}, .zoom = 1};
    scene.step();
    const OrbitCamera turned = scene.world.get<OrbitCamera>(scene.camera);
    CHECK(turned.azimuth > 0);
    CHECK(turned.elevation > 0);
    CHECK(turned.distance == test::near(4.5f));
    CHECK(glm::length(scene.position()) == test::near(4.5f));
    scene.world.resource<Input>().look.y = 1e6f;
    scene.step();
    CHECK(scene.world.get<OrbitCamera>(scene.camera).elevation < kPi / 2);
    scene.world.get<Camera>(scene.camera).active = false;
    const OrbitCamera before = scene.world.get<OrbitCamera>(scene.camera);
    scene.step();
    CHECK(scene.world.get<OrbitCamera>(scene.camera).azimuth == before.azimuth);
}

}  // namespace limn::orbit_camera_test

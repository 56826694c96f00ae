// A camera that follows somebody among other people.

#include "ecs/base/rng.h"
#include "systems/characters/view_bodies.h"
#include "systems/orbit_camera_system.h"
#include "tests/near.h"
#include "tests/systems/hero_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn::view_bodies_test {

using namespace limn::test;

namespace {

constexpr float kClearance = 0.22f;
constexpr Vec3 kHead = {0, 1.5f, 0};

/// A column of joints, from the ground to `height`.
JointPlaces make_column(const Vec3& feet, float height = 1.6f) {
    JointPlaces joints;
    for (int i = 0; i <= 16; ++i) {
        joints.push_back(feet + Vec3(0, height * static_cast<float>(i) / 16, 0));
    }
    return joints;
}

/// Distance of a point to the nearest joint.
float nearest_joint(std::span<const JointPlaces> bodies, const Vec3& point) {
    float nearest = 1e6f;
    for (const JointPlaces& joints : bodies) {
        for (const Vec3& joint : joints) {
            nearest = std::min(nearest, glm::distance(joint, point));
        }
    }
    return nearest;
}

/// Distance of a segment to the nearest joint, by points along it.
float nearest_on_way(std::span<const JointPlaces> bodies, const Vec3& from, const Vec3& to) {
    float nearest = 1e6f;
    for (int i = 0; i <= 400; ++i) {
        const float u = static_cast<float>(i) / 400;
        nearest = std::min(nearest, nearest_joint(bodies, from + u * (to - from)));
    }
    return nearest;
}

/// A hero who is followed by a camera 4.2 m behind, and others.
struct FollowStage : PoseStage {
    Entity camera;
    std::vector<Entity> others;

    explicit FollowStage(float elevation) {
        camera = world.create(
            Transform{}, Camera{},
            OrbitCamera{
                .target = person,
                .offset = {0, 1.5f, 0},
                .azimuth = kPi,
                .elevation = elevation,
                .distance = 4.2f,
                .follow = 0.3f,
                .turns = false,
                .clearance = kClearance});
    }
    void add_other(const Vec3& at) {
        others.push_back(world.create(Transform{.position = at}, Skeleton{{0}}));
    }
    [[nodiscard]] Vec3 eye() { return world.get<const Transform>(camera).position; }
    [[nodiscard]] Vec3 point() { return feet() + kHead; }
    [[nodiscard]] std::vector<JointPlaces> bodies() {
        std::vector<JointPlaces> found;
        for (const Entity other : others) {
            JointPlaces joints;
            for (const Affine& joint : world.get<const Pose>(other).joints) {
                joints.push_back(transform_point(
                    world.get<const WorldTransform>(other).world, transform_point(joint, Vec3(0))));
            }
            found.push_back(joints);
        }
        return found;
    }
};

}  // namespace

TEST_CASE("view bodies: nobody about, and nobody between, changes nothing") {
    const Vec3 wanted = {0, 1.8f, -4};
    CHECK(look_over_bodies({}, kHead, wanted, kClearance) == wanted);
    CHECK(keep_off_bodies({}, kHead, wanted, kClearance) == wanted);
    const std::vector<JointPlaces> aside = {
        make_column({1.2f, 0, -2}), make_column({0, 0, 1.5f}), make_column({0, 0, -5.2f})};
    CHECK(look_over_bodies(aside, kHead, wanted, kClearance) == wanted);
    CHECK(keep_off_bodies(aside, kHead, wanted, kClearance) == wanted);
    CHECK(look_over_bodies(aside, kHead, kHead, kClearance) == kHead);
    CHECK(keep_off_bodies(aside, kHead, kHead, kClearance) == kHead);
    // Above a child it sees enough.
    const std::array<JointPlaces, 1> child = {make_column({0, 0, -2}, 0.9f)};
    CHECK(look_over_bodies(child, kHead, wanted, kClearance) == wanted);
}

TEST_CASE("view bodies: whoever is between is looked over, from as far") {
    for (const float far : {1.0f, 1.6f, 2.4f, 3.6f}) {
        for (const float elevation : {-0.1f, 0.0f, 0.16f}) {
            const std::array<JointPlaces, 1> other = {make_column({0.1f, 0, -far})};
            const Vec3 wanted = kHead + 4.2f * Vec3(0, std::sin(elevation), -std::cos(elevation));
            const Vec3 found = look_over_bodies(other, kHead, wanted, kClearance);
            CHECK(double(glm::distance(found, kHead)) == near(4.2).epsilon(1e-5));
            CHECK(nearest_on_way(other, kHead, found) > kBodyRadius + 0.5f * kClearance);
            CHECK(found.x == 0);
            CHECK(found.y >= wanted.y);
            const std::array<JointPlaces, 1> mirrored = {make_column({-0.1f, 0, -far})};
            CHECK(look_over_bodies(mirrored, kHead, wanted, kClearance) == found);
        }
    }
}

TEST_CASE("view bodies: the camera rises and sinks without a jump as somebody walks through") {
    const Vec3 wanted = kHead + 4.2f * Vec3(0, 0, -1);
    for (const float far : {0.6f, 1.2f, 3.0f, 4.2f}) {
        float fastest = 0;
        float highest = 0;
        Vec3 last = wanted;
        for (int i = 0; i <= 300; ++i) {  // at 1.3 m/s
            const float x = 1.3f * static_cast<float>(i - 150) / 60;
            const std::array<JointPlaces, 1> other = {make_column({x, 0, -far})};
            const Vec3 found = look_over_bodies(other, kHead, wanted, kClearance);
            fastest = std::max(fastest, glm::distance(found, last));
            highest = std::max(highest, found.y);
            last = found;
        }
        CHECK(last == wanted);
        CHECK(highest > wanted.y + 0.2f);
        CHECK(fastest < 0.17f);
    }
    float fastest = 0;
    Vec3 last = wanted;
    for (int i = 0; i <= 300; ++i) {  // likewise along the way
        const float z = 1.3f * static_cast<float>(i) / 60;
        const std::array<JointPlaces, 1> other = {make_column({0, 0, -z})};
        const Vec3 found = look_over_bodies(other, kHead, wanted, kClearance);
        fastest = std::max(fastest, glm::distance(found, last));
        last = found;
    }
    CHECK(last == wanted);
    CHECK(fastest < 0.3f);
}

TEST_CASE("view bodies: in a throng it stops at the first place that is free of all") {
    Random random(45, 1, 0, 0);
    int moved = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<JointPlaces> throng;
        for (int k = 0; k < 30; ++k) {
            throng.push_back(make_column({random.uniform(-3, 3), 0, random.uniform(-3, 3)}));
        }
        const Vec3 camera =
            kHead + Vec3(random.uniform(-3, 3), random.uniform(-0.5f, 0.6f), random.uniform(-3, 3));
        const Vec3 found = keep_off_bodies(throng, kHead, camera, kClearance);
        const float radius = kBodyRadius + kClearance;
        for (JointPlaces& joints : throng) {
            std::erase_if(
                joints, [&](const Vec3& joint) { return glm::distance(joint, kHead) <= radius; });
        }
        CHECK(nearest_joint(throng, found) > radius - 1e-3f);
        const Vec3 way = camera - kHead;
        CHECK(glm::length(glm::cross(found - kHead, way)) <= 1e-4f * glm::length(way));
        // No place that is farther is free.
        const float share = glm::distance(found, kHead) / glm::length(way);
        for (int k = 0; k < 200; ++k) {
            const float u = share + (1 - share) * (static_cast<float>(k) + 0.5f) / 200;
            CHECK((found == camera || nearest_joint(throng, kHead + u * way) < radius + 1e-3f));
        }
        moved += found == camera ? 0 : 1;
    }
    CHECK(moved > 60);
    CHECK(moved < 280);
}

TEST_CASE("follow camera: people who walk through it neither hide the hero nor are entered") {
    for (const float elevation : {0.0f, 0.16f}) {
        FollowStage stage(elevation);
        for (int i = 0; i < 12; ++i) {
            stage.add_other(
                {-8.0f - static_cast<float>(i), 0, -0.8f - 0.35f * static_cast<float>(i)});
        }
        stage.step(30);
        const Vec3 rest = stage.eye();
        CHECK(double(glm::distance(rest, stage.point())) == near(4.2).epsilon(1e-3));
        int hidden = 0;
        int raised = 0;
        float fastest = 0;
        for (int i = 0; i < 1000; ++i) {
            for (const Entity other : stage.others) {
                stage.world.get<Transform>(other).position.x += 1.3f / 60;
            }
            const Vec3 before = stage.eye();
            stage.step();
            const std::vector<JointPlaces> bodies = stage.bodies();
            CHECK(nearest_joint(bodies, stage.eye()) > kBodyRadius + kClearance - 1e-3f);
            hidden += nearest_on_way(bodies, stage.point(), stage.eye()) < kBodyRadius ? 1 : 0;
            raised += stage.eye().y > rest.y + 0.1f ? 1 : 0;
            fastest = std::max(fastest, glm::distance(before, stage.eye()));
        }
        CHECK(raised > 60);
        CHECK(hidden <= 20);  // of 1000 steps
        CHECK(fastest < 0.3f);
        CHECK(glm::distance(stage.eye(), rest) < 0.01f);
    }
}

TEST_CASE("follow camera: one that lags far behind passes nobody on its way either") {
    FollowStage stage(0);
    stage.world.get<OrbitCamera>(stage.camera).follow = 0.02f;
    stage.add_other({0, 0, 1});
    stage.step(2);
    stage.world.get<Transform>(stage.person).position.z += 10;
    float nearest = 1e6f;
    for (int i = 0; i < 240; ++i) {
        stage.step();
        nearest = std::min(nearest, nearest_joint(stage.bodies(), stage.eye()));
    }
    CHECK(nearest > kBodyRadius + kClearance - 1e-3f);
    CHECK(stage.eye().z > 5);
}

TEST_CASE("follow camera: without a clearance it passes through people") {
    FollowStage stage(0);
    stage.world.get<OrbitCamera>(stage.camera).clearance = 0;
    stage.add_other({0, 0, -4.2f});
    stage.step(60);
    CHECK(double(stage.eye().z) == near(-4.2).epsilon(1e-3));
    CHECK(double(stage.eye().y) == near(1.5).epsilon(1e-3));
}

}  // namespace limn::view_bodies_test

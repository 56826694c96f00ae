#include "ecs/components/all.h"
#include "ecs/components/bend_shapes.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/driven_shapes_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace limn::driven_shapes_test {

using test::make_chain;
using test::near;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// One vertex. Two targets move it along x and y, target 2 by z halfway of the first, target 3 by
/// -z where both are whole.
MeshData make_point() {
    MeshData mesh;
    mesh.positions = {Vec3(0)};
    for (const Vec3& offset : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
        mesh.morphs.push_back({"", "", {0}, {offset}, {}, {}});
    }
    mesh.morphs[2].drivers = {{0, 0.5f}};
    mesh.morphs[3].drivers = {{0, 1}, {1, 1}};
    return mesh;
}

struct Face {
    World world;
    Schedule schedule = make_world_schedule();
    Entity entity;

    explicit Face(MorphWeights weights, std::uint32_t first_morph = 0) {
        Assets assets;
        assets.meshes.push_back(make_point());
        world.insert_resource(std::move(assets));
        entity = world.create(Transform{}, MeshInstance{MeshId{0}, {}}, std::move(weights));
        world.add(entity, Deformed{entity, {}, first_morph});
        step_world(world, schedule);
    }
    std::vector<float>& weights() { return world.get<MorphWeights>(entity).weights; }
    Vec3 point() {
        std::vector<Vec3> positions;
        const bool finite = deform_positions(
            world.resource<Assets>().meshes[0], world.get<const Deformed>(entity), nullptr, nullptr,
            &world.get<const MorphWeights>(entity), nullptr, positions);
        REQUIRE(finite);
        return positions[0];
    }
};

}  // namespace

TEST_CASE("driven shapes: an in-between is a tent, 0 at both ends and 1 at its peak") {
    for (const float peak : {0.25f, 0.5f, 0.8f}) {
        const ShapeDriver driver = {0, peak};
        const auto at = [&](float weight) {
            return driven_weight(std::span(&driver, 1), std::span(&weight, 1));
        };
        CHECK(at(0) == 0);
        CHECK(at(1) == 0);
        CHECK(at(peak) == near(1));
        CHECK(at(0.5f * peak) == near(0.5));
        CHECK(at(0.5f * (1 + peak)) == near(0.5));
        CHECK(at(-1) == 0);
        CHECK(at(2) == 0);
    }
}

TEST_CASE("driven shapes: a corrective is the product of its drivers, none beyond 0 to 1") {
    const std::vector<ShapeDriver> drivers = {{0, 1}, {2, 1}};
    CHECK(driven_weight(drivers, std::vector<float>{0.5f, 9, 0.25f}) == near(0.125));
    CHECK(driven_weight(drivers, std::vector<float>{3, 9, 2}) == 1);
    CHECK(driven_weight(drivers, std::vector<float>{-1, 9, -1}) == 0);
    CHECK(driven_weight(drivers, std::vector<float>{1, 9, 0}) == 0);
}

TEST_CASE("driven shapes: a weight that is missing or NaN drives nothing") {
    const std::vector<ShapeDriver> drivers = {{0, 1}, {2, 0.5f}};
    CHECK(driven_weight(drivers, std::vector<float>{1, 1}) == 0);
    CHECK(driven_weight(drivers, std::vector<float>{kNaN, 0, 0.5f}) == 0);
    CHECK(driven_weight(drivers, std::vector<float>{1, 0, kNaN}) == 0);
}

TEST_CASE("driven shapes: each step a mesh follows its drivers, whatever was set") {
    Face face(MorphWeights{{0.5f, 0, 9, 9}, {}});
    CHECK(face.point() == Vec3(0.5f, 0, 1));  // the in-between to the bit
    face.weights() = {1, 0.5f, 9, 9};
    step_world(face.world, face.schedule);
    CHECK(face.point() == Vec3(1, 0.5f, -0.5f));
    face.weights() = {0, 1, 9, 9};
    step_world(face.world, face.schedule);
    CHECK(face.point() == Vec3(0, 1, 0));
}

TEST_CASE("driven shapes: the previous step has the weights that its drivers had") {
    Face face(MorphWeights{{1, 1, 0, 0}, {0.5f, 0.5f, 0, 0}});
    CHECK(face.weights() == std::vector<float>{1, 1, 0, 1});
    CHECK(
        face.world.get<const MorphWeights>(face.entity).previous
        == std::vector<float>{0.5f, 0.5f, 1, 0.25f});
}

TEST_CASE("driven shapes: drivers count from the mesh's first weight, and short lists are kept") {
    Face second(MorphWeights{{7, 7, 0.5f, 0, 0, 0}, {}}, 2);
    CHECK(second.weights() == std::vector<float>{7, 7, 0.5f, 0, 1, 0});
    Face cut(MorphWeights{{0.5f, 1, 0}, {}});
    CHECK(cut.weights() == std::vector<float>{0.5f, 1, 1});
    Face beyond(MorphWeights{{0.5f}, {}}, 4);
    CHECK(beyond.weights() == std::vector<float>{0.5f});
}

TEST_CASE(
    "driven shapes: a bend shape follows its joint, to one side, whatever the body does"
    * technique("char.skin-defects")) {
    SkeletonData skeleton = make_chain(3);
    skeleton.freedoms = {{.joint = 2, .axis = {1, 0, 0}, .min = -2.5f, .max = 0.1f}};
    for (const float angle : {-2.6f, -2.0944f, -1.2f, -0.5f, 0.0f, 0.4f}) {
        CAPTURE(angle);
        Assets assets;
        assets.skeletons.push_back(skeleton);
        assets.skeletons[0].rest.rotations[1] = rotation_about({1, 2, 3}, 0.7f);
        assets.skeletons[0].rest.rotations[2] = rotation_about({0, 0, 1}, 0.4f);
        assets.meshes.push_back(make_point());
        assets.meshes[0].morphs[0].name = "bend joint 2";
        assets.meshes[0].morphs[1].name = "bend no such joint";
        ClipData clip;
        ClipSheet sheet;
        sheet.times = {0};
        sheet.rotating = {1, 2};
        sheet.rotations = {
            rotation_about({0, 1, 0}, 1.1f),
            rotation_about({0, 0, 1}, 0.4f) * rotation_about({1, 0, 0}, angle)};
        clip.sheets.push_back(sheet);
        assets.clips.push_back(clip);
        World world;
        Schedule schedule = make_world_schedule();
        world.insert_resource(std::move(assets));
        const Entity body = world.create(
            Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}}, MeshInstance{MeshId{0}, {}});
        world.add(body, Deformed{body, {}, 0});
        step_world(world, schedule);
        const std::vector<float>& weights = world.get<const MorphWeights>(body).weights;
        const float full = -2.0944f;
        const double wanted = angle >= 0 ? 0.0 : 1 / std::cos(0.5 * std::max(angle, full)) - 1;
        CHECK(weights[0] == near(wanted).epsilon(1e-3));
        CHECK(weights[1] == 0);
    }
}

TEST_CASE(
    "driven shapes: a bend shape may follow another axis of its joint, named by its number"
    * technique("char.skin-defects")) {
    CHECK(parse_bend_name("bend joint 2").joint == "joint 2");
    CHECK(parse_bend_name("bend joint 2").axis == 0);
    CHECK(parse_bend_name("bend joint 2 axis 3").joint == "joint 2");
    CHECK(parse_bend_name("bend joint 2 axis 3").axis == 2);
    CHECK(parse_bend_name("bend axis 0").joint == "axis 0");
    SkeletonData skeleton = make_chain(3);
    skeleton.freedoms = {
        {.joint = 1, .axis = {0, 1, 0}, .min = -0.1f, .max = 1},
        {.joint = 2, .axis = {1, 0, 0}, .min = -2.5f, .max = 0.1f},
        {.joint = 2, .axis = {0, 0, 1}, .min = -0.5f, .max = 2}};
    const auto turned = [](const Quat& q) {
        const Mat3 m = glm::mat3_cast(q);
        Affine place;
        for (int r = 0; r < 3; ++r) {
            place.row[r] = Vec4(m[0][r], m[1][r], m[2][r], 0);
        }
        return place;
    };
    const Quat bent = rotation_about({0, 0, 1}, 0.8f);
    const Affine joints[] = {turned(Quat(1, 0, 0, 0)), turned(bent), turned(bent * bent)};
    CHECK(joint_bend(skeleton, joints, 2) == near(0.0).scale(1));
    CHECK(joint_bend(skeleton, joints, 2, 1) == near(0.8).epsilon(1e-4));
    CHECK(joint_bend(skeleton, joints, 2, 2) == 0);
    CHECK(joint_bend(skeleton, joints, 1, 2) == 0);  // not the next joint's
}

}  // namespace limn::driven_shapes_test

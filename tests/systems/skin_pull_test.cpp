#include "ecs/base/rotation.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/animation/deform_mesh.h"
#include "systems/faces/skin_pull_system.h"
#include "systems/faces/wrinkle_measure.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace limn::skin_pull_test {
namespace {

using test::near;

/// A square of skin in the plane z = 0 around the origin, that faces +z; `half` of its side [m].
MeshData make_skin(int cells, float half) {
    MeshData mesh;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const Vec2 at = 2.0f * Vec2(i, j) / static_cast<float>(cells) - 1.0f;
            mesh.positions.emplace_back(half * at.x, half * at.y, 0);
            mesh.normals.emplace_back(0, 0, 1);
            grow(mesh.bounds, mesh.positions.back());
        }
    }
    for (std::uint32_t j = 0; j + 1 < side; ++j) {
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t a = j * side + i;
            mesh.indices.insert(
                mesh.indices.end(), {a, a + 1, a + side, a + 1, a + side + 1, a + side});
        }
    }
    return mesh;
}

/// Skin rotated by one joint, an eye in front of it, and a pointer.
struct PullScene {
    World world;
    Schedule schedule = make_world_schedule();
    Entity face;
    Vec3 eye{0, 0, 0.6f};

    explicit PullScene(const PullableSkin& skin, float step = 1.0f / 60, const Affine& joint = {}) {
        Assets assets;
        assets.meshes.push_back(make_skin(8, 0.04f));
        MeshData& mesh = assets.meshes[0];
        for (std::uint32_t v = 0; v <= mesh.positions.size(); ++v) {
            mesh.skin.first.push_back(v);
        }
        mesh.skin.joints.assign(mesh.positions.size(), 0);
        mesh.skin.weights.assign(mesh.positions.size(), 1.0f);
        assets.skins.push_back({.name = "skin", .joints = {0}, .joint_from_mesh = {Affine{}}});
        world.insert_resource(std::move(assets));
        world.insert_resource(FrameTime{.step = step});
        face = world.create(
            Transform{}, MeshInstance{.mesh = {0}, .material = {}}, skin,
            Pose{.joints = {joint}, .previous = {joint}});
        world.add(face, Deformed{face, SkinId{0}});
        start_world(world);
    }
    /// Runs `seconds` with the pointer on a point; the left button held or not.
    void run(float seconds, const Vec3& at, bool held) {
        Input input;
        input.eye = eye;
        input.pointing = at - eye;
        if (held) {
            set_action(input, "pull_skin");
        }
        const float step = world.resource<FrameTime>().step;
        for (int i = 0; i < std::lround(seconds / step); ++i) {
            take_input(world.resource<Input>(), input);
            step_world(world, schedule);
        }
    }
    const std::vector<SkinPull>& pulls() { return world.get<SkinPulls>(face).pulls; }
    /// Vertices as they are drawn.
    std::vector<Vec3> drawn() {
        const Assets& assets = world.resource<Assets>();
        std::vector<Vec3> positions;
        REQUIRE(deform_positions(
            assets.meshes[0], world.get<Deformed>(face), &assets.skins[0], &world.get<Pose>(face),
            nullptr, &world.get<DeformerState>(face), positions));
        return positions;
    }
};

constexpr std::size_t kCenter = 40;  // of 9 x 9 vertices

/// Hardly limited, so that skin follows exactly.
constexpr PullableSkin kFree = {.radius = 0.03f, .reach = 100};

}  // namespace

TEST_CASE(
    "skin pull: a spring matches the closed form, in one step or many of any length"
    * technique("face.pull")) {
    const SpringState start = {{0.02f, -0.01f, 0.005f}, {0.3f, 0, -0.2f}};
    const Vec3 goal(0.001f, 0.002f, 0);
    const double rate = 14;
    const double time = 0.25;
    for (const int steps : {1, 6, 15, 60, 1000}) {
        SpringState spring = start;
        for (int i = 0; i < steps; ++i) {
            spring = spring_after(spring, goal, 14, static_cast<float>(time / steps));
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double from = double{start.offset[axis]} - double{goal[axis]};
            const double slope = double{start.velocity[axis]} + rate * from;
            const double left = std::exp(-rate * time);
            CHECK(
                spring.offset[axis]
                == near(double{goal[axis]} + left * (from + slope * time))
                       .epsilon(1e-5)
                       .scale(1e-2));
            CHECK(
                spring.velocity[axis]
                == near(left * (slope - rate * (from + slope * time))).epsilon(1e-5).scale(0.3));
        }
    }
    // From rest it never swings beyond its goal.
    SpringState spring = {{0.02f, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < 300; ++i) {
        const float before = spring.offset.x;
        spring = spring_after(spring, Vec3(0), 14, 1.0f / 60);
        CHECK(spring.offset.x >= 0.0f);
        CHECK(spring.offset.x < before);
    }
}

TEST_CASE("skin pull: pulls keep their direction and never exceed the limit") {
    const Vec3 direction = glm::normalize(Vec3(1, -2, 3));
    CHECK(glm::distance(limited_pull(1e-4f * direction, 0.02f), 1e-4f * direction) < 1e-8f);
    float last = 0;
    for (float length = 0.001f; length < 1; length *= 1.3f) {
        const Vec3 pull = limited_pull(length * direction, 0.02f);
        CHECK(glm::length(pull) <= 0.02f * 1.000001f);
        CHECK(glm::length(pull) >= last * 0.999999f);
        CHECK(glm::dot(pull, direction) == near(double{glm::length(pull)}));
        last = glm::length(pull);
    }
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    CHECK(limited_pull(Vec3(kNan, 0, 0), 0.02f) == Vec3(0));
    CHECK(limited_pull(Vec3(std::numeric_limits<float>::max()), 0.02f) == Vec3(0));
    CHECK(limited_pull(Vec3(1), 0) == Vec3(0));
}

TEST_CASE("skin pull: the nearest front face is grabbed, and no back face") {
    MeshData mesh = make_skin(2, 1);
    const std::size_t count = mesh.positions.size();
    for (std::size_t v = 0; v < count; ++v) {  // a second layer, farther
        mesh.positions.push_back(mesh.positions[v] - Vec3(0, 0, 1));
    }
    const std::size_t first = mesh.indices.size();
    for (std::size_t i = 0; i < first; ++i) {
        mesh.indices.push_back(mesh.indices[i] + static_cast<std::uint32_t>(count));
    }
    const Vec3 from(0.3f, 0.2f, 2);
    const auto hit = hit_skin(mesh.positions, mesh.indices, from, {0, 0, -2});
    REQUIRE(hit);
    CHECK(hit->distance == near(1));
    Vec3 point(0);
    for (std::uint32_t k = 0; k < 3; ++k) {
        point += hit->barycentric[static_cast<int>(k)]
                 * mesh.positions[mesh.indices[3 * hit->triangle + k]];
    }
    CHECK(glm::distance(point, Vec3(0.3f, 0.2f, 0)) < 1e-6f);
    CHECK_FALSE(hit_skin(mesh.positions, mesh.indices, {0.3f, 0.2f, -3}, {0, 0, 1}));
    CHECK_FALSE(hit_skin(mesh.positions, mesh.indices, {3, 0, 2}, {0, 0, -1}));
}

TEST_CASE(
    "skin pull: the point under the pointer follows it, whatever its joint does"
    * technique("face.pull")) {
    const Affine turned =
        affine_from({0.01f, 0.02f, -0.03f}, glm::angleAxis(0.5f, Vec3(0, 1, 0)), Vec3(1));
    for (const Affine& joint : {Affine{}, turned}) {
        PullScene scene(kFree, 1.0f / 60, joint);
        const Vec3 from = scene.drawn()[kCenter];
        const Vec3 to = from + Vec3(0.006f, -0.004f, 0);
        scene.run(0.05f, from, true);
        REQUIRE(scene.pulls().size() == 1);
        CHECK(glm::distance(scene.drawn()[kCenter], from) < 1e-6f);
        scene.run(1, to, true);
        // At the distance from the eye at which it was grabbed.
        const Vec3 expected =
            scene.eye + glm::distance(from, scene.eye) * glm::normalize(to - scene.eye);
        CHECK(glm::distance(scene.drawn()[kCenter], expected) < 1e-5f);
        CHECK(glm::distance(expected, to) < 2e-4f);
        // A corner is beyond the radius.
        PullScene rest(kFree, 1.0f / 60, joint);
        CHECK(scene.drawn()[0] == rest.drawn()[0]);
    }
}

TEST_CASE(
    "skin pull: released skin springs back, and is at rest to the bit" * technique("face.pull")) {
    PullScene scene(kFree);
    const std::vector<Vec3> rest = scene.drawn();
    scene.run(0.05f, {0, 0, 0}, true);
    scene.run(1, {0.006f, 0, 0}, true);
    const float pulled = glm::length(scene.pulls()[0].tug.offset);
    CHECK(pulled == near(0.006).epsilon(1e-2));
    scene.run(0.1f, {0.006f, 0, 0}, false);
    constexpr double time = 6 / 60.0;
    CHECK(
        glm::length(scene.pulls()[0].tug.offset)
        == near(double{pulled} * (1 + 14 * time) * std::exp(-14 * time)).epsilon(1e-3));
    scene.run(2, {0.006f, 0, 0}, false);
    CHECK(scene.pulls().empty());
    CHECK(scene.world.get<DeformerState>(scene.face).now.empty());
    CHECK(scene.drawn() == rest);
    // Pressing the button beside the skin grabs nothing, even if it then moves onto it.
    scene.run(0.1f, {0.2f, 0, 0}, true);
    scene.run(0.1f, {0, 0, 0}, true);
    CHECK(scene.pulls().empty());
}

TEST_CASE(
    "skin pull: steps of any length give the same pull, and the same input the same bits"
    * technique("face.pull")) {
    const auto offset_at = [](float step) {
        PullScene scene({}, step);
        scene.run(0.1f, {0, 0, 0}, true);
        scene.run(0.2f, {0.01f, 0.004f, 0}, true);
        scene.run(0.1f, {0.01f, 0.004f, 0}, false);
        return scene.pulls().at(0).tug.offset;
    };
    const Vec3 offset = offset_at(1.0f / 60);
    CHECK(glm::length(offset) > 2e-3f);
    CHECK(offset_at(1.0f / 60) == offset);
    for (const float step : {1.0f / 20, 1.0f / 120, 1.0f / 240}) {
        CHECK(glm::distance(offset_at(step), offset) < 1e-5f);
    }
}

TEST_CASE("skin pull: other deformers of the character follow it, and those of others do not") {
    PullScene scene(kFree);
    const auto add_brows = [&](Entity character) {
        const Entity entity = scene.world.create(
            MeshInstance{.mesh = {0}, .material = {}}, WorldTransform{}, Deformers{});
        scene.world.add(entity, Deformed{character, SkinId{0}});
        return entity;
    };
    const Entity brows = add_brows(scene.face);
    const Entity stranger = add_brows(scene.world.create());
    scene.run(0.05f, {0, 0, 0}, true);
    scene.run(0.1f, {0.01f, 0, 0}, true);
    const std::vector<Vec4> packed = scene.world.get<DeformerState>(scene.face).now;
    CHECK(packed.size() == 1 + kTugTexels);
    CHECK(scene.world.get<DeformerState>(brows).now == packed);
    CHECK(scene.world.get<DeformerState>(stranger).now.empty());
}

TEST_CASE("skin pull: beyond the maximum of a mesh the oldest pulls end, and NaN pulls nothing") {
    PullScene scene({.rate = 0.1f});  // slow: all are there at once
    for (std::size_t i = 0; i < kMaxSkinPulls + 3; ++i) {
        const float x = 0.004f * static_cast<float>(i) - 0.02f;
        scene.run(0.05f, {x, 0.01f, 0}, true);
        scene.run(0.1f, {x, 0.03f, 0}, true);
        scene.run(0.05f, {x, 0.03f, 0}, false);
    }
    CHECK(scene.pulls().size() == kMaxSkinPulls);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    scene.run(0.1f, {kNan, 0, 0}, false);
    scene.run(0.1f, {kNan, 0, 0}, true);
    scene.run(0.1f, {0, kNan, 0}, true);
    scene.run(0.1f, {0, 0, 0}, false);
    scene.run(0.1f, {0, 0, 0}, true);
    scene.run(0.1f, {kNan, 0, 0}, true);
    CHECK(scene.pulls().size() <= kMaxSkinPulls);
    for (const SkinPull& pull : scene.pulls()) {
        CHECK(is_finite(pull.tug.offset));
    }
}

TEST_CASE(
    "skin pull: skin wrinkles where it is compressed, and nowhere else" * technique("face.pull")) {
    constexpr double kRadius = 0.04;
    constexpr double kPull = 0.012;
    const MeshData mesh = make_skin(160, 0.05f);
    const std::vector<Vec3> across(mesh.positions.size(), Vec3(1, 0, 0));
    const WrinkleRest rest = make_wrinkle_rest(mesh.positions, mesh.indices, across);
    std::vector<Vec3> pulled = mesh.positions;
    const DeformerState state = {
        .now = pack_deformers({}, std::vector<Tug>{{.offset = {0.012f, 0, 0}, .radius = 0.04f}}),
        .previous = {}};
    Deformed by_itself;
    REQUIRE(deform_positions(mesh, by_itself, nullptr, nullptr, nullptr, &state, pulled));
    const std::vector<float> ratio = vertex_compression({&rest, 1}, pulled);
    int wrinkled = 0;
    for (std::size_t v = 0; v < ratio.size(); ++v) {
        const double x = double{mesh.positions[v].x} / kRadius;
        const double y = double{mesh.positions[v].y} / kRadius;
        const double left = std::max(1 - x * x - y * y, 0.0);
        // How the offset, kPull left^3, changes along x.
        const double stretch = 1 - 6 * kPull / kRadius * x * left * left;
        CHECK(std::sqrt(double{ratio[v]}) == near(stretch).epsilon(0.01));
        const float intensity = wrinkle_intensity(ratio[v], 1.05f, 4);
        if (intensity > 0.2f) {
            ++wrinkled;
            CHECK(x > 0);
            CHECK(left > 0);
        }
        if (x * x + y * y > 1.05) {
            CHECK(ratio[v] == near(1.0));
        }
    }
    CHECK(wrinkled > 500);
}

}  // namespace limn::skin_pull_test

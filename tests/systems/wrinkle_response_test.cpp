#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/faces/wrinkle_response_system.h"
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

namespace limn::wrinkle_response_test {
namespace {

using test::near;

constexpr int kSide = 9;  // vertices along each side of the skin

/// A square of 1 m, whose wrinkles run along x: they are raised by shortening along y.
MeshData make_skin() {
    MeshData mesh;
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            const Vec2 uv = Vec2(i, j) / static_cast<float>(kSide - 1);
            mesh.positions.emplace_back(uv.x - 0.5f, 0.5f - uv.y, 0);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.uvs.push_back(0.25f + 0.5f * uv);  // between the centers of texels
        }
    }
    for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
        for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
            const std::uint32_t a = j * kSide + i;
            const std::uint32_t b = a + kSide;
            if (2 * i + 1 < kSide) {
                mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
            } else {  // the mirror image
                mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        }
    }
    const std::size_t count = mesh.positions.size();
    mesh.regions = {
        {.name = "all",
         .weights = std::vector<float>(count, 1.0f),
         .across = std::vector<Vec3>(count, Vec3{0, 1, 0})}};
    return mesh;
}

/// left_brow is left of the central column of vertices, right_brow right of it, lips nowhere.
ImageData make_masks() {
    ImageData image;
    image.name = "masks";
    image.width = 9;
    image.height = 1;
    for (int x = 0; x < 9; ++x) {
        const std::uint8_t left = x < 4 ? 255 : 0;
        const std::uint8_t right = x > 4 ? 255 : 0;
        image.pixels.insert(image.pixels.end(), {left, right, 0, 0});
    }
    return image;
}

struct Face {
    World world;
    Entity entity;

    explicit Face(const WrinkleResponse& response = {.smoothing = 0, .lambda = 1, .beta = 4}) {
        Assets assets;
        assets.meshes.push_back(make_skin());
        assets.images.push_back(make_masks());
        world.insert_resource(std::move(assets));
        world.insert_resource(FrameTime{.step = 1.0f / 60});
        WrinkleMaps maps;
        maps.first_masks = {0};
        entity = world.create(response, maps, MeshInstance{.mesh = {0}, .material = {}});
        world.add(entity, Deformed{entity, {}});
        world.run(prepare_wrinkle_responses);
    }
    const MeshData& mesh() { return world.resource<Assets>().meshes[0]; }

    /// The weights for skin whose points are moved by f.
    template <typename F>
    WrinkleWeights weights(F f, const WrinkleWeights* animated = nullptr) {
        std::vector<Vec3> positions;
        for (const Vec3& p : mesh().positions) {
            positions.push_back(f(p));
        }
        return response_weights(
            world.get<WrinkleResponse>(entity), world.get<ResponseRest>(entity), positions,
            animated);
    }
};

Vec3 scaled(const Vec3& p, float x, float y) {
    return p * Vec3(x, y, 1);
}

TEST_CASE(
    "wrinkle response: at rest, stretched or moved rigidly, weights are zero"
    * technique("skin.pipeline")) {
    Face face({.smoothing = 0});
    const WrinkleWeights none = {};
    CHECK(face.weights([](const Vec3& p) { return p; }) == none);
    CHECK(face.weights([](const Vec3& p) { return scaled(p, 1.25f, 1.25f); }) == none);
    CHECK(face.weights([](const Vec3& p) { return Vec3(1 + p.z, p.x, p.y - 3); }) == none);
}

TEST_CASE(
    "wrinkle response: a fifth shorter across the wrinkles gives 0.712663, along them its negative"
    * technique("skin.pipeline")) {
    Face face;
    const WrinkleWeights across = face.weights([](const Vec3& p) { return scaled(p, 1, 0.8f); });
    CHECK(across.left_brow == near(0.712663).epsilon(1e-5));
    CHECK(across.right_brow == near(0.712663).epsilon(1e-5));
    CHECK(across.middle_brow == 0);  // its mask is empty
    CHECK(across.left_cheek == 0);   // it has no mask
    const WrinkleWeights along = face.weights([](const Vec3& p) { return scaled(p, 0.8f, 1); });
    CHECK(along.left_brow == near(-0.712663).epsilon(1e-5));
    // Both cancel.
    CHECK(
        face.weights([](const Vec3& p) { return scaled(p, 0.8f, 0.8f); }).left_brow
        == near(0).scale(1).epsilon(1e-6));
    CHECK(
        face.weights([](const Vec3& p) { return scaled(p, 1, 1.25f); }).left_brow
        == near(0).scale(1).epsilon(1e-6));
}

TEST_CASE(
    "wrinkle response: each region has its own half, and mirrored skin mirrored weights"
    * technique("skin.pipeline")) {
    Face face;
    const auto left_half = [](const Vec3& p) { return scaled(p, 1, p.x < 0 ? 0.8f : 1.0f); };
    const auto right_half = [](const Vec3& p) { return scaled(p, 1, p.x > 0 ? 0.8f : 1.0f); };
    const WrinkleWeights left = face.weights(left_half);
    const WrinkleWeights right = face.weights(right_half);
    CHECK(left.left_brow > 0.5f);
    CHECK(left.right_brow < 0.1f);
    CHECK(left.left_brow == near(right.right_brow).epsilon(1e-5));
}

TEST_CASE(
    "wrinkle response: more shortening never lowers a weight, which is 1 at most"
    * technique("skin.pipeline")) {
    Face face({.compressed_gain = 3, .smoothing = 0});
    float previous = 0;
    for (float length = 1; length > 0.2f; length -= 0.05f) {
        const float weight =
            face.weights([length](const Vec3& p) { return scaled(p, 1, length); }).left_brow;
        CHECK(weight >= previous);
        CHECK(weight <= 1);
        previous = weight;
    }
    CHECK(previous == 1);
}

TEST_CASE("wrinkle response: without gains weights are those of the animator, plus the bias") {
    Face face({.compressed_gain = 0, .stretched_gain = 0, .bias = 0.125f, .smoothing = 0});
    WrinkleWeights animated;
    animated.left_brow = -0.5f;
    animated.right_brow = 0.25f;
    animated.lips = std::numeric_limits<float>::quiet_NaN();
    animated.left_cheek = 10;
    const WrinkleWeights found =
        face.weights([](const Vec3& p) { return scaled(p, 1, 0.5f); }, &animated);
    CHECK(found.left_brow == -0.375f);
    CHECK(found.right_brow == 0.375f);
    CHECK(found.lips == 0.125f);  // NaN counts as nothing
    CHECK(found.left_cheek == 1);
}

TEST_CASE(
    "wrinkle response: a region of its own differs in gains, bias and smoothing, the others do not"
    * technique("skin.pipeline")) {
    const WrinkleResponse plain = {.smoothing = 0, .lambda = 1, .beta = 4};
    WrinkleResponse own = plain;
    own.regions = {
        {.region = WrinkleRegion::RightBrow, .compressed_gain = 0.5f, .bias = 0.125f},
        {.region = WrinkleRegion::Chin, .bias = -0.25f}};
    const auto pressed = [](const Vec3& p) { return scaled(p, 1, 0.8f); };
    const WrinkleWeights same = Face(plain).weights(pressed);
    const WrinkleWeights found = Face(own).weights(pressed);
    CHECK(found.left_brow == same.left_brow);
    CHECK(found.right_brow == near(0.5 * 0.712663 + 0.125).epsilon(1e-5));
    CHECK(found.chin == -0.25f);
}

TEST_CASE("wrinkle response: faces too far away to show wrinkles are not measured") {
    Face face;
    face.world.add(face.entity, MorphWeights{});
    face.world.add(face.entity, WrinkleRungs{.displaced = 0, .strain = 0, .maps = 0});
    face.world.get<MeasuredWrinkles>(face.entity).weights.left_brow = 0.5f;
    face.world.run(update_wrinkle_responses);
    CHECK(face.world.get<MeasuredWrinkles>(face.entity).weights.left_brow == 0.5f);
    face.world.get<WrinkleRungs>(face.entity).maps = 0.1f;
    face.world.run(update_wrinkle_responses);
    CHECK(face.world.get<MeasuredWrinkles>(face.entity).weights.left_brow == 0);
}

TEST_CASE("wrinkle response: positions that are not finite count as at rest") {
    Face face;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const WrinkleWeights found =
        face.weights([nan](const Vec3& p) { return p.y > 0.4f ? Vec3(nan) : scaled(p, 1, 0.8f); });
    CHECK_UNARY(std::isfinite(found.left_brow));
    CHECK(found.left_brow > 0.4f);
    CHECK(found.left_brow < 0.712663f);
}

TEST_CASE(
    "wrinkle response: weights move by 1 - exp(-dt / smoothing) a step, at first at once"
    * technique("skin.pipeline")) {
    Face face({.smoothing = 0.06f, .lambda = 1, .beta = 4});
    MorphTarget flat;
    flat.name = "flat";
    for (std::uint32_t v = 0; v < face.mesh().positions.size(); ++v) {
        flat.vertices.push_back(v);
        flat.positions.push_back(face.mesh().positions[v] * Vec3(0, -1, 0));
    }
    face.world.resource<Assets>().meshes[0].morphs.push_back(std::move(flat));
    face.world.add(face.entity, MorphWeights{.weights = {0}, .previous = {0}});
    face.world.run(update_wrinkle_responses);
    const auto weight = [&] {
        return face.world.get<MeasuredWrinkles>(face.entity).weights.left_brow;
    };
    CHECK(weight() == 0);
    face.world.get<MorphWeights>(face.entity).weights[0] = 0.2f;
    const double fraction = 1 - std::exp(-1 / (60 * 0.06));
    double expected = 0;
    for (int i = 0; i < 5; ++i) {
        face.world.run(update_wrinkle_responses);
        expected += fraction * (0.712663 - expected);
        CHECK(weight() == near(expected).epsilon(1e-4));
    }
    // A face that starts deformed is so from its first step.
    Face other({.smoothing = 0.06f, .lambda = 1, .beta = 4});
    other.world.resource<Assets>().meshes[0].morphs = face.mesh().morphs;
    other.world.add(other.entity, MorphWeights{.weights = {0.2f}, .previous = {0.2f}});
    other.world.run(update_wrinkle_responses);
    CHECK(
        other.world.get<MeasuredWrinkles>(other.entity).weights.left_brow
        == near(0.712663).epsilon(1e-4));
}

TEST_CASE("wrinkle response: meshes without directions, uvs or images measure nothing") {
    Face face;
    CHECK(face.world.find<MeasuredWrinkles>(face.entity) != nullptr);
    MeshData& mesh = face.world.resource<Assets>().meshes[0];
    mesh.regions[0].across.clear();
    ++mesh.version;
    face.world.run(prepare_wrinkle_responses);
    CHECK(face.world.find<MeasuredWrinkles>(face.entity) == nullptr);
    CHECK(face.world.find<ResponseRest>(face.entity) == nullptr);

    const Assets assets = [] {
        Assets bare;
        bare.meshes.push_back(make_skin());
        ImageData broken = make_masks();
        broken.pixels.resize(3);
        bare.images.push_back(std::move(broken));
        return bare;
    }();
    WrinkleMaps maps;
    maps.first_masks = {0};
    const ResponseRest rest =
        make_response_rest(maps, MeshInstance{.mesh = {0}, .material = {}}, assets);
    CHECK(rest.total[0] == 0);
    maps.first_masks = {7};
    CHECK(
        make_response_rest(maps, MeshInstance{.mesh = {0}, .material = {}}, assets).total[0] == 0);
    CHECK(make_response_rest(maps, MeshInstance{.mesh = {3}, .material = {}}, assets).source == 0);
}

}  // namespace
}  // namespace limn::wrinkle_response_test

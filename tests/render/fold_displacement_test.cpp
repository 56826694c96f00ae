// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/shadow.h"
#include "systems/faces/wrinkle_fold.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn::test::fold_displacement_test {
namespace {

constexpr int kFolds = 10;
constexpr int kRings = 160;
constexpr float kRadius = 0.5f;
constexpr float kHeight = 2;
constexpr float kLeft = 0.8f;  ///< fraction of the height at full compression

/// Folds of a sine around the tube, `kFolds` of them.
ImageData sine_map() {
    constexpr int kSize = 512;
    ImageData map = {.name = "sine", .width = 1, .height = kSize, .pixels = {}};
    for (int row = 0; row < kSize; ++row) {
        const float v = (static_cast<float>(row) + 0.5f) / kSize;
        const float slope = -std::cos(2 * kPi * kFolds * v);  // upwards, against v
        const float z = 1 / std::sqrt(1 + slope * slope);
        const auto byte = [](float n) {
            return static_cast<std::uint8_t>(128 + std::lround(127 * n));
        };
        map.pixels.insert(map.pixels.end(), {128, byte(-slope * z), byte(z), 255});
    }
    return map;
}

/// A tube around y, from -1 to 1, with a seam of doubled vertices, that a morph target shortens.
MeshData make_seamed_tube() {
    constexpr int kSectors = 32;
    MeshData mesh;
    mesh.name = "tube";
    for (int i = 0; i <= kRings; ++i) {
        const float v = static_cast<float>(i) / kRings;
        for (int j = 0; j <= kSectors; ++j) {
            const float phi = 2 * kPi * static_cast<float>(j % kSectors) / kSectors;
            const Vec3 n = {std::sin(phi), 0, std::cos(phi)};
            mesh.positions.push_back(kRadius * n + Vec3(0, kHeight * (0.5f - v), 0));
            mesh.normals.push_back(n);
            mesh.tangents.emplace_back(std::cos(phi), 0.0f, -std::sin(phi), 1.0f);
            mesh.uvs.emplace_back(static_cast<float>(j) / kSectors, v);
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(i * (kSectors + 1) + j);
    };
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kSectors; ++j) {
            mesh.indices.insert(
                mesh.indices.end(), {index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j),
                                     index(i + 1, j + 1), index(i, j + 1)});
        }
    }
    MorphTarget& flat = mesh.morphs.emplace_back();
    flat.name = "flat";
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        flat.vertices.push_back(v);
        flat.positions.push_back((kLeft - 1) * mesh.positions[v] * Vec3{0, 1, 0});
        grow(mesh.bounds, mesh.positions[v]);
    }
    return mesh;
}

struct FoldScene : WrinkleScene {
    FoldScene() {
        material.wrinkle_texture.image = add(sine_map());
        material.double_sided = true;
    }
    Entity tube(float displacement, float weight, float slack = 0) {
        return skin(
            make_seamed_tube(),
            {.slack = slack, .share = 1, .displacement = displacement, .displacement_until = 0},
            weight);
    }
    oracle::SkinReadbackVertices read(Entity entity) {
        Result<oracle::SkinReadback> readback = oracle::SkinReadback::create(device());
        REQUIRE(readback);
        return readback->run(world, std::vector<Entity>{entity})[0];
    }
    /// The same skin as a mesh at rest, with folds modeled by triangles.
    Entity carved(Entity entity) {
        const oracle::SkinReadbackVertices found = read(entity);
        MeshData mesh = mesh_of(entity);
        REQUIRE(found.folds.size() == mesh.positions.size());
        mesh.morphs.clear();
        mesh.bounds = {};
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            mesh.positions[v] = found.positions[v] + found.folds[v] * found.normals[v];
            grow(mesh.bounds, mesh.positions[v]);
        }
        return place(add(std::move(mesh)), add(Material{material}), {});
    }
};

/// The right edge of the tube in each row except those of its rims [px].
std::vector<int> outline(const gpu::FloatImage& depth) {
    std::vector<int> ends;
    for (int y = 130; y < depth.height - 130; ++y) {
        int end = 0;
        for (int x = 0; x < depth.width; ++x) {
            end = depth.at(x, y, 0) < kNoDepth ? x : end;
        }
        ends.push_back(end);
    }
    return ends;
}

int range_of(const std::vector<int>& ends) {
    const auto [low, high] = std::ranges::minmax(ends);
    return high - low;
}

}  // namespace

TEST_CASE_FIXTURE(
    FoldScene, "fold displacement: skin is displaced as high as folds that keep its length"
                   * technique("wrinkle.displacement")) {
    for (const float weight : {0.25f, 0.5f, 1.0f}) {
        const float left = 1 + weight * (kLeft - 1);
        const float excess = 1 / left - 1;
        const float wave = kHeight * left / kFolds;
        const float amplitude = wave / kPi * std::sqrt(excess * (1 + 0.75f * excess));
        for (const float displacement : {1.0f, 0.4f}) {
            const Entity entity = tube(displacement, weight);
            const oracle::SkinReadbackVertices found = read(entity);
            REQUIRE(found.folds.size() == found.positions.size());
            const auto [lowest, highest] = std::ranges::minmax(found.folds);
            CHECK(highest == near(displacement * amplitude).epsilon(0.03));
            CHECK(lowest == near(-displacement * amplitude).epsilon(0.03));
            world.destroy(entity);
        }
    }
}

TEST_CASE_FIXTURE(FoldScene, "fold displacement: the folded surface is as long as it was at rest") {
    const Entity entity = tube(1, 1);
    const oracle::SkinReadbackVertices found = read(entity);
    REQUIRE(found.folds.size() == found.positions.size());
    float length = 0;
    for (std::size_t v = 33; v < found.positions.size(); v += 33) {  // down the first column
        const auto at = [&](std::size_t i) {
            return found.positions[i] + found.folds[i] * found.normals[i];
        };
        length += glm::distance(at(v - 33), at(v));
    }
    CHECK(length == near(kHeight).epsilon(0.02));
}

TEST_CASE_FIXTURE(FoldScene, "fold displacement: vertices duplicated at a seam move together") {
    const Entity entity = tube(1, 1);
    const oracle::SkinReadbackVertices found = read(entity);
    REQUIRE(found.folds.size() == found.positions.size());
    for (std::size_t ring = 0; ring < found.folds.size(); ring += 33) {
        CHECK(found.folds[ring] == found.folds[ring + 32]);
        CHECK(found.normals[ring] == found.normals[ring + 32]);
    }
}

TEST_CASE_FIXTURE(
    FoldScene, "fold displacement: at rest it is bit-identical to no displacement"
                   * technique("wrinkle.displacement")) {
    shine(SpotLight{.intensity = 30, .radius = 20, .outer_angle = 0.8f}, at({0.4f, 0.3f, 4}));
    const RenderView front = look({0, 0, 1.6f}, {0, 0, 0}, 96, 96);
    for (const float weight : {0.0f, -0.5f}) {  // at rest and stretched
        Entity entity = tube(1, weight, 0.01f);
        const gpu::FloatImage with = radiance(front);
        CHECK(
            std::ranges::count(read(entity).folds, 0.0f) == std::ssize(mesh_of(entity).positions));
        world.destroy(entity);
        entity = tube(0, weight, 0.01f);
        CHECK(radiance(front).pixels == with.pixels);
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(
    FoldScene, "fold displacement: the outline folds by twice the amplitude in pixels"
                   * technique("wrinkle.displacement")) {
    const RenderView front = look({0, 0, 2}, {0, 0, 0}, 400, 400);
    const float excess = 1 / kLeft - 1;
    const float amplitude =
        kHeight * kLeft / kFolds / kPi * std::sqrt(excess * (1 + 0.75f * excess));
    // The tangent from the eye touches a tube of radius r at the angle asin(r / 2).
    const auto edge = [](float r) { return 200 * std::tan(std::asin(r / 2)); };
    const auto folded = static_cast<double>(edge(kRadius + amplitude) - edge(kRadius - amplitude));
    Entity entity = tube(1, 1);
    CHECK(range_of(outline(aov(front, "depth"))) == near(folded).epsilon(0.2));
    world.destroy(entity);
    entity = tube(0, 1);
    CHECK(range_of(outline(aov(front, "depth"))) == 0);
}

TEST_CASE_FIXTURE(
    FoldScene, "fold displacement: depth and shadow are those of folds made of triangles"
                   * technique("wrinkle.displacement")) {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0, 0, 0}});
    const Material matte = {
        .shading = ShadingModel::Blinn, .double_sided = true, .specular = {0, 0, 0}};
    place(
        add(make_square()), add(Material{matte}), affine_from({0, 0, -2}, {1, 0, 0, 0}, {4, 4, 1}));
    const Entity light =
        shine(SpotLight{.intensity = 60, .radius = 30, .outer_angle = 0.7f}, at({1.2f, 0.2f, 4}));
    world.add(light, Shadow{.method = ShadowMethod::Map, .resolution = 2048, .detail = 0});
    const RenderView front = look({-1.5f, 0, 2}, {-0.5f, 0, -1}, 256, 256);
    const Entity entity = tube(1, 1);
    const gpu::FloatImage depth = aov(front, "depth");
    const gpu::FloatImage lit = radiance(front);
    const Entity same = carved(entity);
    world.destroy(entity);
    CHECK(largest_difference(aov(front, "depth"), depth) < 2e-4f);
    const auto different = [&](const gpu::FloatImage& image) {
        int count = 0;
        for (int y = 0; y < 256; ++y) {
            for (int x = 0; x < 256; ++x) {  // of the wall behind
                const bool wall = depth.at(x, y, 0) < kNoDepth && depth.at(x, y, 0) > 3.0f;
                count += wall && std::abs(image.at(x, y, 0) - lit.at(x, y, 0)) > 0.02f ? 1 : 0;
            }
        }
        return count;
    };
    CHECK(different(radiance(front)) <= 4);
    world.destroy(same);
    tube(0, 1);
    CHECK(different(radiance(front)) > 100);
}

TEST_CASE_FIXTURE(FoldScene, "fold displacement: it fades out with distance, without a jump") {
    const Entity entity = tube(1, 1);
    const auto highest = [&](float until) {
        world.get<WrinkleSurface>(entity).displacement_until = until;
        return std::ranges::max(read(entity).folds);
    };
    // The camera is at the origin, the tube 3 m in front of it.
    world.get<WorldTransform>(entity).world = at({0, 0, -3});
    const float whole = highest(0);
    CHECK(whole > 0.02f);
    CHECK(highest(4) == whole);  // 3 < 0.8 * 4
    CHECK(highest(3) == 0);
    CHECK(highest(1) == 0);
    float before = 0;
    for (float until = 3; until <= 3.8f; until += 0.02f) {
        const float now = highest(until);
        CHECK(now >= before);
        CHECK(now - before < 0.1f * whole);
        before = now;
    }
    CHECK(before == near(whole).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    FoldScene, "fold displacement: methods that only shade or cover displace nothing") {
    const auto folds = [&](const WrinkleSurface& surface) {
        const Entity entity = skin(make_seamed_tube(), surface, 1);
        const std::size_t count = read(entity).folds.size();
        world.destroy(entity);
        return count > 0;
    };
    CHECK(folds({.method = WrinkleMethod::Bump, .displacement = 1}));
    CHECK(folds({.method = WrinkleMethod::Isometric, .displacement = 0.1f}));
    CHECK_FALSE(folds({.method = WrinkleMethod::Isometric}));
    CHECK_FALSE(folds({.method = WrinkleMethod::Alpha, .displacement = 1}));
    CHECK_FALSE(folds({.method = WrinkleMethod::Sphere, .displacement = 1}));
    CHECK_FALSE(folds({.method = WrinkleMethod::StrainView, .displacement = 1}));
    CHECK_FALSE(folds(
        {.method = WrinkleMethod::Bump,
         .second_turned = true,
         .combine = WrinkleCombine::Independent,
         .displacement = 1}));
    material.wrinkle_texture = {};
    CHECK_FALSE(folds({.method = WrinkleMethod::Isometric, .displacement = 1}));
}

}  // namespace limn::test::fold_displacement_test

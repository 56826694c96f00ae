#include "bench/oracles/light_oracle.h"
#include "ecs/components/rendering.h"
#include "render/light/bump_strategy.h"
#include "render/light/light_list.h"
#include "tests/near.h"
#include "tests/render/normal_images.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

// Light on bumps, and that which comes from behind the mesh.

namespace limn::test::bump_shadow_test {
namespace {

using DVec3 = glm::dvec3;

constexpr LightMethod kMethods[] = {
    LightMethod::Clustered, LightMethod::FullScreen, LightMethod::Volumes, LightMethod::ObjectMajor,
    LightMethod::LightMajor};

/// In the plane y = 0, at an angle from z [degrees].
Vec3 tilted(float angle) {
    return {std::sin(radians(angle)), 0, std::cos(radians(angle))};
}

/// A square in z = 0 of `quads` x `quads`.
MeshData make_floor(int quads) {
    MeshData mesh;
    for (int j = 0; j <= quads; ++j) {
        for (int i = 0; i <= quads; ++i) {
            const Vec2 at = Vec2(i, j) / static_cast<float>(quads);
            mesh.positions.emplace_back(2 * at.x - 1, 1 - 2 * at.y, 0);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.push_back(at);
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * (quads + 1) + i);
    };
    for (int j = 0; j < quads; ++j) {
        for (int i = 0; i < quads; ++i) {
            mesh.indices.insert(
                mesh.indices.end(), {index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i, j),
                                     index(i + 1, j + 1), index(i + 1, j)});
        }
    }
    mesh.bounds = {{-1, -1, 0}, {1, 1, 0}};
    return mesh;
}

struct BumpScene : Scene {
    MaterialId material = add(Material{});
    Entity surface = place(add(make_floor(1)), material, at({0, 0, 0}));
    Entity sun;

    gpu::FloatImage picture(const Material& m, int size = 16) {
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
        return radiance(look({0, 0, 1}, {0, 0, 0}, size, size));
    }
    /// The middle of the surface, lit by a sun in the direction of `to_light`.
    float lit_by(const Vec3& to_light, const Material& m) {
        if (sun != Entity{}) {
            world.destroy(sun);
        }
        sun = shine(DirectionalLight{.illuminance = 1}, look_at({0, 0, 0}, -to_light));
        return picture(m).at(8, 8, 0);
    }
    TextureSlot map_of(const std::vector<Vec3>& normals, int width = 1) {
        return {.image = add(image_of_normals(width, normals)), .nearest = true};
    }
    /// White, without highlights, its bumps all leaning the same way.
    Material matte(const Vec3& normal, BumpShadow shadow) {
        return {
            .shading = ShadingModel::Blinn,
            .base_color = {1, 1, 1, 1},
            .specular = {0, 0, 0},
            .bump_shadow = shadow,
            .normal_texture = map_of({normal})};
    }
};

/// The cosine to the mesh, and a normal whose cosine to the same light is `bumped`.
struct Case {
    float mesh;
    float bumped;
    Vec3 to_light = tilted(degrees(std::acos(mesh)));
    Vec3 normal = tilted(degrees(std::acos(mesh)) - degrees(std::acos(bumped)));
};

}  // namespace

TEST_CASE_FIXTURE(
    BumpScene, "bump shadow: light from behind the mesh does not reach a bump that faces it"
                   * technique("bump.self-shadow")) {
    for (const LightMethod method : kMethods) {
        world.insert_resource(Rendering{.lights = method});
        const float one = lit_by({0, 0, 1}, matte({0, 0, 1}, BumpShadow::Gate));
        CHECK(one > 0.1f);
        const auto gated = [&](const Case& c) {
            return lit_by(c.to_light, matte(c.normal, BumpShadow::Gate)) / one;
        };
        CHECK(gated({-0.1f, 0.5f}) == 0);
        CHECK(gated({0.1f, 0.5f}) == near(0.5).epsilon(2e-3));
        CHECK(gated({0.1f, -0.1f}) == 0);
        const Case behind = {-0.1f, 0.5f};
        CHECK(
            lit_by(behind.to_light, matte(behind.normal, BumpShadow::None)) / one
            == near(0.5).epsilon(2e-3));
    }
}

TEST_CASE_FIXTURE(
    BumpScene, "bump shadow: nor does it make highlights" * technique("bump.self-shadow")) {
    for (const ShadingModel model : {ShadingModel::Blinn, ShadingModel::Phong, ShadingModel::Pbr}) {
        const auto shiny = [&](const Vec3& normal, BumpShadow shadow) {
            Material m = matte(normal, shadow);
            m.shading = model;
            m.base_color = {0, 0, 0, 1};
            m.specular = {1, 1, 1};
            m.shininess = 3;
            m.roughness = 0.8f;
            return m;
        };
        const Case behind = {-0.1f, 0.5f};
        CHECK(lit_by(behind.to_light, shiny(behind.normal, BumpShadow::None)) > 1e-3f);
        CHECK(lit_by(behind.to_light, shiny(behind.normal, BumpShadow::Gate)) == 0);
        CHECK(lit_by(behind.to_light, shiny(behind.normal, BumpShadow::Smooth)) == 0);
        CHECK(lit_by(behind.to_light, shiny(behind.normal, BumpShadow::Ramp)) == 0);
        const Case away = {0.1f, -0.1f};
        CHECK(lit_by(away.to_light, shiny(away.normal, BumpShadow::Gate)) == 0);
    }
}

TEST_CASE_FIXTURE(
    BumpScene,
    "bump shadow: smooth, light is times the cosine to the mesh; as a ramp, times 8 of it"
        * technique("bump.self-shadow-smooth")) {
    for (const LightMethod method : kMethods) {
        world.insert_resource(Rendering{.lights = method});
        const float one = lit_by({0, 0, 1}, matte({0, 0, 1}, BumpShadow::Smooth));
        CHECK(one == lit_by({0, 0, 1}, matte({0, 0, 1}, BumpShadow::Gate)));
        const auto lit = [&](const Case& c, BumpShadow shadow) {
            return lit_by(c.to_light, matte(c.normal, shadow)) / one;
        };
        CHECK(lit({0.1f, 0.5f}, BumpShadow::Smooth) == near(0.05).epsilon(5e-3));
        CHECK(lit({-0.1f, 0.5f}, BumpShadow::Smooth) == 0);
        CHECK(lit({0.001f, 0.5f}, BumpShadow::Smooth) < 1e-3f);  // continuous at 0
        CHECK(lit({0.1f, 0.5f}, BumpShadow::Ramp) == near(0.4).epsilon(5e-3));
        CHECK(lit({0.2f, 0.5f}, BumpShadow::Ramp) == near(0.5).epsilon(5e-3));
        CHECK(lit({-0.001f, 0.5f}, BumpShadow::Ramp) == 0);
        // The price of the product: a flat map at 60 degrees is half as bright.
        CHECK(lit({0.5f, 0.5f}, BumpShadow::Smooth) == near(0.25).epsilon(5e-3));
        CHECK(lit({0.5f, 0.5f}, BumpShadow::Ramp) == near(0.5).epsilon(5e-3));
    }
}

TEST_CASE_FIXTURE(
    BumpScene, "bump shadow: where a surface emits light, its bumps are lit from behind, too"
                   * technique("bump.self-shadow")) {
    const Case behind = {-0.1f, 0.5f};
    Material glowing = matte(behind.normal, BumpShadow::Gate);
    glowing.emission = {1, 1, 1};
    Material plain = glowing;
    plain.bump_shadow = BumpShadow::None;
    const float lit = lit_by(behind.to_light, glowing);
    CHECK(lit > 1.01f);
    CHECK(lit == lit_by(behind.to_light, plain));
}

TEST_CASE_FIXTURE(
    BumpScene, "bump lighting: a pixel is that of the formula in double precision"
                   * technique("bump.per-fragment, bump.self-shadow")) {
    constexpr int kSide = 48;
    const std::vector<Vec3> bumps = {tilted(-50), {0, 0.6f, 0.8f}, {0, -0.6f, 0.8f}, tilted(50)};
    Material m = matte({0, 0, 1}, BumpShadow::Gate);
    m.base_color = {0.7f, 0.5f, 0.3f, 1};
    m.specular = {0.4f, 0.4f, 0.4f};
    m.shininess = 25;
    m.normal_texture = map_of(bumps, 2);
    m.normal_texture.scale = {6, 6};
    const PointLight lamp = {.intensity = 2, .radius = 0};
    const Vec3 lamp_at = {-0.9f, 0.1f, 0.12f};
    shine(lamp, at(lamp_at));
    const gpu::FloatImage found = picture(m, kSide);
    const oracle::ClassicMaterial coefficients = {
        .ambient = DVec3(0),
        .diffuse = DVec3(m.base_color),
        .specular = DVec3(m.specular),
        .shininess = m.shininess};
    double worst = 0;
    double largest = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const DVec3 point = {2 * (x + 0.5) / kSide - 1, 1 - 2 * (y + 0.5) / kSide, 0};
            const int column = static_cast<int>((point.x + 1) / 2 * 12) % 2;
            const int row = static_cast<int>((1 - point.y) / 2 * 12) % 2;
            const DVec3 normal(bumps[static_cast<std::size_t>(2 * row + column)]);
            const oracle::Arriving light =
                oracle::arrive(lamp, DVec3(lamp_at), point, DVec3(0, 0, 1));
            DVec3 expected(0);
            if (light.to_light.z > 0 && glm::dot(light.to_light, normal) > 0) {
                expected = oracle::blinn(
                    coefficients, DVec3(0), std::array{light}, normal,
                    glm::normalize(DVec3(0, 0, 1) - point));
            }
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(found.at(x, y, c) - expected[c]));
                largest = std::max(largest, expected[c]);
            }
        }
    }
    CHECK(largest > 0.1);
    CHECK(worst < 2e-3 * largest);
}

TEST_CASE_FIXTURE(
    BumpScene,
    "bump lighting: a flat map is Phong shading without one" * technique("bump.per-fragment")) {
    shine(PointLight{.intensity = 2, .radius = 0}, at({0.3f, 0.1f, 0.5f}));
    Material flat = matte({0, 0, 1}, BumpShadow::Gate);
    flat.specular = {0.4f, 0.4f, 0.4f};
    Material without = flat;
    without.normal_texture = {};
    without.bump_shadow = BumpShadow::None;
    CHECK(largest_difference(picture(flat), picture(without)) <= 1e-3f);
}

TEST_CASE_FIXTURE(
    BumpScene, "bump lighting: behind the mesh only the ambient light is left, exactly"
                   * technique("bump.per-fragment")) {
    world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {0.2f, 0.3f, 0.4f}, .visible = false});
    const Case behind = {-0.1f, 0.5f};
    const Material m = matte(behind.normal, BumpShadow::Gate);
    const gpu::FloatImage ambient = picture(m);
    CHECK(ambient.at(8, 8, 2) > 0.01f);
    lit_by(behind.to_light, m);
    CHECK(largest_difference(picture(m), ambient) == 0);
}

TEST_CASE_FIXTURE(
    BumpScene, "bump lighting: a floor of a hundred quads looks as one of a single quad"
                   * technique("bump.per-fragment")) {
    shine(PointLight{.intensity = 2, .radius = 0}, at({-0.4f, 0.1f, 0.3f}));
    Material m = matte({0, 0, 1}, BumpShadow::Gate);
    m.specular = {0.4f, 0.4f, 0.4f};
    m.normal_texture = map_of({tilted(-50), {0, 0.6f, 0.8f}, {0, -0.6f, 0.8f}, tilted(50)}, 2);
    const gpu::FloatImage one = picture(m, 32);
    world.find<MeshInstance>(surface)->mesh = add(make_floor(10));
    CHECK(largest_difference(picture(m, 32), one) < 1.0f / 255);
}

TEST_CASE_FIXTURE(
    BumpScene,
    "bump lighting: a scene of twice the size, its lamp four times as bright, looks the same"
        * technique("bump.per-fragment")) {
    Material m = matte({0, 0, 1}, BumpShadow::Gate);
    m.specular = {0.4f, 0.4f, 0.4f};
    m.normal_texture = map_of({tilted(-50), tilted(30)}, 2);
    const Entity lamp = shine(PointLight{.intensity = 2, .radius = 0}, at({-0.4f, 0.1f, 0.3f}));
    const gpu::FloatImage small = picture(m, 32);
    world.destroy(lamp);
    shine(PointLight{.intensity = 8, .radius = 0}, at({-0.8f, 0.2f, 0.6f}));
    *world.find<WorldTransform>(surface) = {affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(2))};
    const gpu::FloatImage large = radiance(look({0, 0, 2}, {0, 0, 0}, 32, 32));
    CHECK(largest_difference(large, small) < 1.0f / 255);
}

TEST_CASE(
    "bump strategy: a floor of two triangles is lit per pixel, a ball of ten thousand at vertices"
    * technique("bump.strategy")) {
    const float floor_edge = (2 + 2 + std::sqrt(8.0f)) / 3;
    CHECK(bump_strategy(floor_edge, 1) == BumpStrategy::Pixel);
    CHECK(bump_strategy(0.04f, 1) == BumpStrategy::Vertex);
    CHECK(bump_strategy(0.04f, 0.1f) == BumpStrategy::Pixel);
    CHECK(bump_strategy(0.25f, 1) == BumpStrategy::Vertex);
    CHECK(bump_strategy(100, INFINITY) == BumpStrategy::Vertex);  // lit from one direction

    const LightRange lamps[] = {{{0, 0, 3}, 10}, {{5, 1, 0}, 2}, {{-1.2f, 0, 0}, 0.1f}};
    CHECK(nearest_lamp(lamps, {0, 0, 0}, {1, 1, 1}) == 2);
    CHECK(nearest_lamp(lamps, {3, 0, 0}, {1, 1, 1}) == 1);
    CHECK(nearest_lamp(lamps, {0, 0, 3}, {1, 1, 1}) == 0);
    CHECK(nearest_lamp(lamps, {0, 99, 0}, {1, 1, 1}) == INFINITY);
}

TEST_CASE_FIXTURE(
    BumpScene, "bump strategy: each mesh is drawn as the rule says" * technique("bump.strategy")) {
    Material m = matte({0, 0, 1}, BumpShadow::None);
    m.specular = {0.5f, 0.5f, 0.5f};
    m.normal_texture = map_of({tilted(-20), tilted(20)}, 2);
    shine(PointLight{.intensity = 2, .radius = 0}, at({0.3f, 0.2f, 1.4f}));
    const auto with = [&](ShadingRate rate) {
        world.insert_resource(Rendering{.lights = LightMethod::ObjectMajor, .shading = rate});
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
        return radiance(look({0, 0, 2}, {0, 0, 0}, 32, 32));
    };
    const auto distance = [&](ShadingRate rate) {
        return largest_difference(with(ShadingRate::BumpAuto), with(rate));
    };
    CHECK(distance(ShadingRate::Pixel) == 0);  // a coarse floor
    CHECK(distance(ShadingRate::BumpVertex) > 1e-3f);
    world.find<MeshInstance>(surface)->mesh = add(make_ball(50));
    CHECK(distance(ShadingRate::BumpVertex) == 0);
    CHECK(distance(ShadingRate::Pixel) > 0);
    m.shading = ShadingModel::Pbr;  // which has no other way
    CHECK(distance(ShadingRate::Pixel) == 0);
}

TEST_CASE_FIXTURE(
    BumpScene, "bump strategy: the nearest lamp and the largest object of a mesh decide"
                   * technique("bump.strategy")) {
    Material m = matte({0, 0, 1}, BumpShadow::None);
    m.specular = {0.5f, 0.5f, 0.5f};
    m.normal_texture = map_of({tilted(-20), tilted(20)}, 2);
    // Edges of 0.2 and 0.28 m, on average below kCoarseEdge of a lamp 1 m away.
    world.find<MeshInstance>(surface)->mesh = add(make_floor(10));
    const auto with = [&](ShadingRate rate) {
        world.insert_resource(Rendering{.lights = LightMethod::ObjectMajor, .shading = rate});
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
        return radiance(look({0, 0, 2}, {0, 0, 0}, 32, 32));
    };
    const auto is_drawn = [&](ShadingRate expected, ShadingRate other) {
        const gpu::FloatImage found = with(ShadingRate::BumpAuto);
        CHECK(largest_difference(found, with(expected)) == 0);
        CHECK(largest_difference(found, with(other)) > 0);
    };
    const Entity lamp = shine(PointLight{.intensity = 2, .radius = 0}, at({0.3f, 0.2f, 1.1f}));
    is_drawn(ShadingRate::BumpVertex, ShadingRate::Pixel);
    *world.find<WorldTransform>(lamp) = {at({0.3f, 0.2f, 0.7f})};
    is_drawn(ShadingRate::Pixel, ShadingRate::BumpVertex);
    *world.find<WorldTransform>(lamp) = {at({0.3f, 0.2f, 1.1f})};
    is_drawn(ShadingRate::BumpVertex, ShadingRate::Pixel);

    // One that does not reach it counts for nothing.
    const Entity weak = shine(PointLight{.intensity = 2, .radius = 0.2f}, at({0.3f, 0.2f, 0.3f}));
    is_drawn(ShadingRate::BumpVertex, ShadingRate::Pixel);
    world.get<PointLight>(weak).radius = 0.4f;
    is_drawn(ShadingRate::Pixel, ShadingRate::BumpVertex);
    world.destroy(weak);

    // A second object of the mesh, of thrice the size, has edges of 0.7 m.
    const MeshId mesh = world.find<MeshInstance>(surface)->mesh;
    const Entity large = place(mesh, material, affine_from({0, 0, -0.1f}, {1, 0, 0, 0}, Vec3(3)));
    is_drawn(ShadingRate::Pixel, ShadingRate::BumpVertex);
    world.destroy(large);
    is_drawn(ShadingRate::BumpVertex, ShadingRate::Pixel);
}

}  // namespace limn::test::bump_shadow_test

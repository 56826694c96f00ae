#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace limn::test::wrinkle_tier_test {
namespace {

struct TierScene : WrinkleScene {
    TierScene() { shine(DirectionalLight{}, look_at({1, 2, 3}, {0, 0, 0})); }

    /// Normal of the square with these tangents, shortened to 0.8; none: without tangents.
    Entity square_with(const WrinkleSurface& surface, const std::vector<Vec4>& tangents) {
        MeshData mesh = make_square();
        mesh.tangents = tangents;
        MorphTarget& flat = mesh.morphs.emplace_back();
        flat.name = "flat";
        for (std::uint32_t v = 0; v < 4; ++v) {
            flat.vertices.push_back(v);
            flat.positions.push_back(mesh.positions[v] * Vec3{0, -1, 0});
        }
        return skin(std::move(mesh), surface, 0.2f);
    }
    std::vector<float>
    pixels(const WrinkleSurface& surface, bool tangents = true, const std::string& of = "") {
        const Entity entity = square_with(
            surface, tangents ? std::vector<Vec4>(4, Vec4(1, 0, 0, 1)) : std::vector<Vec4>{});
        std::vector<float> result = of.empty() ? radiance(view).pixels : aov(view, of).pixels;
        world.destroy(entity);
        return result;
    }
    Vec3 normal_with(const Vec4& tangent) {
        const Entity entity = square_with(
            {.method = WrinkleMethod::Bump, .lambda = 0.1f, .beta = 50},
            std::vector<Vec4>(4, tangent));
        const Vec3 normal = rgb_at(aov(view, "normal"), 16, 16);
        world.destroy(entity);
        return normal;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    TierScene, "wrinkle tiers: without tangents every method with slopes is alpha"
                   * technique("wrinkle.compression.fallback")) {
    const std::vector<float> alpha = pixels({.method = WrinkleMethod::Alpha});
    const std::vector<float> none = pixels({.method = WrinkleMethod::None});
    CHECK(alpha != none);
    for (const WrinkleMethod method :
         {WrinkleMethod::Alpha, WrinkleMethod::Bump, WrinkleMethod::Sphere, WrinkleMethod::Blend}) {
        CHECK(pixels({.method = method}, false) == alpha);
    }
    CHECK(pixels({.method = WrinkleMethod::None}, false) == none);
    CHECK(pixels({.method = WrinkleMethod::Isometric}, false) != none);
}

TEST_CASE_FIXTURE(
    TierScene, "wrinkle tiers: with distance bump becomes alpha, then fades out"
                   * technique("wrinkle.compression.fallback")) {
    // The square is at 1 m.
    WrinkleSurface surface = {.method = WrinkleMethod::Bump};
    const std::vector<float> bump = pixels(surface);
    surface.shade_from = 1.3f;
    CHECK(pixels(surface) == bump);
    surface.shade_from = 0.9f;
    CHECK(pixels(surface) == pixels({.method = WrinkleMethod::Alpha}));
    surface.none_from = 0.95f;
    CHECK(pixels(surface) == pixels({.method = WrinkleMethod::None}));
    for (const WrinkleMethod method : {WrinkleMethod::Directional, WrinkleMethod::Blend}) {
        CHECK(
            pixels({.method = method, .none_from = 0.9f})
            == pixels({.method = WrinkleMethod::None}));
    }
}

TEST_CASE_FIXTURE(
    TierScene, "wrinkle tiers: between two distances both are drawn in part"
                   * technique("wrinkle.compression.fallback")) {
    const WrinkleSurface surface = {
        .method = WrinkleMethod::Bump, .lambda = 1, .shade_from = 1 / 0.9f};  // halfway
    const float intensity = wrinkle_intensity(0.64f, 1, 4);
    const Entity entity = square_with(surface, std::vector<Vec4>(4, Vec4(1, 0, 0, 1)));
    const Vec3 normal = rgb_at(aov(view, "normal"), 16, 16);
    CHECK(normal.y / normal.z == near(0.5f * intensity * -map_slope().y).epsilon(4e-3));
    world.destroy(entity);
    // The same slopes without shade.
    const WrinkleSurface half = {.method = WrinkleMethod::Bump, .lambda = 1, .activation = 0.5f};
    const std::vector<float> darkened = pixels(surface);
    const std::vector<float> lit = pixels(half);
    const std::size_t center = darkened.size() / 2 + 16 * (darkened.size() / (32 * 32));
    const float shade = darkened[center] / lit[center];
    CHECK(shade == near(1 - 0.5f * intensity * -map_slope().y).epsilon(4e-3));
}

TEST_CASE_FIXTURE(
    TierScene, "wrinkle frame: slopes rotate and flip with the tangent, which is orthogonalized"
                   * technique("wrinkle.compression.tangent-frame")) {
    // Up the map the skin rises towards -y of texture space: the normal leans to the bitangent.
    const Vec3 upright = normal_with({1, 0, 0, 1});
    CHECK(upright.x == near(0).scale(1));
    CHECK(upright.y > 0.4f);
    CHECK(glm::length(upright) == near(1));
    const Vec3 flipped = normal_with({1, 0, 0, -1});  // the left-handed frame of the source
    CHECK(flipped.y == near(-upright.y).epsilon(1e-3));
    const Vec3 turned = normal_with({0, 1, 0, 1});
    CHECK(turned.x == near(-upright.y).epsilon(1e-3));
    CHECK(turned.y == near(0).scale(1).epsilon(1e-3));
    // Its part along the normal does not count.
    const Vec3 slanted = normal_with({0.8f, 0, 0.6f, 1});
    CHECK(glm::length(slanted - upright) < 1e-3f);
    const Vec3 oblique = normal_with(Vec4(glm::normalize(Vec3{1, 1, 1}), 1));
    CHECK(oblique.z == near(upright.z).epsilon(1e-3));
    CHECK(oblique.y == near(upright.y * std::sqrt(0.5f)).epsilon(2e-3));
    CHECK(oblique.x == near(-oblique.y).epsilon(2e-3));
}

}  // namespace limn::test::wrinkle_tier_test

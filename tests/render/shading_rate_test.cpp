#include "bench/oracles/light_oracle.h"
#include "ecs/components/rendering.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn::test::shading_rate_test {
namespace {

constexpr int kSide = 64;

/// A square of side 2 in z = 0 of n x n quads.
MeshData make_grid(int n) {
    MeshData mesh;
    mesh.name = "grid";
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) {
            const Vec2 uv = {
                static_cast<float>(x) / static_cast<float>(n),
                static_cast<float>(y) / static_cast<float>(n)};
            mesh.positions.emplace_back(2 * uv.x - 1, 2 * uv.y - 1, 0.0f);
            mesh.uvs.push_back(uv);
        }
    }
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const auto a = static_cast<std::uint32_t>(y * (n + 1) + x);
            const auto up = static_cast<std::uint32_t>(n + 1);
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + up + 1, a, a + up + 1, a + up});
        }
    }
    mesh.bounds = {{-1, -1, 0}, {1, 1, 0}};
    return mesh;
}

/// Eye and light half a meter above a shiny square, as light.gouraud has them.
class ShadingRates : public Scene {
  public:
    static constexpr Vec3 kDiffuse = {0.6f, 0.5f, 0.4f};
    static constexpr Vec3 kSpecular = {0.3f, 0.3f, 0.3f};
    MaterialId shiny = add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = Vec4(kDiffuse, 1),
        .specular = kSpecular,
        .shininess = 50});

    /// A light whose color is what arrives, whatever the distance.
    Entity lamp(const Vec3& position) {
        return shine(
            PointLight{.intensity = kPi, .radius = 1000, .attenuation = {.falloff = Falloff::None}},
            at(position));
    }
    gpu::FloatImage picture(ShadingRate rate, const RenderView& view, bool infinite = false) {
        world.insert_resource(Rendering{.shading = rate, .infinite_viewer = infinite});
        return radiance(view);
    }
    /// The square alone fills the image of 45 degrees to either side.
    [[nodiscard]] RenderView above() const { return look({0, 0, 0.5f}, {0, 0, 0}, kSide, kSide); }
};

Vec3 largest(const gpu::FloatImage& image) {
    Vec3 result(0);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            result = glm::max(result, rgb_at(image, x, y));
        }
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(
    ShadingRates,
    "gouraud: the center of a large quad shows kd / 3 where per-pixel shading shows kd + ks"
        * technique("light.gouraud, light.phong-pixel")) {
    place(add(make_square()), shiny, at({0, 0, 0}));
    lamp({0, 0, 0.5f});
    const gpu::FloatImage vertex = picture(ShadingRate::Vertex, above());
    const gpu::FloatImage pixel = picture(ShadingRate::Pixel, above());
    // N.L of the corners is 0.5 / sqrt(1 + 1 + 0.25).
    CHECK(glm::distance(rgb_at(vertex, 31, 31), kDiffuse / 3.0f) < 1e-4f);
    CHECK(glm::distance(rgb_at(pixel, 31, 31), kDiffuse + kSpecular) < 0.02f);
    // All corners are alike, and no color lies beyond those of the corners.
    CHECK(glm::distance(largest(vertex), kDiffuse / 3.0f) < 1e-4f);
}

TEST_CASE_FIXTURE(
    ShadingRates,
    "gouraud: finer quads converge to per-pixel lighting" * technique("light.gouraud")) {
    lamp({0, 0, 0.5f});
    lamp({0.6f, 0.5f, 0.4f});
    std::vector<MeshId> grids;
    for (const int n : {2, 4, 8, 16, 32, 64}) {
        grids.push_back(add(make_grid(n)));
    }
    const Entity square = place(grids[0], shiny, at({0, 0, 0}));
    const gpu::FloatImage pixel = picture(ShadingRate::Pixel, above());
    std::vector<float> errors;
    for (const MeshId grid : grids) {
        world.get<MeshInstance>(square).mesh = grid;
        errors.push_back(largest_difference(picture(ShadingRate::Vertex, above()), pixel));
    }
    // The first grids miss both highlights; from there on every split helps.
    for (std::size_t i = 2; i < errors.size(); ++i) {
        CHECK(errors[i] < errors[i - 1]);
    }
    CHECK(errors.back() < 0.02f);
}

TEST_CASE_FIXTURE(
    ShadingRates,
    "gouraud: no pixel is brighter than the brightest vertex" * technique("light.gouraud")) {
    place(add(make_grid(4)), shiny, at({0, 0, 0}));
    const Vec3 lamps[] = {{0.3f, 0.2f, 0.5f}, {-0.7f, 0.4f, 0.3f}};
    for (const Vec3& position : lamps) {
        lamp(position);
    }
    const oracle::ClassicMaterial material = {
        .ambient = oracle::DVec3(0),
        .diffuse = oracle::DVec3(kDiffuse),
        .specular = oracle::DVec3(kSpecular),
        .shininess = 50};
    oracle::DVec3 brightest(0);
    oracle::DVec3 darkest(1e9);
    for (int i = 0; i < 25; ++i) {
        const oracle::DVec3 p = {-1 + 0.5 * (i % 5), -1 + 0.5 * (i / 5), 0};
        std::vector<oracle::Arriving> lights;
        for (const Vec3& position : lamps) {
            lights.push_back({glm::normalize(oracle::DVec3(position) - p), oracle::DVec3(1)});
        }
        const oracle::DVec3 to_camera = glm::normalize(oracle::DVec3(0, 0, 0.5) - p);
        const oracle::DVec3 color =
            oracle::blinn(material, oracle::DVec3(0), lights, {0, 0, 1}, to_camera);
        brightest = glm::max(brightest, color);
        darkest = glm::min(darkest, color);
    }
    const gpu::FloatImage vertex = picture(ShadingRate::Vertex, above());
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            for (int c = 0; c < 3; ++c) {
                REQUIRE(vertex.at(x, y, c) < brightest[c] + 1e-4);
                REQUIRE(vertex.at(x, y, c) > darkest[c] - 1e-4);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    ShadingRates, "phong pixel: where light, viewer and normals are constant it is Gouraud's"
                      * technique("light.phong-pixel")) {
    place(add(make_grid(3)), shiny, at({0, 0, 0}));
    shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0.3f, 0.2f, -1}));
    const gpu::FloatImage pixel = picture(ShadingRate::Pixel, above(), true);
    const gpu::FloatImage vertex = picture(ShadingRate::Vertex, above(), true);
    CHECK(largest(pixel).x > 0.3f);
    CHECK(largest_difference(pixel, vertex) < 2e-3f);
}

TEST_CASE_FIXTURE(
    ShadingRates, "phong pixel: in between, normals are as long as at the vertices"
                      * technique("light.phong-pixel")) {
    // Normals 60 degrees apart: their mean has length 0.866 and, as it is, would reflect 13.4 %
    // less.
    MeshData roof = make_square();
    for (std::size_t i = 0; i < 4; ++i) {
        roof.normals[i] = {roof.positions[i].x * 0.5f, 0, std::sqrt(0.75f)};
    }
    const MaterialId matte = add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = {0.9f, 0.9f, 0.9f, 1},
        .specular = {0, 0, 0}});
    place(add(std::move(roof)), matte, at({0, 0, 0}));
    shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0, 0, -1}));
    const float center = rgb_at(picture(ShadingRate::Pixel, above()), 32, 32).x;
    const float straight = 0.9f;
    CHECK(center == test::near(straight).epsilon(0.002));
    // Gouraud's is the mean of the corners, whose cosine is 0.866.
    CHECK(
        rgb_at(picture(ShadingRate::Vertex, above()), 32, 32).x
        == test::near(straight * 0.8660f).epsilon(0.002));
}

TEST_CASE_FIXTURE(
    ShadingRates, "infinite viewer: on a plane under a directional light all pixels are the same"
                      * technique("light.infinite-approx")) {
    place(add(make_square()), shiny, at({0, 0, 0}));
    shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0.1f, 0.05f, -1}));
    const gpu::FloatImage infinite = picture(ShadingRate::Pixel, above(), true);
    const Vec3 first = rgb_at(infinite, 0, 0);
    float worst = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            worst = std::max(worst, glm::distance(first, rgb_at(infinite, x, y)));
        }
    }
    CHECK(worst < 1e-5f);
    // The near viewer sees a highlight.
    const gpu::FloatImage finite = picture(ShadingRate::Pixel, above());
    CHECK(glm::distance(rgb_at(finite, 32, 32), rgb_at(finite, 2, 2)) > 0.1f);
}

TEST_CASE_FIXTURE(
    ShadingRates,
    "infinite viewer: lamp and eye a thousand scene sizes away count as infinitely far"
        * technique("light.infinite-approx")) {
    place(add(make_square()), shiny, at({0, 0, 0}));
    const Vec3 toward = glm::normalize(Vec3(0.15f, 0.1f, 1));
    float last = 1;
    for (const float distance : {2.0f, 20.0f, 200.0f, 2000.0f}) {
        const Entity near = lamp(distance * toward);
        world.get<PointLight>(near).radius = 0;
        const Affine pose = look_at({0, 0, distance}, {0, 0, 0});
        const RenderView view = make_render_view(
            {.fov_y = 2 * std::atan(1 / distance), .near = 0.05f}, pose, pose,
            {.width = kSide, .height = kSide});
        const gpu::FloatImage finite = picture(ShadingRate::Pixel, view);
        world.destroy(near);
        const Entity far = shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, -toward));
        const gpu::FloatImage infinite = picture(ShadingRate::Pixel, view, true);
        world.destroy(far);
        const float apart = largest_difference(finite, infinite);
        CHECK(apart < last);
        last = apart;
    }
    CHECK(last < 1e-3f);
}

TEST_CASE_FIXTURE(
    ShadingRates,
    "bump vertex: on a plane, vectors to a lamp are exact: two triangles are lit as pixels are"
        * technique("bump.vertex-light-space")) {
    Material matte = world.resource<Assets>().materials[shiny.index];
    matte.specular = {0, 0, 0};
    ImageData map = {.name = "bumps", .width = 2, .height = 2, .pixels = {}};
    map.pixels = {200, 128, 230, 255, 128, 60, 235, 255, 90, 170, 235, 255, 128, 128, 255, 255};
    Material bumpy = matte;
    bumpy.normal_texture = {.image = add(std::move(map)), .nearest = true, .scale = {3, 3}};
    const RenderView whole = look({0, 0, 1}, {0, 0, 0}, kSide, kSide);
    const Entity square = place(add(make_grid(1)), add(matte), at({0, 0, 0}));
    // A fifth of a floor's side from its corner, and a tenth above it.
    lamp({-0.6f, -0.6f, 0.2f});
    const gpu::FloatImage found = picture(ShadingRate::BumpVertex, whole);
    CHECK(largest_difference(found, picture(ShadingRate::Pixel, whole)) < 2e-3f);
    CHECK(rgb_at(found, 12, 51).x == test::near(kDiffuse.x).epsilon(0.01));
    CHECK(rgb_at(picture(ShadingRate::Vertex, whole), 12, 51).x < 0.5f * kDiffuse.x);

    world.get<MeshInstance>(square).material = add(bumpy);
    const gpu::FloatImage bumps = picture(ShadingRate::BumpVertex, whole);
    CHECK(largest_difference(bumps, found) > 0.1f);
    CHECK(largest_difference(bumps, picture(ShadingRate::Pixel, whole)) < 2e-3f);
    // The light of one that falls with the distance is exact, too; that of a sun is the same.
    shine(PointLight{.intensity = 0.3f, .radius = 0}, at({0.4f, 0.2f, 0.3f}));
    shine(DirectionalLight{.illuminance = 1}, look_at({0, 0, 0}, {0.5f, 0.2f, -1}));
    CHECK(
        largest_difference(
            picture(ShadingRate::BumpVertex, whole), picture(ShadingRate::Pixel, whole))
        < 4e-3f);
}

TEST_CASE_FIXTURE(
    ShadingRates, "bump vertex: on a ball of ten thousand triangles it is as good as per pixel"
                      * technique("bump.vertex-light-space, bump.strategy")) {
    ImageData map = {.name = "bumps", .width = 2, .height = 2, .pixels = {}};
    map.pixels = {160, 128, 251, 255, 128, 100, 252, 255, 110, 140, 253, 255, 128, 128, 255, 255};
    Material bumpy = world.resource<Assets>().materials[shiny.index];
    bumpy.shininess = 20;
    bumpy.normal_texture = {.image = add(std::move(map)), .nearest = true, .scale = {8, 4}};
    place(add(make_ball(50)), add(bumpy), at({0, 0, 0}));
    lamp({0.9f, 1.2f, 1.4f});
    const RenderView view = look({0, 0, 2}, {0, 0, 0}, kSide, kSide);
    const gpu::FloatImage found = picture(ShadingRate::BumpVertex, view);
    CHECK(largest_difference(found, picture(ShadingRate::Pixel, view)) < 2.0f / 255);
    CHECK(largest_difference(found, picture(ShadingRate::Vertex, view)) > 0.05f);
}

}  // namespace limn::test::shading_rate_test

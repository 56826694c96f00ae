// Surfaces by one lookup in an omni-directional displacement map (SurfaceDetail::Odd): closed forms
// of a level surface, and the search for the same heights.

#include "content/bake/height_map.h"
#include "content/bake/odd_map.h"
#include "content/bake/tile_surface.h"
#include "ecs/components/shadow.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

namespace limn::test::odd_shade_test {
namespace {

constexpr int kSize = 64;
constexpr float kTile = 0.1f;  // depth of the waves, in tiles

ImageData image_of(const BakedMap& map) {
    ImageData image = {.name = "map", .width = map.width, .height = map.height, .pixels = {}};
    image.pixels = map_bytes(map, 4);
    return image;
}

/// A repeating tile of smooth waves.
HeightMap waves() {
    HeightMap map;
    map.width = 64;
    map.height = 64;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const double u = 6.28318530718 * (x + 0.5) / 64;
            const double v = 6.28318530718 * (y + 0.5) / 64;
            map.heights.push_back(static_cast<float>(0.5 + 0.3 * std::sin(u) + 0.2 * std::cos(v)));
        }
    }
    return map;
}

ImageData level_map(float height) {
    HeightMap map;
    map.width = 4;
    map.height = 4;
    map.heights.assign(16, height);
    const TileSurface tile = tile_of(map, kTile);
    return image_of(bake_odd(tile, TileCaster(tile), OddOrder::Directions));
}

const ImageData& wave_map() {
    static const ImageData map = [] {
        const TileSurface tile = tile_of(waves(), kTile);
        return image_of(bake_odd(tile, TileCaster(tile), OddOrder::Directions));
    }();
    return map;
}

/// A large square with a tile in each square of 2 m.
MeshData floor_mesh() {
    MeshData mesh = make_square();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] *= 8.0f;
        mesh.uvs[i] = (mesh.uvs[i] - 0.5f) * 8.0f + 0.5f;
    }
    mesh.bounds = {{-8, -8, 0}, {8, 8, 0}};
    return mesh;
}

struct OddScene : Scene {
    OddScene() : mesh(add(floor_mesh())) {}
    /// `lod_range`: of the map.
    void
    place_floor(SurfaceDetail detail, ImageId map, float depth, const Vec2& lod_range = {0, 16}) {
        Material material = {.base_color = {0.8f, 0.8f, 0.8f, 1}};
        material.roughness = 0.8f;
        material.detail = detail;
        material.relief_texture.image = map;
        material.relief_texture.lod_range = lod_range;
        material.relief_depth = depth;
        material.relief_steps = 200;
        world.clear();
        place(mesh, add(material), at({0, 0, 0}));
    }
    MeshId mesh;
};

double mean_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            sum += std::abs(double(a.at(x, y, 0)) - double(b.at(x, y, 0)));
        }
    }
    return sum / (a.width * a.height);
}

}  // namespace

TEST_CASE_FIXTURE(
    OddScene, "odd: a level surface has the normal of the mesh and its depth, from any direction"
                  * technique("odd.shade, odd.light-distance")) {
    const ImageId map = add(level_map(0.5f));
    for (const Vec3 eye : {Vec3(0, 0.01f, 2), Vec3(1.5f, -1, 1.2f), Vec3(-2, 1.5f, 0.8f)}) {
        const RenderView view = look(eye, {0, 0, -0.1f}, kSize, kSize);
        place_floor(SurfaceDetail::Odd, map, 0.2f);
        const gpu::FloatImage normals = aov(view, "normal");
        const gpu::FloatImage depth = aov(view, "depth");
        world.clear();
        place(mesh, add(Material{}), at({0, 0, -0.1f}));
        const gpu::FloatImage plane = aov(view, "depth");
        int compared = 0;
        for (int y = 0; y < kSize; y += 3) {
            for (int x = 0; x < kSize; x += 3) {
                if (plane.at(x, y, 0) > 2.2f * (eye.z + 0.1f)) {
                    continue;  // toward the horizon the nearest directions of the map are misses
                }
                ++compared;
                CHECK(glm::dot(glm::normalize(rgb_at(normals, x, y)), Vec3(0, 0, 1)) >= 0.9999f);
                // Distances in the map have steps of 8 depths / 255.
                CHECK(depth.at(x, y, 0) == near(plane.at(x, y, 0)).scale(1).epsilon(0.01));
            }
        }
        CHECK(compared > 100);
    }
}

TEST_CASE_FIXTURE(OddScene, "odd: a depth of 0 leaves the plain surface" * technique("odd.shade")) {
    const RenderView view = look({1, -1, 1}, {0, 0, 0}, kSize, kSize);
    const auto image = [&](SurfaceDetail detail) {
        place_floor(detail, add(wave_map()), 0);
        world.create(
            PointLight{.intensity = 6, .radius = 8}, WorldTransform{at({0.5f, 0.8f, 0.7f})});
        return radiance(view);
    };
    CHECK(largest_difference(image(SurfaceDetail::Odd), image(SurfaceDetail::Flat)) <= 1e-4f);
}

TEST_CASE_FIXTURE(
    OddScene, "odd: it shows what a search for the same heights finds, within a cell of the map"
                  * technique("odd.shade, odd.light-distance")) {
    const HeightMap heights = waves();
    const ImageId relief = add(image_of(relief_of(heights, kTile)));
    const ImageId odd = add(wave_map());
    const float depth = 2 * kTile;  // tiles are 2 m wide
    const RenderView view = look({0.9f, -0.7f, 1.6f}, {0, 0, 0}, kSize, kSize);
    place_floor(SurfaceDetail::Relief, relief, depth, {0, 0});  // those heights, not their means
    const gpu::FloatImage searched = aov(view, "depth");
    const gpu::FloatImage searched_normals = aov(view, "normal");
    place_floor(SurfaceDetail::Odd, odd, depth);
    const gpu::FloatImage looked_up = aov(view, "depth");
    const gpu::FloatImage normals = aov(view, "normal");
    place_floor(SurfaceDetail::Flat, odd, depth);
    const gpu::FloatImage mesh_depth = aov(view, "depth");
    double cosines = 0;
    double distances = 0;
    int count = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const Vec3 n = rgb_at(normals, x, y);
            // Neither the sky nor toward the horizon, where the nearest directions of the map are
            // misses.
            if (n != Vec3(0) && mesh_depth.at(x, y, 0) < 2.2f * 1.6f) {
                distances += double(std::abs(looked_up.at(x, y, 0) - searched.at(x, y, 0)));
                const Vec3 expected = glm::normalize(rgb_at(searched_normals, x, y));
                cosines += double(glm::dot(glm::normalize(n), expected));
                ++count;
            }
        }
    }
    CHECK(mean_difference(mesh_depth, searched) >= 0.05);
    CHECK(count > kSize * kSize / 4);
    CHECK(distances / count <= double(8 * depth / 255));  // a byte of distance
    CHECK(cosines / count >= 0.997);
}

TEST_CASE_FIXTURE(
    OddScene,
    "odd: smooth over directions, and over the borders of tiles" * technique("odd.shade")) {
    place_floor(SurfaceDetail::Odd, add(wave_map()), 2 * kTile);
    // The same point from directions that cross four cells.
    float previous = 0;
    float largest = 0;
    for (int i = 0; i <= 60; ++i) {
        const float angle = 0.2f + 0.012f * static_cast<float>(i);
        const Vec3 eye = 2.0f * Vec3(std::sin(angle), 0.05f, std::cos(angle));
        const gpu::FloatImage depth = aov(look(eye, {0, 0, 0}, 3, 3), "depth");
        const float below = (depth.at(1, 1, 0) - 2) * std::cos(angle);
        largest = i > 0 ? std::max(largest, std::abs(below - previous)) : largest;
        previous = below;
    }
    CHECK(largest <= 0.004f);  // of 0.2: a cell further it changes by 0.03
    // Straight down, along a row over the border of two tiles.
    const Affine pose = look_at({1, 0, 40}, {1, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.3f / 40), .near = 1}, pose, pose, {.width = 64, .height = 64});
    const gpu::FloatImage depth = aov(view, "depth");
    for (int x = 1; x < 64; ++x) {
        CHECK(std::abs(depth.at(x, 32, 0) - depth.at(x - 1, 32, 0)) <= 0.003f);
    }
}

TEST_CASE_FIXTURE(
    OddScene,
    "odd: lights are as far as from the point that is visible" * technique("odd.light-distance")) {
    const ImageId map = add(level_map(0));
    const Affine pose = look_at({0, 0, 40}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.02f / 40), .near = 1}, pose, pose, {.width = 4, .height = 4});
    const auto light_at = [&](const PointLight& light, const Vec3& position) {
        world.create(light, WorldTransform{at(position)});
        return rgb_at(radiance(view), 2, 2).x;
    };
    const PointLight lamp = {.intensity = 10, .radius = 0};
    place_floor(SurfaceDetail::Flat, map, 0.1f);
    const float near_mesh = light_at(lamp, {0, 0, 1});
    place_floor(SurfaceDetail::Odd, map, 0.1f);
    CHECK(light_at(lamp, {0, 0, 1}) == near(near_mesh / (1.1f * 1.1f)).epsilon(0.01));
    // Of a distant light nothing changes; one at the horizon lights nothing.
    place_floor(SurfaceDetail::Flat, map, 0.1f);
    const float far_mesh = light_at({.intensity = 1e7f, .radius = 0}, {0, 0, 1000});
    place_floor(SurfaceDetail::Odd, map, 0.1f);
    CHECK(light_at({.intensity = 1e7f, .radius = 0}, {0, 0, 1000}) == near(far_mesh).epsilon(1e-3));
    place_floor(SurfaceDetail::Odd, map, 0.1f);
    world.create(
        DirectionalLight{.illuminance = 10}, WorldTransform{look_at({1, 0, 0}, {0, 0, 0})});
    const float byte = 1.0f / 128;  // of the normal
    CHECK(rgb_at(radiance(view), 2, 2).x <= 10 * 0.8f / kPi * byte);
}

TEST_CASE_FIXTURE(
    OddScene, "odd: shadows fall on the point that is visible" * technique("odd.light-distance")) {
    const ImageId map = add(level_map(0));
    const MeshId post = add(make_ball(12));
    const RenderView view = look({0, -2, 2}, {0, 0, -0.2f}, kSize, kSize);
    const auto build = [&] {
        world.create(
            SpotLight{.intensity = 60, .radius = 0, .inner_angle = 0.9f, .outer_angle = 1.0f},
            WorldTransform{look_at({1.5f, 1, 1.5f}, {0, 0, 0})}, Shadow{.resolution = 1024});
        place(post, add(Material{}), affine_from({0.3f, 0.2f, 0.4f}, {1, 0, 0, 0}, Vec3(0.15f)));
    };
    place_floor(SurfaceDetail::Odd, map, 0.2f);
    build();
    const gpu::FloatImage found = radiance(view);
    world.clear();
    Material plain = {.base_color = {0.8f, 0.8f, 0.8f, 1}};
    plain.roughness = 0.8f;
    place(mesh, add(plain), at({0, 0, -0.2f}));
    build();
    const gpu::FloatImage expected = radiance(view);
    int different = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            different += std::abs(found.at(x, y, 0) - expected.at(x, y, 0)) > 0.05f ? 1 : 0;
        }
    }
    CHECK(different <= kSize * kSize / 64);
}

}  // namespace limn::test::odd_shade_test

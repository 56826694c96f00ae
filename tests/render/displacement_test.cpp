// Relief as geometry (SurfaceDetail::Displaced): closed forms, a march through the height field in
// double precision, and agreement between the passes of a frame. relief_test.cpp compares a flat
// one with a plane.

#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "render/gpu/device_caps.h"
#include "render/material/relief_hook.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace limn::test::displacement_test {
namespace {

constexpr int kSize = 96;
constexpr double kTau = 6.283185307179586;
constexpr float kDepth = 0.15f;

template <typename Texel>
ImageData make_map(int size, Texel&& texel) {
    ImageData image = {.name = "map", .width = size, .height = size, .pixels = {}};
    const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
    };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Vec4 t = texel((x + 0.5) / size, (y + 0.5) / size);
            for (int k = 0; k < 4; ++k) {
                image.pixels.push_back(byte(double(t[k])));
            }
        }
    }
    return image;
}

/// Depth of two waves along u and one along v, 0 .. 1.
double wave_depth(double u, double v) {
    return 0.5 + 0.3 * std::sin(2 * kTau * u) + 0.2 * std::sin(kTau * v);
}

/// Their normals on the square, whose tile is 2 m wide.
Vec3 wave_normal(double u, double v) {
    const double along = -kDepth * 0.3 * 2 * kTau * std::cos(2 * kTau * u) / 2;  // dz/dx
    const double down = -kDepth * 0.2 * kTau * std::cos(kTau * v) / 2;           // dz/d(-y)
    return glm::normalize(Vec3(static_cast<float>(-along), static_cast<float>(down), 1));
}

ImageData waves(bool with_normals) {
    return make_map(256, [&](double u, double v) {
        const Vec3 n = with_normals ? wave_normal(u, v) : Vec3(0, 0, 1);
        return Vec4(n * 0.5f + 0.5f, static_cast<float>(wave_depth(u, v)));
    });
}

/// Random depths, smooth over 1/16 of the map, that repeat.
ImageData rough_map() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> values(256);
    for (float& value : values) {
        value = unit(random);
    }
    return make_map(64, [&](double u, double v) {
        const auto value = [&](int x, int y) { return values[16 * (y % 16) + x % 16]; };
        const int x = static_cast<int>(16 * u);
        const int y = static_cast<int>(16 * v);
        const auto fx = static_cast<float>(16 * u - x);
        const auto fy = static_cast<float>(16 * v - y);
        const float top = value(x, y) + fx * (value(x + 1, y) - value(x, y));
        const float low = value(x, y + 1) + fx * (value(x + 1, y + 1) - value(x, y + 1));
        return Vec4(0.5f, 0.5f, 1, top + fy * (low - top));
    });
}

ImageData flat(std::uint8_t depth) {
    return {.name = "flat", .width = 1, .height = 1, .pixels = {128, 128, 255, depth}};
}

/// The square in `cells` by `cells` parts.
MeshData make_grid(int cells) {
    const MeshData square = make_square();
    MeshData mesh;
    mesh.name = "grid";
    mesh.bounds = square.bounds;
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            const Vec2 uv = Vec2(x, y) / static_cast<float>(cells);
            mesh.positions.emplace_back(2 * uv.x - 1, 1 - 2 * uv.y, 0);
            mesh.uvs.push_back(uv);
        }
    }
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    const auto index = [&](int x, int y) {
        return static_cast<std::uint32_t>(y * (cells + 1) + x);
    };
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            mesh.indices.insert(
                mesh.indices.end(), {index(x, y), index(x, y + 1), index(x + 1, y + 1), index(x, y),
                                     index(x + 1, y + 1), index(x + 1, y)});
        }
    }
    return mesh;
}

Material displaced(ImageId map, float depth = kDepth) {
    Material material = {.base_color = {1, 1, 1, 1}};
    material.detail = SurfaceDetail::Displaced;
    material.relief_texture = {.image = map};
    material.relief_depth = depth;
    material.tessellation = 4;
    return material;
}

/// Distance along the view axis at which a ray from above meets the waves; 0 if it does not.
double march(const RenderView& view, double x, double y) {
    const auto& r = view.world_from_camera.row;
    const double ndc[2] = {2 * (x + 0.5) / view.width - 1, 1 - 2 * (y + 0.5) / view.height};
    double ray[3];
    for (int i = 0; i < 3; ++i) {
        ray[i] = -double(r[i].z) + ndc[0] * double(view.tangent.x) * double(r[i].x)
                 + ndc[1] * double(view.tangent.y) * double(r[i].y);
    }
    double t = -double(r[2].w) / ray[2];  // on the mesh
    for (int i = 0; i < 200000; ++i, t += 1e-5) {
        const double px = double(r[0].w) + t * ray[0];
        const double py = double(r[1].w) + t * ray[1];
        if (std::abs(px) > 0.95 || std::abs(py) > 0.95) {
            return 0;
        }
        const double depth = double(kDepth) * wave_depth(0.5 + 0.5 * px, 0.5 - 0.5 * py);
        if (double(r[2].w) + t * ray[2] <= -depth) {
            return t;
        }
    }
    return 0;
}

/// Largest and mean distance to march().
std::pair<double, double> errors_of(const gpu::FloatImage& depth, const RenderView& view) {
    double largest = 0;
    double sum = 0;
    int count = 0;
    for (int y = 2; y < depth.height; y += 4) {
        for (int x = 2; x < depth.width; x += 4) {
            const double expected = march(view, x, y);
            if (expected > 0) {
                const double error = std::abs(double(depth.at(x, y, 0)) - expected);
                largest = std::max(largest, error);
                sum += error;
                ++count;
            }
        }
    }
    REQUIRE(count > 100);
    return {largest, sum / count};
}

/// While it lives the shared device has no textures in tessellation stages.
struct NoTessellation {
    // The device itself is not const.
    gpu::DeviceCaps& caps = const_cast<gpu::DeviceCaps&>(RenderTest::device().caps());
    int found = std::exchange(caps.max_evaluation_textures, 0);

    NoTessellation() = default;
    NoTessellation(const NoTessellation&) = delete;
    NoTessellation& operator=(const NoTessellation&) = delete;
    ~NoTessellation() { caps.max_evaluation_textures = found; }
};

}  // namespace

TEST_CASE_FIXTURE(
    Scene,
    "displacement: a map of depth 0 leaves the mesh where it is" * technique("tex.displacement")) {
    const RenderView view = look({0.6f, -0.4f, 1.0f}, {0, 0, 0}, kSize, kSize);
    const MeshId mesh = add(make_ball(12));
    place(mesh, add(Material{}), at({0, 0, -1}));
    const gpu::FloatImage plain = aov(view, "depth");
    world.clear();
    place(mesh, add(displaced(add(flat(0)))), at({0, 0, -1}));
    // Vertices within triangles are where the triangle is, up to the grid of the rasterizer.
    CHECK(largest_difference(aov(view, "depth"), plain) <= 5e-4f);
}

TEST_CASE_FIXTURE(
    Scene, "displacement: vertices are where a march through the height field ends"
               * technique("tex.displacement")) {
    const ImageId map = add(waves(true));
    const MeshId grid = add(make_grid(4));
    const RenderView view = look({0.5f, -0.5f, 1.1f}, {0, 0, 0}, kSize, kSize);
    const auto errors = [&](float pixels) {
        world.clear();
        Material material = displaced(map);
        material.tessellation = pixels;
        place(grid, add(material), at({0, 0, 0}));
        return errors_of(aov(view, "depth"), view);
    };
    const auto [largest, mean] = errors(1);
    const auto [coarse_largest, coarse_mean] = errors(16);
    CHECK(largest <= 0.006);  // a byte of depth is 0.6 mm, a pixel 14 mm
    CHECK(mean <= 0.001);
    CHECK(coarse_mean >= 3 * mean);
}

TEST_CASE_FIXTURE(
    Scene, "displacement: without the normals of its map it shades as a plane, with them as waves"
               * technique("tex.displacement")) {
    // Straight down from far away: pixels see the texels at their own positions.
    const Affine pose = look_at({0, 0, 40}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(1.0f / 40), .near = 1}, pose, pose, {.width = 64, .height = 64});
    const MeshId grid = add(make_grid(4));
    for (const bool with_normals : {false, true}) {
        world.clear();
        place(grid, add(displaced(add(waves(with_normals)))), at({0, 0, 0}));
        const gpu::FloatImage normals = aov(view, "normal");
        float least = 1;
        for (int y = 4; y < 60; ++y) {
            for (int x = 4; x < 60; ++x) {
                const Vec3 expected =
                    with_normals ? wave_normal((x + 0.5) / 64, (y + 0.5) / 64) : Vec3(0, 0, 1);
                least = std::min(least, glm::dot(glm::normalize(rgb_at(normals, x, y)), expected));
            }
        }
        CAPTURE(with_normals);
        CHECK(least >= 0.9995f);
    }
}

TEST_CASE_FIXTURE(
    Scene, "displacement: depth prepass, forward and deferred shading agree"
               * technique("tex.displacement")) {
    world.create(
        PointLight{.intensity = 6, .radius = 8}, WorldTransform{at({0.5f, 0.8f, 0.7f})},
        Shadow{.resolution = 256});
    place(add(make_grid(4)), add(displaced(add(rough_map()))), at({0, 0, 0}));
    const RenderView view = look({0.5f, -0.5f, 0.9f}, {0, 0, 0}, kSize, kSize);
    const gpu::FloatImage deferred = radiance(view);
    REQUIRE(rgb_at(deferred, kSize / 2, kSize / 2).x > 0.05f);
    for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(radiance(view), deferred) <= 5e-3f);
    }
}

TEST_CASE_FIXTURE(
    Scene,
    "displacement: the outline of a ball shrinks by the depth" * technique("tex.displacement")) {
    Material white = displaced(add(flat(255)), 0.2f);
    white.shading = ShadingModel::Unlit;
    place(add(make_ball(32)), add(white), at({0, 0, 0}));
    const Affine pose = look_at({0, 0, 80}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(1.05f / 80), .near = 1}, pose, pose, {.width = 256, .height = 256});
    const gpu::FloatImage image = radiance(view);
    int covered = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            covered += image.at(x, y, 0) > 0.5f ? 1 : 0;
        }
    }
    CHECK(std::sqrt(covered / 3.14159265) * 2.1 / 256 == near(0.8).epsilon(0.004));
}

TEST_CASE_FIXTURE(
    Scene, "displacement: no cracks between triangles of any size, nor at the seam of the uvs"
               * technique("tex.displacement")) {
    const MeshId ball = add(make_ball(7));
    const ImageId map = add(rough_map());
    for (const float pixels : {1.5f, 3.0f, 7.0f}) {
        world.clear();
        Material white = displaced(map, 0.3f);
        white.shading = ShadingModel::Unlit;
        white.tessellation = pixels;
        white.relief_texture.scale = {6, 6};  // several texels between vertices
        place(ball, add(white), at({0, 0, 0}));
        for (int turn = 0; turn < 6; ++turn) {
            const float a = 1.1f * static_cast<float>(turn);
            // So near that the same edge has other levels than its neighbors.
            const Vec3 eye = 1.5f * Vec3(std::sin(a), 0.3f, std::cos(a));
            const gpu::FloatImage image = radiance(look(eye, {0, 0, 0}, 256, 256));
            int holes = 0;
            for (int y = 96; y < 160; ++y) {
                for (int x = 96; x < 160; ++x) {
                    holes += image.at(x, y, 0) < 0.5f ? 1 : 0;
                }
            }
            CAPTURE(pixels);
            CAPTURE(turn);
            CHECK(holes == 0);
        }
    }
}

TEST_CASE_FIXTURE(
    Scene, "displacement: what lies below a mesh that is out of view is drawn"
               * technique("tex.displacement")) {
    place(add(make_grid(4)), add(displaced(add(flat(255)), 0.5f)), at({0, 0, 0}));
    const Affine pose = look_at({-1.2f, 0, -0.45f}, {1, 0, -0.45f});
    const RenderView view = make_render_view(
        {.fov_y = radians(14.0f), .near = 0.01f}, pose, pose, {.width = 32, .height = 32});
    const gpu::FloatImage depth = aov(view, "depth");
    // 5 cm above the surface, which is to the left.
    const double slope = std::tan(7 * kTau / 360) * (1 - 2 * 1.5 / 32);
    CHECK(depth.at(1, 16, 0) == near(0.05 / slope).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    Scene, "displacement: shadow maps follow the eye for which the mesh is divided"
               * technique("tex.displacement")) {
    const MeshId grid = add(make_grid(4));
    const MaterialId stone = add(displaced(add(rough_map()), 0.3f));
    const auto build = [&] {
        world.clear();
        world.create(
            SpotLight{.intensity = 30, .radius = 0, .inner_angle = 0.9f, .outer_angle = 1.0f},
            WorldTransform{look_at({1.4f, 1.4f, 1.2f}, {0, 0, 0})}, Shadow{.resolution = 256});
        place(grid, stone, at({0, 0, 0}));
    };
    const RenderView view = look({0.3f, -0.5f, 0.6f}, {0, 0, 0}, kSize, kSize);
    build();
    const gpu::FloatImage fresh = radiance(view);
    build();
    radiance(look({20, -30, 40}, {0, 0, 0}, kSize, kSize));     // from afar: few triangles
    CHECK(largest_difference(radiance(view), fresh) <= 2e-3f);  // without: 4
}

TEST_CASE(
    "displacement: a device without tessellation draws silhouettes"
    * technique("tex.displacement")) {
    gpu::DeviceCaps caps;
    caps.max_combined_textures = 80;
    const auto errors = gpu::check_requirements(caps, {.evaluation_textures = 1});
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].kind == gpu::ProfileErrorKind::Capability);
    CHECK(supported_detail(SurfaceDetail::Displaced, caps) == SurfaceDetail::Silhouette);
    CHECK(supported_detail(SurfaceDetail::Cone, caps) == SurfaceDetail::Cone);
    caps.max_evaluation_textures = 16;
    CHECK(gpu::check_requirements(caps, {.evaluation_textures = 1}).empty());
    CHECK(supported_detail(SurfaceDetail::Displaced, caps) == SurfaceDetail::Displaced);
}

TEST_CASE_FIXTURE(
    Scene,
    "displacement: without tessellation the image is that of silhouettes, and one warning says so"
        * technique("tex.displacement")) {
    const RenderView view = look({2.2f, 0.6f, 1.2f}, {0, 0, 0}, kSize, kSize);
    const auto depth_of = [&](SurfaceDetail detail) {
        world.clear();
        world.insert_resource(Assets{});
        Material carved = displaced(add(waves(true)), 0.3f);
        carved.detail = detail;
        place(add(make_ball(24)), add(carved), at({0, 0, 0}));
        carved.base_color = {1, 0, 0, 1};
        place(add(make_grid(2)), add(carved), at({0, 0, -1}));
        return aov(view, "depth");
    };
    const gpu::FloatImage silhouette = depth_of(SurfaceDetail::Silhouette);
    CHECK(largest_difference(depth_of(SurfaceDetail::Displaced), silhouette) > 0.05f);
    const NoTessellation none;
    std::size_t warnings = 0;
    gpu::FloatImage found;
    for (const std::string& message :
         messages_of([&] { found = depth_of(SurfaceDetail::Displaced); })) {
        warnings += message.find("no tessellation") != std::string::npos ? 1 : 0;
    }
    CHECK(largest_difference(found, silhouette) == 0);
    CHECK(warnings == 1);
}

}  // namespace limn::test::displacement_test

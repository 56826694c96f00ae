// Relief below a mesh against real geometry: a flat relief is a plane that deep, whatever draws it,
// lights it and shadows it.

#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/material/relief_hook.h"
#include "render/material/surface_features.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn::test::relief_test {
namespace {

constexpr float kDepth = 0.4f;         // of the relief [m]
constexpr float kHalf = 128.0f / 255;  // depth in its map
constexpr int kSize = 96;
constexpr SurfaceDetail kSearches[] = {SurfaceDetail::Occlusion,  SurfaceDetail::Relief,
                                       SurfaceDetail::Cone,       SurfaceDetail::DoubleDepth,
                                       SurfaceDetail::Silhouette, SurfaceDetail::Displaced};

/// Normals straight up, a closed back and wide cones, of this depth.
ImageData flat_map(std::uint8_t depth) {
    return {.name = "flat", .width = 1, .height = 1, .pixels = {128, 128, 255, depth}};
}

/// Depth 0 at the center of the tile, 1 at its border.
ImageData pyramid_map() {
    constexpr int kTexels = 256;
    ImageData image = {.name = "pyramid", .width = kTexels, .height = kTexels, .pixels = {}};
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            const auto off = [](int i) {
                return std::abs((static_cast<float>(i) + 0.5f) * 2 / kTexels - 1);
            };
            const auto depth =
                static_cast<std::uint8_t>(std::lround(255 * std::max(off(x), off(y))));
            image.pixels.insert(image.pixels.end(), {128, 128, 128, depth});
        }
    }
    return image;
}

/// Smooth waves of color.
ImageData waves() {
    constexpr int kTexels = 64;
    ImageData image = {.name = "waves", .width = kTexels, .height = kTexels, .pixels = {}};
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            const auto wave = [](int i) {
                return static_cast<std::uint8_t>(
                    std::lround(127.5 + 100 * std::sin(2 * 3.14159265 * (i + 0.5) / kTexels)));
            };
            image.pixels.insert(image.pixels.end(), {wave(x), wave(y), 90, 255});
        }
    }
    return image;
}

/// The square, `times` as large, with the same texture on each square meter.
MeshData large_square(float times) {
    MeshData mesh = make_square();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] *= times;
        mesh.uvs[i] = (mesh.uvs[i] - 0.5f) * times + 0.5f;
    }
    mesh.bounds = {};
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
    return mesh;
}

struct ReliefScene : Scene {
    ReliefScene() : colors(add(waves())), map(add(flat_map(128))) {}

    [[nodiscard]] Material painted() const {
        return {
            .base_color = {1, 1, 1, 1}, .roughness = 0.6f, .base_color_texture = {.image = colors}};
    }
    [[nodiscard]] Material carved(SurfaceDetail detail, ImageId relief) const {
        Material material = painted();
        material.detail = detail;
        material.relief_depth = kDepth;
        material.relief_steps = 64;
        material.relief_texture = {.image = relief};
        return material;
    }
    /// Real geometry where the flat relief is.
    void place_plane() { place(add(large_square(8)), add(painted()), at({0, 0, -kHalf * kDepth})); }
    Entity place_relief(SurfaceDetail detail) {
        return place(add(large_square(8)), add(carved(detail, map)), at({0, 0, 0}));
    }
    void light() {
        world.insert_resource(
            Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}, .intensity = 0.3f});
        world.create(
            PointLight{.color = {1, 0.9f, 0.8f}, .intensity = 6, .radius = 8},
            WorldTransform{at({0.5f, 0.8f, 0.7f})});
    }
    /// Oblique, moved since the previous frame.
    [[nodiscard]] RenderView oblique() const {
        const Affine pose = look_at({1.1f, -0.5f, 0.9f}, {0, 0, -0.2f});
        const Affine previous = look_at({1.0f, -0.5f, 0.9f}, {0.05f, 0, -0.2f});
        return make_render_view(
            {.fov_y = radians(60.0f), .near = 0.05f}, pose, previous,
            {.width = kSize, .height = kSize, .previous_alpha = 0});
    }

    ImageId colors;
    ImageId map;
};

/// Pyramids of 2 m, 0.4 m high, in the low sun and by a lamp, from above.
struct PyramidScene : ReliefScene {
    PyramidScene() : pyramid(add(pyramid_map())) {}

    void build(
        ReliefShadow shadow, const Vec3& to_sun, LightMethod method = LightMethod::Clustered,
        bool lamp = true) {
        world.clear();
        world.insert_resource(Rendering{.lights = method});
        world.create(
            DirectionalLight{.illuminance = 3}, WorldTransform{look_at(to_sun, {0, 0, 0})},
            Shadow{.resolution = 2048, .distance = 8});
        if (lamp) {
            world.create(
                PointLight{.intensity = 1, .radius = 4}, WorldTransform{at({-0.7f, 0.2f, 0.3f})},
                Shadow{.resolution = 1024});
        }
        Material stone = {.base_color = {1, 1, 1, 1}, .roughness = 1};
        stone.detail = SurfaceDetail::Relief;
        stone.relief_depth = 0.4f;
        stone.relief_steps = 96;
        stone.relief_refinements = 8;
        stone.relief_texture = {.image = pyramid};
        stone.relief_shadow = shadow;
        place(add(large_square(8)), add(stone), at({0, 0, 0}));
    }
    ImageId pyramid;
    const RenderView view = look({0, 0, 1.6f}, {0, 0, 0}, kSize, kSize);
};

/// Fraction of the pixels that differ in some channel by more than `visible`.
double different_pixels(const gpu::FloatImage& a, const gpu::FloatImage& b, float visible) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    int different = 0;
    const auto channels = static_cast<std::size_t>(a.channels);
    for (std::size_t i = 0; i < a.pixels.size(); i += channels) {
        bool differs = false;
        for (std::size_t c = 0; c < std::min<std::size_t>(channels, 3); ++c) {
            differs = differs || std::abs(a.pixels[i + c] - b.pixels[i + c]) > visible;
        }
        different += differs ? 1 : 0;
    }
    return double(different) * a.channels / double(a.pixels.size());
}

double mean_of(const gpu::FloatImage& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            sum += double(image.at(x, y, channel));
        }
    }
    return sum / (image.width * image.height);
}

}  // namespace

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: a flat relief has the color, depth and velocity of a plane that deep"
        * technique("relief.tangent, relief.planar, relief.depth-correct, relief.inverse-map")) {
    light();
    place_plane();
    const RenderView view = oblique();
    const gpu::FloatImage color = radiance(view);
    const gpu::FloatImage depth = aov(view, "depth");
    const gpu::FloatImage velocity = aov(view, "velocity");
    REQUIRE(mean_of(color, 0) > 0.05);
    for (const SurfaceDetail detail : kSearches) {
        world.clear();
        light();
        place_relief(detail);
        CAPTURE(static_cast<int>(detail));
        CHECK(different_pixels(radiance(view), color, 0.02f) == 0);
        CHECK(largest_difference(aov(view, "depth"), depth) <= 2e-3f);
        CHECK(largest_difference(aov(view, "velocity"), velocity) <= 0.02f);  // [px]
    }
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: shadows fall onto it, from it and on itself as with a plane that deep"
        * technique("shadow.relief-receive, shadow.relief-cast, shadow.relief-matrix")) {
    const MeshId post = add(make_ball(24));
    const auto build = [&] {
        world.clear();
        world.create(
            SpotLight{.intensity = 30, .radius = 0, .inner_angle = 0.9f, .outer_angle = 1.0f},
            WorldTransform{look_at({1.4f, 1.4f, 1.2f}, {0, 0, 0})}, Shadow{.resolution = 1024});
        place(post, add(Material{}), affine_from({0.2f, 0.2f, 0.2f}, {1, 0, 0, 0}, Vec3(0.15f)));
        // Hidden by the surface from the light, not from the camera: lit where the relief is.
        place(add(large_square(8)), add(Material{}), at({0, 0, -1.5f}));
    };
    build();
    place_plane();
    const RenderView view = oblique();
    const gpu::FloatImage expected = radiance(view);
    for (const SurfaceDetail detail : kSearches) {
        build();
        place_relief(detail);
        CAPTURE(static_cast<int>(detail));
        // A texel of the map, whose borders fall elsewhere.
        CHECK(different_pixels(radiance(view), expected, 0.05f) < 0.003);
    }
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: cast as its bottom, a flat relief shadows others as before and itself nowhere"
        * technique("shadow.relief-cast, relief.self-shadow")) {
    const auto build = [&] {
        world.clear();
        world.create(
            DirectionalLight{.illuminance = 5},
            WorldTransform{look_at({1.4f, 1.4f, 1.2f}, {0, 0, 0})}, Shadow{.resolution = 1024});
        place(add(large_square(8)), add(Material{}), at({0, 0, -1.5f}));
    };
    build();
    place_plane();
    const RenderView view = oblique();
    const gpu::FloatImage expected = radiance(view);
    for (const ReliefShadow shadow : {ReliefShadow::Ray, ReliefShadow::None}) {
        for (const SurfaceDetail detail : kSearches) {
            build();
            Material material = carved(detail, map);
            material.relief_shadow = shadow;
            place(add(large_square(8)), add(material), at({0, 0, 0}));
            CAPTURE(static_cast<int>(detail));
            CHECK(different_pixels(radiance(view), expected, 0.05f) < 0.003);
        }
    }
}

TEST_CASE_FIXTURE(
    PyramidScene,
    "relief self-shadow: a second ray finds what a fine shadow map shows"
        * technique("relief.self-shadow, relief.tangent-shadow, shadow.relief-self")) {
    // The faces fall by 0.4 m in a meter: light that is flatter leaves the far ones dark.
    const Vec3 low = {-8, 0, 2.2f};
    const auto image = [&](ReliefShadow shadow, bool lamp) {
        build(shadow, low, LightMethod::Clustered, lamp);
        return radiance(view);
    };
    const gpu::FloatImage lit = image(ReliefShadow::None, false);
    const gpu::FloatImage mapped = image(ReliefShadow::Map, false);
    REQUIRE(different_pixels(mapped, lit, 0.1f) > 0.2);
    CHECK(different_pixels(image(ReliefShadow::Ray, false), mapped, 0.1f) < 0.03);
    const gpu::FloatImage traced = image(ReliefShadow::Ray, true);
    for (const LightMethod method :
         {LightMethod::ObjectMajor, LightMethod::LightMajor, LightMethod::FullScreen,
          LightMethod::Volumes}) {
        build(ReliefShadow::Ray, low, method);
        CAPTURE(static_cast<int>(method));
        CHECK(different_pixels(radiance(view), traced, 4e-3f) == 0);
    }
    // Steeper than the faces: no shadow.
    const Vec3 high = {-2, 0, 2.2f};
    build(ReliefShadow::None, high, LightMethod::Clustered, false);
    const gpu::FloatImage none = radiance(view);
    build(ReliefShadow::Ray, high, LightMethod::Clustered, false);
    CHECK(different_pixels(radiance(view), none, 0.01f) == 0);
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: shadow volumes end on it as on a plane that deep"
                     * technique("shadow.relief-stencil")) {
    const MeshId post = add(make_ball(24));
    const auto build = [&] {
        world.clear();
        world.create(
            DirectionalLight{.illuminance = 5},
            WorldTransform{look_at({1.4f, 1.4f, 1.2f}, {0, 0, 0})},
            Shadow{.method = ShadowMethod::Volume}, ShadowVolume{.kind = VolumeKind::PerTriangle});
        place(post, add(Material{}), affine_from({0.2f, 0.2f, 0.2f}, {1, 0, 0, 0}, Vec3(0.15f)));
    };
    build();
    place_plane();
    const RenderView view = oblique();
    const gpu::FloatImage expected = radiance(view);
    REQUIRE(mean_of(expected, 0) > 0.05);
    build();
    place_relief(SurfaceDetail::Relief);
    CHECK(different_pixels(radiance(view), expected, 0.05f) < 0.003);
    // Without its depth the shadow would be elsewhere.
    build();
    place_relief(SurfaceDetail::Parallax);
    CHECK(different_pixels(radiance(view), expected, 0.05f) > 0.02);
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: a closed caster's own shadow volume does not darken its relief"
                     * technique("shadow.relief-stencil")) {
    const ImageId deepest = add(flat_map(255));
    Material stone = {.base_color = {1, 1, 1, 1}};
    stone.relief_texture = {.image = deepest};
    stone.relief_depth = 0.1f;
    stone.detail = SurfaceDetail::Silhouette;
    const RenderView view = look({0, 0, 3}, {0, 0, 0}, kSize, kSize);
    const auto build = [&](bool shadowed) {
        world.clear();
        const Entity lamp = world.create(
            PointLight{.intensity = 9, .radius = 9}, WorldTransform{at({0.8f, 0.8f, 3})});
        if (shadowed) {
            world.add(lamp, Shadow{.method = ShadowMethod::Volume});
            world.add(lamp, ShadowVolume{});
        }
        place(add(make_ball(48)), add(stone), at({0, 0, 0}));
    };
    build(false);
    const gpu::FloatImage expected = radiance(view);
    REQUIRE(mean_of(expected, 0) > 0.01);
    build(true);
    // At the terminator light is so flat that the volume begins above the relief.
    CHECK(different_pixels(radiance(view), expected, 0.05f) < 0.02);
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: a ball casts the shadow of its relief, not of its mesh"
                     * technique("shadow.relief-cast")) {
    const ImageId deepest = add(flat_map(255));
    const MeshId ball = add(make_ball(64));
    Material stone = {.base_color = {1, 1, 1, 1}};
    stone.relief_texture = {.image = deepest};
    stone.relief_depth = 0.2f;
    // From the side, below the ball; the light is nearly parallel.
    const RenderView view = look({0, 3, -2.2f}, {0, 0, -3}, kSize, kSize);
    const auto shadow = [&](SurfaceDetail detail) {
        world.clear();
        world.create(
            SpotLight{.intensity = 4000, .radius = 0, .inner_angle = 0.1f, .outer_angle = 0.12f},
            WorldTransform{look_at({0, 0, 40}, {0, 0, 0})}, Shadow{.resolution = 2048});
        place(add(large_square(8)), add(Material{.base_color = {1, 1, 1, 1}}), at({0, 0, -3}));
        const gpu::FloatImage lit = radiance(view);
        stone.detail = detail;
        place(ball, add(stone), at({0, 0, 0}));
        return different_pixels(radiance(view), lit, 0.2f);
    };
    const double mesh = shadow(SurfaceDetail::Relief);
    REQUIRE(mesh > 0.02);
    CHECK(shadow(SurfaceDetail::Silhouette) / mesh == near(0.845154 * 0.845154).epsilon(0.03));
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: forward and deferred shading show the same image" * technique("relief.permutations")) {
    const ImageId pyramid = add(pyramid_map());
    light();
    place(add(make_square()), add(carved(SurfaceDetail::Relief, pyramid)), at({0, 0, 0}));
    const RenderView view = look({0.5f, -0.4f, 0.8f}, {0, 0, 0}, kSize, kSize);
    const gpu::FloatImage deferred = radiance(view);
    for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        CAPTURE(static_cast<int>(method));
        CHECK(different_pixels(radiance(view), deferred, 2e-3f) == 0);
    }
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: a plane through a pyramid at half its depth leaves a quarter of it visible"
        * technique("relief.composite")) {
    const ImageId pyramid = add(pyramid_map());
    Material red = {.shading = ShadingModel::Unlit, .base_color = {1, 0, 0, 1}};
    red.detail = SurfaceDetail::Relief;
    red.relief_depth = 0.2f;
    red.relief_steps = 64;
    red.relief_texture = {.image = pyramid};
    place(add(make_square()), add(red), at({0, 0, 0}));
    place(
        add(large_square(8)),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 1, 0, 1}}),
        at({0, 0, -0.1f}));
    // Nearly parallel rays, straight down.
    const Affine pose = look_at({0, 0, 50}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(1.0f / 50), .near = 1}, pose, pose, {.width = 128, .height = 128});
    CHECK(mean_of(radiance(view), 0) == near(0.25).epsilon(0.03));
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: on a ball the deepest relief has the outline of the formula"
                     * technique("relief.silhouette")) {
    const ImageId deepest = add(flat_map(255));
    Material white = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
    white.relief_texture = {.image = deepest};
    const MeshId ball = add(make_ball(64));
    const Affine pose = look_at({0, 0, 80}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(1.05f / 80), .near = 1}, pose, pose, {.width = 256, .height = 256});
    const auto radius = [&] {
        const double covered = mean_of(radiance(view), 0) * 2.1 * 2.1;
        return std::sqrt(covered / 3.14159265);
    };
    place(ball, add(white), at({0, 0, 0}));
    CHECK(radius() == near(1).epsilon(0.004));
    for (const auto& [depth, outline] : {std::pair(0.05f, 0.953463f), std::pair(0.2f, 0.845154f)}) {
        world.clear();
        white.detail = SurfaceDetail::Silhouette;
        white.relief_depth = depth;
        place(ball, add(white), at({0, 0, 0}));
        CHECK(radius() == near(outline).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: parallax shifts by half the depth about the middle of the map"
                     * technique("relief.parallax")) {
    light();
    const RenderView view = oblique();
    place(add(large_square(8)), add(painted()), at({0, 0, 0}));
    const gpu::FloatImage plain = radiance(view);
    world.clear();
    light();
    place_relief(SurfaceDetail::Parallax);
    const gpu::FloatImage half = radiance(view);
    CHECK(different_pixels(half, plain, 0.02f) == 0);
    world.clear();
    light();
    place(
        add(large_square(8)), add(carved(SurfaceDetail::Parallax, add(flat_map(255)))),
        at({0, 0, 0}));
    CHECK(different_pixels(radiance(view), plain, 0.02f) > 0.3);
    // It never leaves the mesh.
    const gpu::FloatImage depth = aov(view, "depth");
    world.clear();
    place(add(large_square(8)), add(painted()), at({0, 0, 0}));
    CHECK(largest_difference(aov(view, "depth"), depth) <= 1e-6f);
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "object normals: they are those of the map, turned with the mesh, whatever its tangents are"
        * technique("bump.object-space-map")) {
    const ImageId tilted =
        add(ImageData{.name = "tilted", .width = 1, .height = 1, .pixels = {230, 128, 204, 255}});
    const Vec3 decoded = glm::normalize(Vec3(230, 128, 204) * (2.0f / 255) - 1.0f);
    Material stone = painted();
    stone.detail = SurfaceDetail::ObjectNormal;
    stone.normal_texture = {.image = tilted};
    const MaterialId material = add(stone);
    MeshData other = make_square();
    for (Vec4& tangent : other.tangents) {
        tangent = {0.6f, 0.8f, 0, -1};
    }
    const MeshId meshes[] = {add(make_square()), add(std::move(other))};
    for (const float turn : {0.0f, 0.5f, -0.8f}) {
        const Quat rotation = glm::angleAxis(turn, glm::normalize(Vec3(0.2f, 1, 0.4f)));
        for (const MeshId mesh : meshes) {
            world.clear();
            place(mesh, material, affine_from({0, 0, 0}, rotation, {1, 1, 1}));
            const gpu::FloatImage normals = aov(look({0, 0, 1.5f}, {0, 0, 0}, 16, 16), "normal");
            const Vec3 found = glm::normalize(rgb_at(normals, 8, 8));
            CHECK(glm::dot(found, rotation * decoded) >= 0.9999f);
        }
    }
}

TEST_CASE_FIXTURE(
    ReliefScene,
    "relief: far away a pyramid is as deep as the mean of its map" * technique("relief.filter")) {
    Material stone = carved(SurfaceDetail::Relief, add(pyramid_map()));
    stone.relief_texture.scale = {64, 64};
    place(add(make_square()), add(stone), at({0, 0, 0}));
    const Affine pose = look_at({0, 0, 20}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.5f / 20), .near = 1}, pose, pose, {.width = 16, .height = 16});
    // A pixel is two tiles wide: the last level of the map, whose mean is 2/3.
    CHECK(mean_of(aov(view, "depth"), 0) - 20 == near(kDepth * 2 / 3).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    ReliefScene, "relief: bump mapping tilts normals by the slope of the height"
                     * technique("bump.height-field")) {
    const ImageId pyramid = add(pyramid_map());
    Material bumpy = carved(SurfaceDetail::Bump, pyramid);
    bumpy.relief_depth = 0.5f;  // of a tile of 2 m, twice in each: faces have a slope of 1/2
    place(add(make_square()), add(bumpy), at({0, 0, 0}));
    const gpu::FloatImage normals = aov(look({0, 0, 1}, {0, 0, 0}, 64, 64), "normal");
    const auto check = [&](int x, int y, const Vec3& expected) {
        const Vec3 n = rgb_at(normals, x, y);
        CHECK(glm::dot(glm::normalize(n), glm::normalize(expected)) >= 0.9999f);
    };
    check(12, 32, {-0.5f, 0, 1});
    check(52, 32, {0.5f, 0, 1});
    check(32, 12, {0, 0.5f, 1});
    check(32, 52, {0, -0.5f, 1});
}

TEST_CASE(
    "relief: a material without a relief map, or a mesh without tangents, needs nothing of it"
    * technique("relief.selection")) {
    SurfaceFeatures features;
    features.hooks = material_hooks(Material{.detail = SurfaceDetail::Relief});
    add_hooks(features, {});
    CHECK(features == SurfaceFeatures{});

    features.maps.set(layout::kReliefSlot, 0);
    features.maps.set(layout::kNormalSlot, 1);
    features.hooks = material_hooks(Material{.detail = SurfaceDetail::Normal});
    add_hooks(features, {});
    CHECK_FALSE(features.maps.has(layout::kReliefSlot));
    CHECK(features.maps.has(layout::kNormalSlot));

    features.hooks = material_hooks(Material{.detail = SurfaceDetail::Flat});
    add_hooks(features, {});
    CHECK(features == SurfaceFeatures{});
}

}  // namespace limn::test::relief_test

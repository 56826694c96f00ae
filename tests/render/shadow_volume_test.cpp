#include "bench/oracles/shadow_volume_oracle.h"
#include "content/make/models/shapes.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/shadow/volume_list.h"
#include "tests/render/scene_fixture.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

// Stencil volumes on the GPU against rays on the CPU (shadow.stencil-pass, -stencil-frame,
// -vol-per-edge, -vol-per-triangle, -extrusion-distance, -closed-mesh, -density-view).

namespace limn::shadow_volume_test {
namespace {

using oracle::DTriangle;
using oracle::DVec3;
using test::at;

constexpr Shadow kVolumes = {.method = ShadowMethod::Volume};
constexpr int kWidth = 128;
constexpr int kHeight = 96;

MeshData make_shadow_torus() {
    return make_torus({.radius = 0.6f, .tube = 0.2f, .segments = 24, .sides = 12});
}

/// A floor that casts nothing, and casters of several kinds above it.
class VolumeScene : public test::Scene {
  public:
    VolumeScene() {
        cube = add(make_box({}));
        matte = add(Material{.base_color = {1, 1, 1, 1}, .roughness = 1});
    }

    /// Side 20 in the plane y = 0.
    void add_floor() {
        MeshData square = test::make_square();
        const Affine flat =
            affine_from({0, 0, 0}, glm::angleAxis(-0.5f * kPi, Vec3(1, 0, 0)), {10, 10, 1});
        world.add(place(add(std::move(square)), matte, flat), NoShadow{});
    }
    Entity add_caster(MeshId mesh, const Affine& pose) { return place(mesh, matte, pose); }

    void add_boxes() {
        add_caster(cube, at({0, 0.6f, 0}));
        add_caster(
            cube, affine_from(
                      {-1.8f, 1.4f, 0.5f}, glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 3))),
                      {0.4f, 1.6f, 0.3f}));
    }
    void add_casters() {
        add_boxes();
        add_caster(
            add(make_shadow_torus()),
            affine_from(
                {1.7f, 1.2f, -0.3f}, glm::angleAxis(1.1f, glm::normalize(Vec3(1, 0, 0.3f))),
                {-1, 1, 1}));  // mirrored
        add_caster(
            add(make_sphere({.radius = 0.4f, .segments = 20, .rings = 10})),
            at({0.5f, 0.5f, 1.6f}));
    }

    std::vector<DTriangle> caster_triangles() {
        std::vector<DTriangle> triangles;
        const auto& assets = world.resource<Assets>();
        std::as_const(world)
            .query<const MeshInstance, const WorldTransform, Without<NoShadow>>()
            .each([&](const MeshInstance& instance, const WorldTransform& now) {
                const MeshData& mesh = assets.meshes[instance.mesh.index];
                for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
                    DTriangle t;
                    for (std::size_t k = 0; k < 3; ++k) {
                        t[k] = transform_point(now.world, mesh.positions[mesh.indices[i + k]]);
                    }
                    triangles.push_back(t);
                }
            });
        return triangles;
    }

    [[nodiscard]] RenderView from(const Vec3& eye, const Vec3& target = {0, 0.5f, 0}) const {
        return look(eye, target, kWidth, kHeight);
    }

    MeshId cube;
    MaterialId matte;
};

/// Per pixel: 1 lit, 0 in shadow, -1 unlit even without shadows.
struct Visibility {
    std::vector<int> lit;
    int shadowed = 0;
    int counted = 0;
};

Visibility visibility(VolumeScene& scene, Entity light, const RenderView& view) {
    const gpu::FloatImage shaded = scene.radiance(view);
    const Shadow shadow = scene.world.get<Shadow>(light);
    scene.world.remove<Shadow>(light);
    const gpu::FloatImage open = scene.radiance(view);
    scene.world.add(light, shadow);
    Visibility found;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const float without = open.at(x, y, 0);
            const float with = shaded.at(x, y, 0);
            const bool counts = without > 1e-5f;
            const bool lit = with > 0.5f * without;
            // Nothing between: lit as without shadows, or not at all.
            CHECK((!counts || with == 0 || std::abs(with - without) < 1e-5f * without));
            found.lit.push_back(!counts ? -1 : lit ? 1 : 0);
            found.counted += counts ? 1 : 0;
            found.shadowed += counts && !lit ? 1 : 0;
        }
    }
    return found;
}

/// Pixels whose visibility differs from a ray's. `light` is homogeneous.
int count_wrong(
    VolumeScene& scene, const Visibility& found, const Vec4& light, const RenderView& view) {
    const gpu::FloatImage depth = scene.aov(view, "depth");
    const gpu::FloatImage normal = scene.aov(view, "normal");
    const std::vector<DTriangle> triangles = scene.caster_triangles();
    const auto& r = view.world_from_camera.row;
    const auto column = [&](int c) { return DVec3(r[0][c], r[1][c], r[2][c]); };
    int wrong = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int lit = found.lit[static_cast<std::size_t>(y * kWidth + x)];
            if (lit < 0) {
                continue;
            }
            const double px = (2 * (x + 0.5) / kWidth - 1) * view.tangent.x;
            const double py = (1 - 2 * (y + 0.5) / kHeight) * view.tangent.y;
            const double d = depth.at(x, y, 0);
            const DVec3 p = column(3) + d * (px * column(0) + py * column(1) - column(2))
                            + 1e-3 * DVec3(test::rgb_at(normal, x, y));
            const DVec3 to = light.w > 0 ? DVec3(Vec3(light)) : p + 100.0 * DVec3(Vec3(light));
            const bool lit_by_rays = !oracle::segment_hits(triangles, p, to);
            wrong += lit_by_rays == (lit == 1) ? 0 : 1;
        }
    }
    return wrong;
}

/// As a fraction of the pixels.
double disagreement(
    VolumeScene& scene, const Visibility& found, const Vec4& light, const RenderView& view) {
    return static_cast<double>(count_wrong(scene, found, light, view)) / std::max(found.counted, 1);
}

}  // namespace

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: a point light's volumes agree with ray casts"
                     * technique("shadow.stencil-pass, shadow.vol-per-triangle")) {
    add_floor();
    add_casters();
    const Vec3 position = {1.5f, 4, 2};
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at(position));
    world.add(light, kVolumes);
    for (const Vec3& eye : {Vec3(0.3f, 2.2f, 4.1f), Vec3(-4, 3, -2), Vec3(0.2f, 6, 0.3f)}) {
        const RenderView view = from(eye);
        for (const StencilMode mode : {StencilMode::Auto, StencilMode::ZFail}) {
            for (const VolumeKind kind : {VolumeKind::PerEdge, VolumeKind::PerTriangle}) {
                world.add(light, ShadowVolume{.kind = kind, .mode = mode});
                const Visibility found = visibility(*this, light, view);
                CHECK(found.shadowed > 200);
                CHECK(found.counted > 5000);
                CHECK(disagreement(*this, found, Vec4(position, 1), view) < 0.001);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: a sun's and a spot's volumes agree with ray casts"
                     * technique("shadow.stencil-pass")) {
    add_floor();
    add_casters();
    const RenderView view = from({-2, 2.5f, 4});
    SUBCASE("sun") {
        const Vec3 toward = glm::normalize(Vec3(0.4f, 0.8f, 0.3f));
        const Entity sun = shine(DirectionalLight{}, look_at({0, 0, 0}, -toward));
        world.add(sun, kVolumes);
        const Visibility found = visibility(*this, sun, view);
        CHECK(found.shadowed > 100);
        CHECK(disagreement(*this, found, Vec4(toward, 0), view) < 0.001);
    }
    SUBCASE("spot") {
        const Vec3 position = {-2, 5, 3};
        const Entity spot = shine(
            SpotLight{.intensity = 50, .radius = 12, .outer_angle = radians(35.0f)},
            look_at(position, {0, 0.5f, 0}));
        world.add(spot, kVolumes);
        const Visibility found = visibility(*this, spot, view);
        CHECK(found.shadowed > 100);
        CHECK(disagreement(*this, found, Vec4(position, 1), view) < 0.001);
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: scissor, depth bounds and culling keep all shadows of small lights"
                     * technique("shadow.caster-cull, shadow.depth-bounds")) {
    add_floor();
    add_boxes();  // no smooth shading, where it is a matter of taste what the light grazes
    // Between the light and the floor, so that the smallest light has shadows too.
    add_caster(cube, affine_from({-0.9f, 0.5f, 1.0f}, {1, 0, 0, 0}, Vec3(0.2f)));
    for (const float radius : {1.5f, 2.5f, 4.0f}) {
        const Vec3 position = {-0.7f, 1.2f, 0.9f};
        const Entity light = shine(
            PointLight{.radius = radius, .attenuation = {.falloff = Falloff::None}}, at(position));
        world.add(light, kVolumes);
        for (const Vec3& eye : {Vec3(0, 2, 4), Vec3(-1, 1.2f, 1.6f), Vec3(3, 0.7f, 2)}) {
            const RenderView view = from(eye, position);
            const Visibility found = visibility(*this, light, view);
            const int wrong = count_wrong(*this, found, Vec4(position, 1), view);
            CAPTURE(radius);
            CHECK(found.shadowed > 5);
            CHECK(found.counted > found.shadowed);
            CHECK(wrong <= found.counted / 1000);
        }
        world.destroy(light);
    }
}

TEST_CASE_FIXTURE(
    VolumeScene,
    "shadow_volume: inside volumes z-pass is off by one everywhere, z-fail and auto are right") {
    add_floor();
    add_caster(cube, affine_from({0, 3, 0}, {1, 0, 0, 0}, {3, 0.2f, 3}));
    const Vec3 position = {0, 6, 0};
    const Entity light = shine(PointLight{.intensity = 50, .radius = 20}, at(position));
    world.add(light, kVolumes);
    const RenderView view = from({0.3f, 1.2f, 0.4f}, {2.5f, 0.3f, 2.5f});
    world.add(light, ShadowVolume{.mode = StencilMode::Auto});
    const Visibility right = visibility(*this, light, view);
    CHECK(right.shadowed > 500);
    CHECK(right.counted - right.shadowed > 500);
    CHECK(disagreement(*this, right, Vec4(position, 1), view) < 0.001);
    world.add(light, ShadowVolume{.mode = StencilMode::ZPass});
    const Visibility off = visibility(*this, light, view);
    for (std::size_t i = 0; i < off.lit.size(); ++i) {
        REQUIRE((right.lit[i] < 0) == (off.lit[i] < 0));
        REQUIRE((right.lit[i] < 0 || off.lit[i] == 1 - right.lit[i]));
    }
}

TEST_CASE_FIXTURE(
    VolumeScene,
    "shadow_volume: from outside all volumes z-pass, z-fail and prisms give one image") {
    add_floor();
    add_casters();
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({1.5f, 4, 2}));
    world.add(light, kVolumes);
    const RenderView view = from({0.3f, 2.2f, 4.1f});
    const auto draw_by = [&](StencilMode mode, Extrusion extrusion, VolumeKind kind) {
        world.add(light, ShadowVolume{.kind = kind, .mode = mode, .extrusion = extrusion});
        return radiance(view);
    };
    const auto differing = [](const gpu::FloatImage& a, const gpu::FloatImage& b) {
        int count = 0;
        for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
            count += a.pixels[i] == b.pixels[i] ? 0 : 1;
        }
        return count;
    };
    const auto edges = VolumeKind::PerEdge;
    const auto z_fail = draw_by(StencilMode::ZFail, Extrusion::Infinite, edges);
    CHECK(
        differing(
            draw_by(StencilMode::ZPass, Extrusion::Constant, edges),
            draw_by(StencilMode::ZFail, Extrusion::Constant, edges))
        == 0);
    // Endless volumes count without caps, which the bias pushes out of the caster by 2 mm where the
    // light grazes it.
    CHECK(differing(draw_by(StencilMode::ZPass, Extrusion::Infinite, edges), z_fail) <= 4);
    CHECK(
        differing(draw_by(StencilMode::ZFail, Extrusion::Infinite, VolumeKind::PerTriangle), z_fail)
        <= kWidth * kHeight / 1000);
}
TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: where the near plane cuts a volume the image is still right"
                     * technique("shadow.stencil-pass")) {
    add_floor();
    add_caster(cube, affine_from({0, 3, 0}, {1, 0, 0, 0}, {3, 0.2f, 3}));
    const Vec3 position = {0, 6, 0};
    const Entity light = shine(PointLight{.intensity = 50, .radius = 20}, at(position));
    world.add(light, kVolumes);
    // The wall of the volume at y = 1 stands at x = 2.586.
    for (int i = -3; i <= 3; ++i) {
        const Vec3 eye = {2.586f + 0.015f * static_cast<float>(i), 1, 0.2f};
        const RenderView view = from(eye, eye + Vec3(-0.3f, -0.4f, 1));
        const Visibility found = visibility(*this, light, view);
        CHECK(disagreement(*this, found, Vec4(position, 1), view) < 0.001);
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: up to 255 nested volumes are counted; 256 alias to none"
                     * technique("shadow.stencil-pass")) {
    add_floor();
    const Entity light = shine(PointLight{.intensity = 50, .radius = 20}, at({0, 6, 0}));
    world.add(light, kVolumes);
    const RenderView view = from({4, 3, 0.1f});
    const auto lit_below = [&] {
        // The floor right below the cubes.
        const Vec4 clip = view.clip_from_world * Vec4(0.05f, 0, 0.05f, 1);
        const int x = static_cast<int>((0.5f * clip.x / clip.w + 0.5f) * kWidth);
        const int y = static_cast<int>((0.5f - 0.5f * clip.y / clip.w) * kHeight);
        return radiance(view).at(x, y, 0) > 0;
    };
    CHECK(lit_below());
    const auto add_cubes = [&](int from_count, int to_count) {
        for (int i = from_count; i < to_count; ++i) {
            const float scale = 0.5f + 0.001f * static_cast<float>(i);
            add_caster(cube, affine_from({0, 2, 0}, {1, 0, 0, 0}, Vec3(scale, 0.1f, scale)));
        }
    };
    add_cubes(0, 3);
    CHECK_FALSE(lit_below());
    add_cubes(3, 255);
    CHECK_FALSE(lit_below());
    add_cubes(255, 256);
    CHECK(lit_below());
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: the order of casters and lights changes nothing"
                     * technique("shadow.stencil-frame, shadow.stencil-pass")) {
    add_floor();
    const MeshId torus = add(make_shadow_torus());
    const auto draw_in_order = [&](bool backward) {
        std::vector<std::function<Entity()>> makers = {
            [&] {
                return add_caster(cube, at({0, 0.6f, 0}));
            },
            [&] {
                return add_caster(torus, at({0.8f, 1.5f, 0.2f}));
            },
            [&] {
                return add_caster(cube, at({0.4f, 1.8f, -0.9f}));
            }};
        if (backward) {
            std::reverse(makers.begin(), makers.end());
        }
        std::vector<Entity> made;
        for (const auto& make : makers) {
            made.push_back(make());
        }
        const gpu::FloatImage image = radiance(from({0.3f, 2.2f, 4.1f}));
        for (const Entity entity : made) {
            world.destroy(entity);
        }
        return image;
    };
    const Entity one = shine(PointLight{.intensity = 50, .radius = 15}, at({1.5f, 4, 2}));
    world.add(one, kVolumes);
    CHECK(draw_in_order(false).pixels == draw_in_order(true).pixels);

    const Entity two = shine(PointLight{.intensity = 30, .radius = 15}, at({-1.5f, 3, 2}));
    world.add(two, kVolumes);
    const gpu::FloatImage forward = draw_in_order(false);
    world.destroy(one);
    const Entity again = shine(PointLight{.intensity = 50, .radius = 15}, at({1.5f, 4, 2}));
    world.add(again, kVolumes);
    CHECK(test::largest_difference(forward, draw_in_order(false)) < 1e-5f);
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: lit is ambient and direct light, shadowed is ambient exactly"
                     * technique("shadow.stencil-frame")) {
    add_floor();
    add_casters();
    world.insert_resource(Environment{
        .sky = SkyKind::Uniform, .zenith = Vec3(0.3f), .intensity = 1, .visible = false});
    const RenderView view = from({0.3f, 2.2f, 4.1f});
    const gpu::FloatImage ambient = radiance(view);
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({1.5f, 4, 2}));
    const gpu::FloatImage open = radiance(view);
    world.add(light, kVolumes);
    const gpu::FloatImage shaded = radiance(view);
    int shadowed = 0;
    for (std::size_t i = 0; i < shaded.pixels.size(); ++i) {
        REQUIRE((shaded.pixels[i] == ambient.pixels[i] || shaded.pixels[i] == open.pixels[i]));
        shadowed += shaded.pixels[i] != open.pixels[i] ? 1 : 0;
    }
    CHECK(shadowed > 500);
}

TEST_CASE_FIXTURE(
    VolumeScene,
    "shadow_volume: nothing is shadowed without casters, or with casters in front or behind") {
    add_floor();
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({1.5f, 4, 2}));
    const RenderView view = from({0.3f, 2.2f, 4.1f});
    const gpu::FloatImage open = radiance(view);
    world.add(light, kVolumes);
    CHECK(radiance(view).pixels == open.pixels);

    // Beneath the floor, and its volume with it: behind the scene.
    add_caster(cube, at({0, -3, 0}));
    for (const StencilMode mode : {StencilMode::ZFail, StencilMode::ZPass}) {
        world.add(light, ShadowVolume{.mode = mode});
        CHECK(radiance(view).pixels == open.pixels);
    }
    // Above the camera and short: its volume ends before it hits any visible surface.
    add_caster(cube, affine_from({1, 3, 2}, {1, 0, 0, 0}, Vec3(0.2f)));
    world.add(
        light, ShadowVolume{
                   .mode = StencilMode::ZFail, .extrusion = Extrusion::Constant, .distance = 0.5f});
    const gpu::FloatImage before = radiance(view);
    int differ = 0;
    for (int x = 0; x < kWidth; ++x) {
        differ += before.at(x, kHeight - 1, 0) == open.at(x, kHeight - 1, 0) ? 0 : 1;
    }
    CHECK(differ == 0);
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: a light inside a closed caster lights nothing outside it") {
    add_floor();
    add_caster(cube, at({0, 2, 0}));
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({0.1f, 2.2f, 0.1f}));
    const RenderView view = from({0.3f, 2.2f, 4.1f});
    world.add(light, kVolumes);
    for (const float value : radiance(view).pixels) {
        REQUIRE((value == 0 || value == 1));  // alpha
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: an open mesh is reported once by name and its light has no volume"
                     * technique("shadow.closed-mesh, shadow.selection")) {
    add_floor();
    MeshData lid = test::make_square();
    lid.name = "lid of the box";
    const MeshId open_mesh = add(std::move(lid));
    const Affine flat =
        affine_from({0, 1, 0}, glm::angleAxis(-0.5f * kPi, Vec3(1, 0, 0)), {1, 1, 1});
    const Entity caster = add_caster(open_mesh, flat);
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({0.2f, 4, 0.3f}));
    world.add(light, kVolumes);
    const RenderView view = from({0.3f, 3.2f, 4.1f});
    const std::vector<std::string> messages = test::messages_of([&] {
        radiance(view);
        radiance(view);
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("lid of the box") != std::string::npos);
    CHECK(messages[0].find("4 open edges") != std::string::npos);
    CHECK_FALSE(frame_graph(test::shared_renderer()).was_run("shadow volumes"));

    // Prisms can cast it, from either side.
    world.add(light, ShadowVolume{.kind = VolumeKind::Mixed});
    const Vec4 position = {0.2f, 4, 0.3f, 1};
    Visibility found = visibility(*this, light, view);
    CHECK(found.shadowed > 100);
    CHECK(disagreement(*this, found, position, view) < 0.001);
    world.get<WorldTransform>(caster).world =
        affine_from({0, 1, 0}, glm::angleAxis(0.5f * kPi, Vec3(1, 0, 0)), {1, 1, 1});
    found = visibility(*this, light, view);
    CHECK(found.shadowed > 100);
    CHECK(disagreement(*this, found, position, view) < 0.001);
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: a material with holes is reported; prisms cast the full shape"
                     * technique("shadow.map-alpha, shadow.selection")) {
    add_floor();
    const MaterialId holes =
        add(Material{.name = "lattice", .alpha_mode = AlphaMode::Mask, .alpha_cutoff = 0.5f});
    place(cube, holes, at({0, 1, 0}));
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({0.2f, 4, 0.3f}));
    world.add(light, kVolumes);
    const RenderView view = from({0.3f, 3.2f, 4.1f});
    const std::vector<std::string> messages = test::messages_of([&] {
        radiance(view);
        radiance(view);
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("lattice") != std::string::npos);
    CHECK_FALSE(frame_graph(test::shared_renderer()).was_run("shadow volumes"));
    world.add(light, ShadowVolume{.kind = VolumeKind::Mixed});
    const Visibility found = visibility(*this, light, view);
    CHECK(found.shadowed > 50);
    CHECK(disagreement(*this, found, {0.2f, 4, 0.3f, 1}, view) < 0.001);
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: of nine lights eight have volumes, the ninth is reported once") {
    add_floor();
    add_caster(cube, at({0, 1, 0}));
    for (int i = 0; i < 9; ++i) {
        const float a = 0.7f * static_cast<float>(i);
        const Entity light =
            shine(PointLight{.intensity = 5, .radius = 15}, at({std::sin(a), 4, std::cos(a)}));
        world.add(light, kVolumes);
    }
    const std::vector<std::string> messages = test::messages_of([&] {
        radiance(from({0.3f, 3.2f, 4.1f}));
        radiance(from({0.3f, 3.2f, 4.1f}));
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("more than 8") != std::string::npos);
    FrameGraph& graph = frame_graph(test::shared_renderer());
    CHECK(graph.spec(graph.find("shadow.mask")).depth == 8);
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow_volume: extruded by radius, light leaks behind the cap, else it does not"
                     * technique("shadow.extrusion-distance")) {
    // A long bar close to the light: the center of the far cap is much nearer than its ends.
    MeshData floor = test::make_square();
    world.add(
        place(
            add(std::move(floor)), matte,
            affine_from({0, 0, 0}, glm::angleAxis(-0.5f * kPi, Vec3(1, 0, 0)), {20, 20, 1})),
        NoShadow{});
    add_caster(cube, affine_from({0, 9, 0}, {1, 0, 0, 0}, {4, 0.1f, 1}));
    const Vec3 light_position = {0, 10, 0};
    const Entity light = shine(
        PointLight{.intensity = 500, .radius = 14, .attenuation = {.falloff = Falloff::None}},
        at(light_position));
    world.add(light, kVolumes);
    const RenderView view = from({0.1f, 14, 0.2f}, {0, 0, 0});
    const auto wrong = [&](Extrusion extrusion, VolumeKind kind) {
        world.add(
            light, ShadowVolume{.kind = kind, .mode = StencilMode::ZFail, .extrusion = extrusion});
        return disagreement(*this, visibility(*this, light, view), Vec4(light_position, 1), view);
    };
    CHECK(wrong(Extrusion::Radius, VolumeKind::PerEdge) > 0.01);
    CHECK(wrong(Extrusion::Plane, VolumeKind::PerTriangle) < 0.001);
    CHECK(wrong(Extrusion::Infinite, VolumeKind::PerEdge) < 0.001);
    CHECK(wrong(Extrusion::Plane, VolumeKind::PerEdge) < 0.001);  // endless: corners are shared
}

TEST_CASE_FIXTURE(VolumeScene, "shadow_volume: moved casters and replaced assets take effect") {
    add_floor();
    const Entity caster = add_caster(cube, at({0, 1, 0}));
    const Vec3 light_position = {0.4f, 5, 0.3f};
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at(light_position));
    world.add(light, kVolumes);
    const RenderView view = from({0.3f, 3.2f, 4.1f});
    for (int i = 0; i < 3; ++i) {
        world.get<WorldTransform>(caster).world = at({0.5f * static_cast<float>(i), 1, 0});
        const Visibility found = visibility(*this, light, view);
        CHECK(disagreement(*this, found, Vec4(light_position, 1), view) < 0.001);
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "hybrid: the image equals that of volumes, which are counted at few pixels"
                     * technique("shadow.hybrid-edge")) {
    add_floor();
    add_boxes();
    const RenderView view = from({0.3f, 3.2f, 4.1f});
    const Vec3 position = {1.5f, 4, 2};
    Entity light;
    SUBCASE("spot") {
        light = shine(
            SpotLight{.intensity = 50, .radius = 12, .outer_angle = radians(40.0f)},
            look_at(position, {0, 0.5f, 0}));
    }
    SUBCASE("point light") {
        light = shine(PointLight{.intensity = 50, .radius = 12}, at(position));
    }
    SUBCASE("sun") {
        light = shine(DirectionalLight{}, look_at({5, 3, 4}, {0, 0, 0}));
    }
    world.add(light, kVolumes);
    const Visibility exact = visibility(*this, light, view);
    CHECK(exact.shadowed > 100);
    world.add(light, Shadow{.method = ShadowMethod::Hybrid});
    const Visibility hybrid = visibility(*this, light, view);
    int differ = 0;
    for (std::size_t i = 0; i < exact.lit.size(); ++i) {
        differ += exact.lit[i] == hybrid.lit[i] ? 0 : 1;
    }
    CHECK(differ <= exact.counted / 1000);
}

TEST_CASE_FIXTURE(
    VolumeScene, "hybrid: where light grazes round casters the image equals that of volumes"
                     * technique("shadow.hybrid-edge")) {
    add_floor();
    add_caster(
        add(make_torus({.radius = 0.7f, .tube = 0.3f, .segments = 32, .sides = 16})),
        at({0, 1, 0}));
    const RenderView view = from({1.2f, 1.8f, 1.6f}, {0, 0.9f, 0});
    const Entity light = shine(PointLight{.intensity = 50, .radius = 12}, at({1.5f, 3, -1}));
    world.add(light, kVolumes);
    const Visibility exact = visibility(*this, light, view);
    world.add(light, Shadow{.method = ShadowMethod::Hybrid});
    const Visibility hybrid = visibility(*this, light, view);
    int differ = 0;
    for (std::size_t i = 0; i < exact.lit.size(); ++i) {
        differ += exact.lit[i] == hybrid.lit[i] ? 0 : 1;
    }
    CHECK(differ <= exact.counted / 1000);
}

TEST_CASE_FIXTURE(
    VolumeScene,
    "hybrid: away from the map's edges no volume is counted" * technique("shadow.hybrid-edge")) {
    add_floor();
    add_caster(cube, affine_from({0, 3, 0}, {1, 0, 0, 0}, {3, 0.2f, 3}));
    const Entity light = shine(PointLight{.intensity = 50, .radius = 20}, at({0, 6, 0}));
    const RenderView view = from({0.3f, 1.2f, 0.4f}, {2.5f, 0.3f, 2.5f});
    // From within the volume z-pass counts every pixel wrongly that it counts.
    world.add(light, Shadow{.method = ShadowMethod::Hybrid});
    const Visibility right = visibility(*this, light, view);
    world.add(light, ShadowVolume{.mode = StencilMode::ZPass});
    const Visibility wrong = visibility(*this, light, view);
    int differ = 0;
    int farthest = 0;  // of these from where light and shadow meet [px]
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            if (right.lit[i] == wrong.lit[i]) {
                continue;
            }
            ++differ;
            int nearest = kWidth;
            for (int v = 0; v < kHeight; ++v) {
                for (int u = 0; u < kWidth; ++u) {
                    if (right.lit[static_cast<std::size_t>(v * kWidth + u)] == 1 - right.lit[i]) {
                        nearest = std::min(nearest, std::max(std::abs(u - x), std::abs(v - y)));
                    }
                }
            }
            farthest = std::max(farthest, nearest);
        }
    }
    CHECK(right.shadowed > 500);
    CHECK(differ > 20);
    CHECK(differ < right.counted / 5);
    CHECK(farthest <= 2);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "hybrid: the seven bits of the count wrap below the edge bit"
                          * technique("shadow.hybrid-edge")) {
    const gpu::Texture depth("depth", {.format = GL_DEPTH32F_STENCIL8, .width = 4, .height = 4});
    const gpu::Framebuffer target("target", {}, {&depth});
    const Result<const gpu::Program*> program =
        device().shaders().load({.vertex = "fullscreen.vert", .fragment = "shadow_volume.frag"});
    REQUIRE(program.ok());
    device().bind_framebuffer(target);
    glClearNamedFramebufferfi(target.id(), GL_DEPTH_STENCIL, 0, 0, 0x80);
    const auto count = [&](GLenum operation) {
        gpu::PipelineState state = gpu::kFullscreenState;
        const gpu::StencilFace face = {.func = GL_EQUAL, .pass = operation};
        state.stencil = {
            .test = true,
            .reference = 0x80,
            .read_mask = 0x80,
            .write_mask = 0x7f,
            .front = face,
            .back = face};
        device().use(gpu::Pipeline{*program, state});
        device().draw_fullscreen();
        std::uint8_t value = 0;
        glReadPixels(1, 1, 1, 1, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, &value);
        return static_cast<int>(value);
    };
    CHECK(count(GL_DECR_WRAP) == 0xff);
    CHECK(count(GL_INCR_WRAP) == 0x80);
    CHECK(count(GL_INCR_WRAP) == 0x81);
}

TEST_CASE_FIXTURE(
    VolumeScene, "volume_layers: a ball's volume has two layers, prisms have many more"
                     * technique("shadow.density-view")) {
    add_floor();
    add_caster(add(make_sphere({.radius = 0.5f, .segments = 24, .rings = 12})), at({0, 2, 0}));
    const Entity light = shine(PointLight{.intensity = 50, .radius = 20}, at({0.1f, 5, 0.2f}));
    world.add(light, kVolumes);
    const RenderView view = from({0.2f, 2.5f, 4});
    const auto layers = [&](VolumeKind kind) {
        world.add(light, ShadowVolume{.kind = kind, .mode = StencilMode::ZFail});
        return aov(view, "volume_layers");
    };
    const auto sum = [](const gpu::FloatImage& image) {
        double total = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            total += static_cast<double>(image.pixels[i]);
        }
        return total;
    };
    const gpu::FloatImage per_edge = layers(VolumeKind::PerEdge);
    int two = 0;
    int other = 0;
    for (std::size_t i = 0; i < per_edge.pixels.size(); i += 4) {
        two += per_edge.pixels[i] == 2 ? 1 : 0;
        other += per_edge.pixels[i] != 0 && per_edge.pixels[i] != 2 ? 1 : 0;
    }
    CHECK(two > 500);
    CHECK(other < two / 50);  // on its outline
    CHECK(sum(layers(VolumeKind::PerTriangle)) > 3 * sum(per_edge));
    world.remove<Shadow>(light);
    CHECK(sum(aov(view, "volume_layers")) == 0);
}

TEST_CASE("volume_list: a caster is kept if its shadow contains the eye or is in view") {
    const Bounds box = {{-1, 4, -1}, {1, 5, 1}};
    const Vec4 light = {0, 10, 0, 1};
    CHECK(shadow_may_contain(box, light, {0, 0, 0}, 0.1f));
    CHECK(shadow_may_contain(box, light, {1.6f, 0, 0}, 0.1f));
    CHECK_FALSE(shadow_may_contain(box, light, {3, 0, 0}, 0.1f));
    CHECK_FALSE(shadow_may_contain(box, light, {0, 8, 0}, 0.1f));  // between light and caster
    CHECK(shadow_may_contain(box, {0, 1, 0, 0}, {0.5f, -50, 0.5f}, 0.1f));
    CHECK_FALSE(shadow_may_contain(box, {0, 1, 0, 0}, {1.5f, -50, 0.5f}, 0.1f));
    CHECK_FALSE(shadow_may_contain(box, {0, 1, 0, 0}, {0.5f, 6, 0.5f}, 0.1f));

    // Looking along -z from the origin, at the height of the ground.
    const Affine pose = look_at({0, 0, 0}, {0, 0, -1});
    const RenderView view =
        make_render_view({.fov_y = radians(60.0f), .near = 0.1f}, pose, pose, {});
    const Frustum frustum = make_frustum(view.clip_from_world);
    const Bounds above = {{-1, 20, -11}, {1, 21, -9}};
    CHECK_FALSE(shadow_is_outside(above, {0, 30, -10, 1}, frustum));  // falls into the image
    CHECK(shadow_is_outside(above, {0, 10, -10, 1}, frustum));        // rises out of it
    const Bounds behind = {{-1, -1, 4}, {1, 1, 5}};
    CHECK_FALSE(shadow_is_outside(behind, {0, 0, 9, 1}, frustum));
    CHECK(shadow_is_outside(behind, {0, 0, -9, 1}, frustum));
    CHECK(shadow_is_outside(behind, {0, 0, -1, 0}, frustum));
}

TEST_CASE(
    "shadow selection: only auto is resolved, by whether the light has a ShadowVolume"
    * technique("shadow.selection")) {
    using enum ShadowMethod;
    CHECK(choose_shadow_method(Auto, false) == Map);
    CHECK(choose_shadow_method(Auto, true) == Volume);
    for (const ShadowMethod wanted : {Map, Perspective, Volume, Hybrid}) {
        CHECK(choose_shadow_method(wanted, false) == wanted);
        CHECK(choose_shadow_method(wanted, true) == wanted);
    }
}

TEST_CASE_FIXTURE(
    VolumeScene, "shadow selection: auto uses a map, and volumes with a ShadowVolume component"
                     * technique("shadow.selection")) {
    add_floor();
    add_caster(cube, at({0, 1, 0}));
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({0.2f, 4, 0.3f}));
    const RenderView view = from({0.3f, 3.2f, 4.1f});
    const auto dark = [&] { return visibility(*this, light, view).shadowed; };
    world.add(light, Shadow{.filter = ShadowFilter::Hard});
    CHECK(dark() > 50);
    CHECK_FALSE(frame_graph(test::shared_renderer()).was_run("shadow volumes"));
    world.add(light, ShadowVolume{});
    CHECK(dark() > 50);
    radiance(view);
    CHECK(frame_graph(test::shared_renderer()).was_run("shadow volumes"));
}

}  // namespace limn::shadow_volume_test

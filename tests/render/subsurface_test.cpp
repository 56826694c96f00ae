#include "bench/oracles/skin_light_oracle.h"
#include "content/make/models/shapes.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/material/diffusion_profile.h"
#include "tests/near.h"
#include "tests/render/profile_renderer.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

// Light that spreads under a surface (render/light/subsurface_pass.h), against the profile in
// double precision.

namespace limn::test::subsurface_test {
namespace {

using oracle::DVec3;

/// Mean free paths of skin, forty times as large.
constexpr Vec3 kFreePath = {0.147f, 0.0548f, 0.0272f};
constexpr int kSide = 256;  ///< of images [px]
constexpr gpu::Profile kProfiles[] = {gpu::Profile::Software, gpu::Profile::Gpu};

/// Draws diffusion (Software) or computes it (Gpu), in 32-bit floats.
ProfileRenderer& renderer_of(gpu::Profile profile) {
    static ProfileRenderer software(gpu::Profile::Software);
    static ProfileRenderer gpu(gpu::Profile::Gpu, {.full_float = true});
    return profile == gpu::Profile::Gpu ? gpu : software;
}

Material wax(const Vec3& free_path = kFreePath) {
    return {
        .shading = ShadingModel::Subsurface,
        .base_color = {0.55f, 0.34f, 0.26f, 1},
        .roughness = 0.9f,
        .specular = {0, 0, 0},
        .scatter = free_path,
        .gloss = 0};
}

DVec3 scales(const Material& material) {
    return oracle::diffusion_scales(DVec3(Vec3(material.base_color)), DVec3(material.scatter));
}

/// A plane in z = 0 under a light from the right, at 45 degrees, that shines past casters out of
/// view.
class LitPlane : public Scene {
  public:
    explicit LitPlane(const Material& material) : square(add(make_square())) {
        world.add(
            place(square, add(material), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(30))),
            NoShadow{});
        world.insert_resource(Rendering{.infinite_viewer = true});
    }
    void shine_past() {
        world.add(
            shine(DirectionalLight{.illuminance = 2}, look_at({0, 0, 0}, {-1, 0, -1})),
            Shadow{.method = ShadowMethod::Volume});
    }
    /// The shadow of a thin box over `from` < x < `to` in the plane.
    void darken(float from, float to) {
        constexpr float kHeight = 20;
        place(
            add(make_box({.size = {to - from, 40, 1e-4f}})), add(Material{}),
            at({0.5f * (from + to) + kHeight, 0, kHeight}));
    }
    MeshId square;
};

/// Position of the corner of a pixel, or of a fraction of one, in z = 0.
DVec3 point_at(const RenderView& view, double x, double y) {
    const DVec3 ray = DVec3(transform_vector(
        view.world_from_camera, {(2 * x / view.width - 1) * view.tangent.x,
                                 (1 - 2 * y / view.height) * view.tangent.y, -1}));
    const DVec3 eye = {
        view.world_from_camera.row[0].w, view.world_from_camera.row[1].w,
        view.world_from_camera.row[2].w};
    return eye - ray * (eye.z / ray.z);
}

/// Largest difference of each channel from the convolution of the image without diffusion with the
/// profile, one patch per pixel, along a row and a column through the center; relative to the lit
/// plane, by either renderer.
DVec3 largest_errors(LitPlane& scene, const RenderView& view) {
    auto& assets = scene.world.resource<Assets>();
    const Material material = assets.materials[0];
    const DVec3 d = scales(material);
    const gpu::FloatImage found[] = {
        renderer_of(kProfiles[0]).radiance(scene.world, view),
        renderer_of(kProfiles[1]).radiance(scene.world, view)};
    assets.materials[0].scatter = Vec3(0);
    ++assets.material_version;
    const gpu::FloatImage before = scene.radiance(view);
    assets.materials[0] = material;
    ++assets.material_version;

    std::vector<oracle::LitPatch> patches;
    double brightest = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const DVec3 center = point_at(view, x + 0.5, y + 0.5);
            patches.push_back(
                {center, point_at(view, x + 1.0, y + 0.5) - point_at(view, x, y + 0.5),
                 point_at(view, x + 0.5, y + 1.0) - point_at(view, x + 0.5, y),
                 static_cast<double>(before.at(x, y, 0))});
            brightest = std::max(brightest, patches.back().light);
        }
    }
    DVec3 errors(0);
    for (int i = kSide / 4; i < 3 * kSide / 4; ++i) {
        for (const auto& [x, y] : {std::pair(i, kSide / 2), std::pair(kSide / 2, i)}) {
            for (int c = 0; c < 3; ++c) {
                const double exact = oracle::diffused_patches(
                    patches, static_cast<std::size_t>(y * view.width + x), d[c]);
                const double scale = static_cast<double>(material.base_color.x)
                                     / static_cast<double>(material.base_color[c]);
                for (const gpu::FloatImage& image : found) {
                    const auto light = static_cast<double>(image.at(x, y, c)) * scale;
                    errors[c] = std::max(errors[c], std::abs(light - exact) / brightest);
                }
            }
        }
    }
    return errors;
}

/// The view from `eye` to the origin, turned about its axis.
RenderView turned(const Vec3& eye, float roll) {
    Affine pose = look_at(eye, {0, 0, 0});
    pose = pose * affine_from({0, 0, 0}, glm::angleAxis(roll, Vec3(0, 0, 1)), {1, 1, 1});
    return make_render_view(
        {.fov_y = radians(90.0f), .near = 0.05f}, pose, pose, {.width = kSide, .height = kSide});
}

}  // namespace

TEST_CASE(
    "diffusion profile: the rings of every channel hold all of its light, from the inside out"
    * technique("skin.diffusion")) {
    for (const Vec3& d : {Vec3(0.98f, 0.39f, 0.19f), Vec3(1, 1, 1), Vec3(1, 0, 0.5f)}) {
        for (const DiffusionDensity& density : {kDensityNear, kDensityFar, kDensityFarther}) {
            std::array<Vec4, 48> rings;
            sample_diffusion(d, density, rings);
            DVec3 sum(0);
            for (std::size_t i = 0; i < rings.size(); ++i) {
                sum += DVec3(rings[i].y, rings[i].z, rings[i].w);
                CHECK(rings[i].x >= (i == 0 ? 0.0f : rings[i - 1].x));
            }
            CHECK(glm::length(sum - 1.0) < 1e-5);
        }
    }
}

TEST_CASE(
    "diffusion profile: at a distance the first ring stands for many"
    * technique("skin.diffusion")) {
    const Vec3 d = {0.98f, 0.39f, 0.19f};
    std::array<Vec4, 20> many;
    std::array<Vec4, 20> one;
    sample_diffusion(d, kDensityFar, many);
    sample_diffusion(d, kDensityFarther, one);
    // 0.3 of the samples are six of 20.
    for (int c = 1; c < 4; ++c) {
        float held = 0;
        for (int i = 0; i < 6; ++i) {
            held += many[static_cast<std::size_t>(i)][c];
        }
        CHECK(one[0][c] == near(held).epsilon(1e-5));
    }
    // The others are as dense as 19 / 0.7 samples: their last one stands for less than that of 20.
    CHECK(one[19].x > many[19].x);
}

TEST_CASE(
    "diffusion profile: a ring's weight is the integral of the profile over it"
    * technique("skin.diffusion")) {
    const double d = 0.39;
    double sum = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
        const double r = 1.5 * (i + 0.5) / kSteps;
        sum += oracle::diffusion_profile(r, d) * 2 * kPi * r * 1.5 / kSteps;
    }
    CHECK(sum == near(diffused_within(1.5, d)).epsilon(1e-6));
    CHECK(diffused_within(1e4, d) == near(1.0));
    const Vec3 scale = diffusion_distance({0.55f, 0.34f, 0.9f}, {3.67f, 1.37f, 0.68f});
    CHECK(scale.x == near(oracle::diffusion_scale(0.55, 3.67)));
    CHECK(scale.z == near(oracle::diffusion_scale(0.9, 0.68)));
}

TEST_CASE(
    "subsurface: light spreads across an edge as the profile says, at any distance and tilt"
    * technique("skin.diffusion")) {
    LitPlane scene(wax());
    scene.darken(-30, 0);
    scene.shine_past();
    for (const RenderView& view :
         {turned({0, 0, 1}, 0), turned({0, 0, 1}, 0.5f), turned({0, 0, 2.2f}, 1.2f),
          turned({0, 0, 5.2f}, 0.9f), turned({0, 0, 8}, 0.7f), turned({0.6f, 0, 1.0f}, 0),
          turned({0, -0.6f, 1.0f}, 0)}) {
        const DVec3 errors = largest_errors(scene, view);
        CAPTURE(errors.x);
        CAPTURE(errors.y);
        CAPTURE(errors.z);
        CHECK(std::max({errors.x, errors.y, errors.z}) < 0.01);
    }
}

TEST_CASE("subsurface: a thin line of light becomes the profile" * technique("skin.diffusion")) {
    LitPlane scene(wax());
    constexpr float kWidth = 8.0f / kSide;  // four pixels
    scene.darken(-30, -0.5f * kWidth);
    scene.darken(0.5f * kWidth, 30);
    scene.shine_past();
    const DVec3 errors = largest_errors(scene, turned({0, 0, 1}, 0));
    CAPTURE(errors.x);
    CAPTURE(errors.y);
    CAPTURE(errors.z);
    CHECK(std::max({errors.x, errors.y, errors.z}) < 0.01);
}

TEST_CASE(
    "subsurface: an evenly lit plane is as bright as without diffusion"
    * technique("skin.diffusion")) {
    for (const Vec3& eye : {Vec3(0, 0, 1), Vec3(0.9f, 0.3f, 0.5f), Vec3(0, 0, 3)}) {
        for (const gpu::Profile profile : kProfiles) {
            ProfileRenderer& renderer = renderer_of(profile);
            gpu::FloatImage images[2];
            for (const bool spread : {false, true}) {
                LitPlane scene(wax(spread ? kFreePath : Vec3(0)));
                scene.shine_past();
                images[spread ? 1 : 0] = renderer.radiance(scene.world, turned(eye, 0.3f));
                CHECK(renderer.graph().was_run("subsurface") == spread);
            }
            CHECK(images[0].at(128, 128, 0) > 0.1f);
            CHECK(largest_difference(images[0], images[1]) < 1e-5f);
        }
    }
}

TEST_CASE(
    "subsurface: no light diffuses from or to surfaces that do not scatter"
    * technique("skin.diffusion")) {
    LitPlane scene(wax());
    scene.darken(-30, 0);
    scene.shine_past();
    // A lit floor begins where the shadow on the wax ends, a hair above it.
    scene.world.add(
        scene.place(scene.square, scene.add(Material{.roughness = 1}), at({1, 0, 1e-4f})),
        NoShadow{});
    for (const gpu::Profile profile : kProfiles) {
        const gpu::FloatImage image =
            renderer_of(profile).radiance(scene.world, turned({0, 0, 1}, 0));
        for (int x = 0; x < kSide; ++x) {
            const float red = image.at(x, 128, 0);
            const bool floor = x >= kSide / 2;
            CHECK((floor ? std::abs(red - image.at(200, 128, 0)) : red) < 1e-4f);
        }
    }
}

TEST_CASE("subsurface: light diffuses wherever a surface is visible, also at the image's edges") {
    for (const Vec3& position : {Vec3(0, 0, 0), Vec3(1.9f, 0.5f, 0), Vec3(-0.7f, -1.9f, 0.3f)}) {
        std::array<gpu::FloatImage, 2> images[2];
        for (const bool another_behind : {false, true}) {
            Scene scene;
            const MeshId ball = scene.add(make_ball());
            const MaterialId skin = scene.add(wax());
            scene.place(ball, skin, at(position));
            if (another_behind) {
                scene.place(ball, skin, at({0, 0, 2}));  // around the camera: its box is all pixels
            }
            scene.shine(PointLight{.intensity = 20, .radius = 0}, at({1, 1, 3}));
            for (const std::size_t i : {0u, 1u}) {
                images[another_behind ? 1 : 0][i] =
                    renderer_of(kProfiles[i]).radiance(scene.world, turned({0, 0, 2}, 0));
            }
        }
        CHECK(largest_difference(images[0][0], images[1][0]) == 0);
        CHECK(largest_difference(images[0][1], images[1][1]) == 0);
    }
}

namespace {

/// Two balls of wax, one half out of the image, before a wall that does not scatter.
class WaxBalls : public Scene {
  public:
    explicit WaxBalls(const Vec3& free_path = kFreePath) {
        const MeshId ball = add(make_ball());
        const MaterialId skin = add(wax(free_path));
        place(ball, skin, at({-0.4f, 0.1f, 0}));
        place(ball, skin, at({3.1f, -1.2f, -0.5f}));
        place(add(make_square()), add(Material{}), affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(9)));
        shine(DirectionalLight{.illuminance = 3}, look_at({0, 0, 0}, {-1, -0.5f, -1}));
    }
    /// 250 x 131 px, no multiple of a work group.
    [[nodiscard]] RenderView full_view() const { return look({0, 0, 3}, {0, 0, 0}, 250, 131); }
};

int dispatches(ProfileRenderer& renderer, const Scene& scene, const RenderView& view) {
    renderer.draw(scene.world, view);
    return renderer.stats().dispatches;
}

}  // namespace

TEST_CASE(
    "subsurface: a GPU computes the same as a software OpenGL draws"
    * technique("skin.diffusion")) {
    const WaxBalls scene;
    const RenderView view = scene.full_view();
    const gpu::FloatImage drawn = renderer_of(gpu::Profile::Software).radiance(scene.world, view);
    const gpu::FloatImage computed = renderer_of(gpu::Profile::Gpu).radiance(scene.world, view);
    // Hardware has its own filter for mip levels of odd sizes; NVIDIA's differs by 0.0064.
    CHECK(largest_difference(drawn, computed) < (Scene::device().caps().software ? 1e-6f : 0.02f));

    // Half floats: what is spread, what it is added to and the sum are rounded or truncated.
    const gpu::FloatImage half = ProfileRenderer(gpu::Profile::Gpu).radiance(scene.world, view);
    float largest = 0;
    for (std::size_t i = 0; i < half.pixels.size(); ++i) {
        const float exact = computed.pixels[i];
        largest = std::max(largest, std::abs(half.pixels[i] - exact) / std::max(exact, 0.05f));
    }
    CHECK(largest < 3.0f / 1024);
}

TEST_CASE("subsurface: pixels of other surfaces keep every bit" * technique("skin.diffusion")) {
    WaxBalls scene;
    const WaxBalls dull(Vec3(0));
    const RenderView view = scene.full_view();
    const gpu::FloatImage albedo = scene.aov(view, "albedo");
    for (const gpu::Profile profile : kProfiles) {
        const gpu::FloatImage with = renderer_of(profile).radiance(scene.world, view);
        const gpu::FloatImage without = renderer_of(profile).radiance(dull.world, view);
        int changed = 0;
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                const bool same = rgb_at(with, x, y) == rgb_at(without, x, y);
                const bool is_wax = albedo.at(x, y, 0) < 0.6f;  // the wall is brighter
                CHECK((same || is_wax));
                CHECK(with.at(x, y, 3) == without.at(x, y, 3));
                changed += same ? 0 : 1;
            }
        }
        CHECK(changed > 1000);
    }
}

TEST_CASE(
    "subsurface: a GPU computes it, and dispatches nothing where no skin is in view"
    * technique("skin.diffusion")) {
    const WaxBalls scene;
    const WaxBalls dull(Vec3(0));
    const RenderView behind = scene.look({0, 0, 3}, {0, 0, 9});
    const RenderView aside = scene.look({-9, 0, 3}, {-9, 0, 0});
    for (const gpu::Profile profile : kProfiles) {
        ProfileRenderer& renderer = renderer_of(profile);
        const int count = dispatches(renderer, scene, scene.full_view());
        CHECK(renderer.graph().was_run("subsurface"));
        // Distances, five mip levels of two textures, diffusion.
        const int expected = profile == gpu::Profile::Gpu ? 1 + 2 * 5 + 1 : 0;
        CHECK(count - dispatches(renderer, dull, scene.full_view()) == expected);
        for (const RenderView& away : {behind, aside}) {
            const int found = dispatches(renderer, scene, away);
            CHECK_FALSE(renderer.graph().was_run("subsurface"));
            CHECK(found == dispatches(renderer, dull, away));
        }
    }
}

TEST_CASE("subsurface: highlights are not spread" * technique("skin.diffusion")) {
    gpu::FloatImage images[2];
    for (const bool spread : {false, true}) {
        Material black = wax(spread ? kFreePath : Vec3(0));
        black.base_color = {1e-3f, 1e-3f, 1e-3f, 1};
        black.roughness = 0.3f;
        black.specular = Vec3(0.03f);
        Scene scene;
        scene.place(scene.add(make_ball()), scene.add(black), at({0, 0, 0}));
        scene.shine(PointLight{.intensity = 20, .radius = 0}, at({1, 1, 3}));
        images[spread ? 1 : 0] = scene.radiance(scene.look({0, 0, 2}, {0, 0, 0}));
    }
    CHECK(largest_difference(images[0], images[1]) < 2e-3f);
    float brightest = 0;
    for (int i = 0; i < images[1].width * images[1].height; ++i) {
        brightest = std::max(brightest, images[1].at(i % images[1].width, i / images[1].width, 0));
    }
    CHECK(brightest > 0.05f);
}

TEST_CASE(
    "subsurface: dark skin behind a bright edge of skin stays dark" * technique("skin.diffusion")) {
    Scene scene;
    const MeshId square = scene.add(make_square());
    const MaterialId skin = scene.add(wax());
    scene.place(square, skin, affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(4)));
    scene.place(square, skin, at({1, 0, 0}));
    // Its range includes the plate in front, not the wall.
    scene.shine(PointLight{.intensity = 4, .radius = 0.7f}, at({0.2f, 0, 0.4f}));
    for (const gpu::Profile profile : kProfiles) {
        const gpu::FloatImage image =
            renderer_of(profile).radiance(scene.world, turned({0, 0, 1}, 0));
        const float edge = image.at(kSide / 2 + 1, kSide / 2, 0);
        CHECK(edge > 0.05f);
        for (int x = 0; x < kSide / 2; ++x) {
            CAPTURE(x);
            CHECK(image.at(x, kSide / 2, 0) < 3e-3f * edge);
        }
    }
}

namespace {

/// What leaves a slab of wax toward the camera, lit from behind.
Vec3 behind_slab(float thickness, const auto& light, const Affine& from) {
    Scene scene;
    scene.place(
        scene.add(make_box({.size = {2, 2, thickness}})), scene.add(wax()),
        at({0, 0, -0.5f * thickness}));
    scene.world.insert_resource(Rendering{.infinite_viewer = true});
    scene.world.add(
        scene.shine(light, from), Shadow{.method = ShadowMethod::Map, .resolution = 1024});
    return rgb_at(scene.radiance(scene.look({0, 0, 0.8f}, {0, 0, 0}, 65, 65)), 32, 32);
}

void check_slab(const Vec3& found, double irradiance, double path) {
    const Material material = wax();
    const DVec3 d = scales(material);
    for (int c = 0; c < 3; ++c) {
        const double expected = static_cast<double>(material.base_color[c]) * irradiance
                                / static_cast<double>(kPi) * oracle::transmitted(path, d[c]);
        CHECK(static_cast<double>(found[c]) == near(expected).epsilon(0.02));
    }
}

}  // namespace

TEST_CASE(
    "subsurface: a slab lit from behind transmits the integral of the profile beyond it"
    * technique("skin.transmission")) {
    const DirectionalLight sun = {.illuminance = 3};
    for (const float thickness : {0.01f, 0.03f, 0.08f}) {
        const auto path = static_cast<double>(thickness);
        check_slab(behind_slab(thickness, sun, look_at({0, 0, 0}, {0, 0, 1})), 3, path);
        const double slanted = std::sqrt(2.0);
        check_slab(
            behind_slab(thickness, sun, look_at({0, 0, 0}, {1, 0, 1})), 3 / slanted,
            slanted * path);
    }
}

TEST_CASE(
    "subsurface: lamps and spots shine through a slab as the sun does"
    * technique("skin.transmission")) {
    constexpr float kThickness = 0.03f;
    const double falloff = 5 / square(2.0);
    const Affine from = look_at({0, 0, -2}, {0, 0, 0});
    check_slab(
        behind_slab(kThickness, PointLight{.intensity = 5, .radius = 0}, from), falloff,
        static_cast<double>(kThickness));
    check_slab(
        behind_slab(
            kThickness,
            SpotLight{.intensity = 5, .radius = 0, .inner_angle = 0.5f, .outer_angle = 0.6f}, from),
        falloff, static_cast<double>(kThickness));
}

TEST_CASE(
    "subsurface: no light passes a body far thicker than its mean free path, or without one"
    * technique("skin.transmission")) {
    const DirectionalLight sun = {.illuminance = 3};
    const Affine from = look_at({0, 0, 0}, {0, 0, 1});
    CHECK(behind_slab(1.5f, sun, from).x < 1e-3f * behind_slab(0.03f, sun, from).x);
}

}  // namespace limn::test::subsurface_test

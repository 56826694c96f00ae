#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "render/lens/thin_lens.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <vector>

// Particles through a lens, against the mean of views from all over it.

namespace limn::test::particle_focus_test {
namespace {

constexpr int kSize = 96;        // of the image [px]
constexpr float kFocus = 2;      // [m], from the camera to the origin
constexpr float kInfinity = 16;  // diameter of the circle of what is infinitely far away [px]

struct FocusScene : Scene {
    std::vector<Entity> walls;

    FocusScene() { world.insert_resource(FrameTime{}); }

    /// Gray, over the whole image.
    void add_wall(float z) {
        walls.push_back(place(
            add(make_square()),
            add(Material{.base_color = {0, 0, 0, 1}, .emission = {0.3f, 0.3f, 0.3f}}),
            affine_from({0, 0, z}, {1, 0, 0, 0}, {60, 60, 1})));
    }
    /// A square of 6 m of blue light that hides half of what is behind it.
    void add_pane(float z) {
        place(
            add(make_square()),
            add(Material{
                .shading = ShadingModel::Unlit,
                .alpha_mode = AlphaMode::Blend,
                .base_color = {0, 0, 0.4f, 0.5f}}),
            affine_from({0, 0, z}, {1, 0, 0, 0}, Vec3(3)));
    }
    /// A square of 0.8 m, red in its left half and green in the other.
    Entity emit(const Vec3& at, float opacity = 1, float cover = 1) {
        if (world.resource<Assets>().images.empty()) {
            ImageData image;
            image.width = 2;
            image.height = 1;
            image.srgb = false;
            image.pixels = {255, 0, 0, 255, 0, 255, 0, 255};
            image_ = add(image);
        }
        ParticleLook look;
        look.image = image_;
        look.size = 0.8f;
        look.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = opacity}};
        look.emission = 1;
        look.lit = 0;
        look.cover = cover;
        look.softness = 0;
        look.turn_spread = 0;
        ParticlePool pool;
        pool.x = {at.x};
        pool.y = {at.y};
        pool.z = {at.z};
        pool.vx = pool.vy = pool.vz = {0};
        pool.age = {0.5f};
        pool.life = {1};
        pool.look = {7};
        return world.create(ParticleEmitter{}, look, pool);
    }
    RenderView camera() {
        RenderView view = look({0, 0, kFocus}, {0, 0, 0}, kSize, kSize);
        view.lens = {
            .aperture_radius = kInfinity * kFocus * view.tangent.y / static_cast<float>(kSize),
            .focus_distance = kFocus,
            .max_blur = 0.5f};
        return view;
    }
    gpu::FloatImage photograph() { return radiance(camera()); }
    /// Mean of as many views through points that are spread evenly over the lens.
    gpu::FloatImage truth() {
        constexpr int kViews = 144;
        gpu::FloatImage mean;
        for (int i = 0; i < kViews; ++i) {
            const Vec2 square = (Vec2(i % 12, i / 12) + 0.5f) / 12.0f;
            const RenderView view = camera();
            const gpu::FloatImage one =
                radiance(with_lens_sample(view, point_on_aperture(view.lens, square)));
            if (i == 0) {
                mean = one;
                std::fill(mean.pixels.begin(), mean.pixels.end(), 0.0f);
            }
            for (std::size_t k = 0; k < one.pixels.size(); ++k) {
                mean.pixels[k] += one.pixels[k] / kViews;
            }
        }
        return mean;
    }
    void set_cover(float value) {
        world.query<ParticleLook>().each([&](ParticleLook& look) { look.velocity_cover = value; });
    }

  private:
    ImageId image_{};
};

double decibels(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const auto off = static_cast<double>(a.at(x, y, c) - b.at(x, y, c));
                sum += off * off;
            }
        }
    }
    return -10 * std::log10(sum / (3.0 * a.width * a.height));
}

}  // namespace

TEST_CASE_FIXTURE(
    FocusScene,
    "particle focus: anywhere they are as sharp as views from all over the lens show them"
        * technique("particle.depth-of-field")) {
    struct Case {
        float wall, particle;  // z [m]
    };
    for (const Case& depths : {Case{-20, 0}, Case{-20, -1.5f}, Case{-0.1f, 0.7f}, Case{-0.1f, 1}}) {
        CAPTURE(depths.wall);
        CAPTURE(depths.particle);
        add_wall(depths.wall);
        const Entity one = emit({0.05f, 0.02f, depths.particle});
        const gpu::FloatImage expected = truth();
        const double found = decibels(photograph(), expected);
        set_cover(1);
        const double without = decibels(photograph(), expected);
        CHECK(found >= 33);
        CHECK(found > without + 8);
        world.destroy(one);
        world.destroy(walls.back());
    }
}

TEST_CASE_FIXTURE(
    FocusScene, "particle focus: behind or before a pane they are as sharp, and covered by it"
                    * technique("particle.depth-of-field")) {
    add_wall(-20);
    add_pane(0.5f);
    for (const float z : {0.0f, -1.5f, 1.0f}) {
        CAPTURE(z);
        const Entity one = emit({0.05f, 0.02f, z});
        CHECK(decibels(photograph(), truth()) >= 32);
        world.destroy(one);
    }
}

TEST_CASE_FIXTURE(
    FocusScene, "particle focus: light alone is focused on, too, where its opacity is enough"
                    * technique("particle.depth-of-field")) {
    emit({0, 0, 0}, 0.8f, 0);
    const gpu::FloatImage sharp = radiance(with_lens_sample(camera(), Vec2(0)));
    CHECK(decibels(photograph(), sharp) > 40);
    set_cover(0.9f);
    CHECK(decibels(photograph(), sharp) < 30);
}

TEST_CASE_FIXTURE(
    FocusScene,
    "particle focus: what a surface hides changes no bit" * technique("particle.depth-of-field")) {
    place(
        add(make_square()),
        add(Material{.base_color = {0, 0, 0, 1}, .emission = {0.3f, 0.2f, 0.1f}}),
        affine_from({0.2f, 0, 0.3f}, {1, 0, 0, 0}, Vec3(0.6f)));
    add_wall(-20);
    const gpu::FloatImage before = photograph();
    emit({0.2f, 0, -0.1f});
    CHECK(largest_difference(photograph(), before) == 0);
}

}  // namespace limn::test::particle_focus_test

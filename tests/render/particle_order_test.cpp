#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

// Particles among surfaces that are transparent: panes, media and water.

namespace limn::test::particle_order_test {
namespace {

struct OrderScene : Scene {
    OrderScene() { world.insert_resource(FrameTime{}); }

    /// A disc of 4 m at rest.
    Entity emit(const Vec3& position, const Vec3& color, float opacity = 1) {
        ParticleLook look = look_;
        look.size = 4;
        look.colors = {{.at = 0, .color = color, .opacity = opacity}};
        look.emission = 1;
        look.lit = 0;
        look.softness = 0;
        ParticlePool pool;
        pool.x = {position.x};
        pool.y = {position.y};
        pool.z = {position.z};
        pool.vx = pool.vy = pool.vz = {0};
        pool.age = {0.5f};
        pool.life = {1};
        pool.look = {7};
        return world.create(ParticleEmitter{}, look, pool);
    }
    /// A square of 6 m that gives off `color` and hides `opacity` of what is behind it.
    void add_pane(float z, const Vec3& color, float opacity) {
        add_pane(affine_from({0, 0, z}, {1, 0, 0, 0}, Vec3(3)), color, opacity);
    }
    void add_pane(const Affine& world_from_square, const Vec3& color, float opacity) {
        place(
            add(make_square()),
            add(Material{
                .shading = ShadingModel::Unlit,
                .alpha_mode = AlphaMode::Blend,
                .double_sided = true,
                .base_color = Vec4(color, opacity)}),
            world_from_square);
    }
    /// A black square of 2 m times `scale`, 2 m below the origin or higher.
    Entity add_floor(float x = 0, float scale = 9, float y = -2) {
        return place(
            add(make_square()), add(Material{.base_color = {0, 0, 0, 1}, .roughness = 1}),
            affine_from({x, y, 0}, Quat(std::sqrt(0.5f), -std::sqrt(0.5f), 0, 0), Vec3(scale)));
    }
    Vec3 center_pixel() { return rgb_at(radiance(look({0, 0, 1}, {0, 0, 0}, 33, 33)), 16, 16); }

    ParticleLook look_{};  ///< of those that are emitted, but for their size and color
};

}  // namespace

TEST_CASE_FIXTURE(
    OrderScene,
    "particle order: a sprite behind a pane is visible through it, one in front hides it"
        * technique("particle.distance-sort")) {
    add_pane(0, {0, 0, 1}, 0.25f);
    const Entity behind = emit({0, 0, -1}, {1, 0, 0});
    Vec3 shown = center_pixel();
    CHECK(shown.x == test::near(0.75).epsilon(0.01));
    CHECK(shown.z == test::near(0.25).epsilon(0.01));
    world.destroy(behind);
    emit({0, 0, 0.5f}, {1, 0, 0});
    shown = center_pixel();
    CHECK(shown.x == test::near(1).epsilon(0.01));
    CHECK(shown.z < 0.01f);
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: sprites before and behind a pane mix as sorted layers do"
                    * technique("particle.distance-sort")) {
    add_pane(0, {0, 0, 1}, 0.5f);
    emit({0, 0, -1}, {1, 0, 0}, 0.8f);
    emit({0, 0, 0.3f}, {0, 1, 0}, 0.5f);
    const Vec3 shown = center_pixel();
    CHECK(shown.x == test::near(0.8 * 0.5 * 0.5).epsilon(0.02));
    CHECK(shown.z == test::near(0.5 * 0.5).epsilon(0.02));
    CHECK(shown.y == test::near(0.5).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: at half the resolution and weighted, panes are as for all others"
                    * technique("particle.distance-sort")) {
    add_pane(0, {0, 0, 1}, 0.5f);
    for (const bool is_half : {true, false}) {
        CAPTURE(is_half);
        look_.resolution = is_half ? ParticleResolution::Half : ParticleResolution::Full;
        look_.sort = is_half ? ParticleSort::Distance : ParticleSort::Weighted;
        const Entity behind = emit({0, 0, -1}, {1, 0, 0}, 0.8f);
        const Entity before = emit({0, 0, 0.3f}, {0, 1, 0}, 0.5f);
        const Vec3 shown = center_pixel();
        CHECK(shown.x == test::near(0.8 * 0.5 * 0.5).epsilon(0.02));
        CHECK(shown.z == test::near(0.5 * 0.5).epsilon(0.02));
        CHECK(shown.y == test::near(0.5).epsilon(0.02));
        world.destroy(behind);
        world.destroy(before);
    }
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: a mirror shows them behind a pane and before it"
                    * technique("particle.distance-sort")) {
    world.add(
        world.create(
            Water{.size = {40, 40}, .absorption = {100, 100, 100}, .scattering = Vec3(0)},
            WorldTransform{at({0, 0, 0})}),
        WaterLook{.reflection = WaterReflection::Planar, .map_scale = 1});
    // A ceiling, as the water sees it.
    add_pane(
        affine_from({0, 5, 0}, Quat(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0), Vec3(9)), {0, 0, 1},
        0.5f);
    const RenderView view = look({0, 3, 0.1f}, {0, 0, 0}, 33, 33);
    const auto mirrored = [&](float height) {
        const Entity one = emit({0, height, 0}, {1, 0, 0});
        const Vec3 shown = rgb_at(radiance(view), 16, 16);
        world.destroy(one);
        return shown;
    };
    const Vec3 behind = mirrored(6);
    CHECK(behind.x > 0.005f);
    CHECK(behind.x == test::near(behind.z).epsilon(0.05));
    const Vec3 before = mirrored(4);
    CHECK(before.x == test::near(2 * behind.x).epsilon(0.05));
    CHECK(before.z < 0.02f * before.x);
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: a sprite that a pane cuts is behind it in part of its pixels"
                    * technique("particle.distance-sort")) {
    // From the lower left of the image away to the upper right.
    add_pane(
        affine_from({0, 0, 0}, Quat(std::cos(0.4f), 0, std::sin(0.4f), 0), Vec3(3)), {0, 0, 1},
        0.5f);
    emit({0, 0, 0}, {1, 0, 0});
    const gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, 33, 33));
    const Vec3 left = rgb_at(image, 10, 16);
    const Vec3 right = rgb_at(image, 22, 16);
    const Vec3& open = left.z < right.z ? left : right;
    const Vec3& veiled = left.z < right.z ? right : left;
    CHECK(open.z < 0.3f * veiled.z);
    CHECK(veiled.z > 0.4f);
    CHECK(veiled.x == test::near(0.5f * open.x).epsilon(0.05));
}

TEST_CASE_FIXTURE(
    OrderScene,
    "particle order: a sprite behind clear glass is visible, one in front hides the glass"
        * technique("particle.distance-sort")) {
    const Material glass = {
        .base_color = {1, 1, 1, 1}, .roughness = 0, .transmission = 1, .thickness = 0.1f};
    place(add(make_square()), add(glass), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(3)));
    for (const float z : {-1.0f, 0.5f}) {
        CAPTURE(z);
        const Entity one = emit({0, 0, z}, {1, 0, 0});
        const Vec3 shown = center_pixel();
        CHECK(shown.x > 0.85f);
        CHECK(shown.y < 0.05f);
        world.destroy(one);
    }
    CHECK(center_pixel().x < 0.05f);
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: a sprite above water hides it, below black water it is invisible"
                    * technique("particle.distance-sort")) {
    world.create(
        Water{.absorption = {100, 100, 100}, .scattering = Vec3(0)}, WorldTransform{at({0, 0, 0})});
    const RenderView view = look({0, 3, 0.1f}, {0, 0, 0}, 33, 33);
    const auto red = [&] { return rgb_at(radiance(view), 16, 16).x; };
    const float bare = red();
    const Entity above = emit({0, 0.5f, 0}, {1, 0, 0});
    CHECK(red() == test::near(1).epsilon(0.01));
    world.destroy(above);
    emit({0, -1, 0}, {1, 0, 0});
    CHECK(red() == test::near(bare).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: below clear water they are visible from above"
                    * technique("particle.distance-sort")) {
    // A floor in the way of the light that comes back, so that only what is before it is shown.
    add_floor();
    world.create(
        Water{.size = {16, 16}, .depth = 2, .absorption = Vec3(0), .scattering = Vec3(0)},
        WorldTransform{at({0, 0, 0})});
    const RenderView view = look({0, 3, 0.1f}, {0, 0, 0}, 33, 33);
    const auto red = [&] { return rgb_at(radiance(view), 16, 16).x; };
    const float bare = red();
    const Entity below = emit({0, -1, 0}, {1, 0, 0}, 0.5f);
    // All but the 2 % that are mirrored on the way out, by light that spreads over n^2.
    const float shown = red();
    CHECK(shown > bare + 0.3f);
    CHECK(shown < bare + 0.5f);
    world.destroy(below);
    emit({0, 0.5f, 0}, {1, 0, 0}, 0.5f);
    CHECK(red() == test::near(0.5f + 0.5f * bare).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: below water they are drawn before something opaque, or not") {
    world.create(Water{.absorption = Vec3(0.1f)}, WorldTransform{at({0, 0, 0})});
    const Entity one = emit({0, -1, 0}, {1, 0, 0});
    world.get<ParticleLook>(one).size = 0.5f;
    const RenderView view = look({0, 3, 0.1f}, {0, 0, 0}, 33, 33);
    const auto is_drawn = [&] {
        (void)radiance(view);
        const auto& passes = frame_graph(shared_renderer()).timings();
        return std::any_of(passes.begin(), passes.end(), [](const PassTiming& pass) {
            return pass.name == "particles.under water";
        });
    };
    CHECK_FALSE(is_drawn());
    // As seen from the camera, the disc of 0.25 m ends at 0.31 m on the floor.
    for (const float x : {0.0f, 0.35f, -0.35f}) {
        const Entity floor = add_floor(x, 0.1f);
        CHECK(is_drawn());
        world.destroy(floor);
    }
    for (const float x : {1.5f, 200.0f}) {
        const Entity floor = add_floor(x, 0.1f);
        CHECK_FALSE(is_drawn());
        world.destroy(floor);
    }
    add_floor(0, 0.1f, 1);  // before it
    CHECK_FALSE(is_drawn());
}

TEST_CASE_FIXTURE(
    OrderScene,
    "particle order: layers that alternate below water take as many draws as one pair") {
    add_floor();
    world.create(
        Water{.size = {16, 16}, .depth = 2, .absorption = Vec3(0), .scattering = Vec3(0)},
        WorldTransform{at({0, 0, 0})});
    const auto add_white = [&](int size) {  // two sizes: in two arrays
        ImageData white;
        white.width = white.height = size;
        white.pixels.assign(static_cast<std::size_t>(4 * size * size), 255);
        return add(white);
    };
    const ImageId images[] = {add_white(1), add_white(2)};
    const RenderView view = look({0, 3, 0.1f}, {0, 0, 0}, 33, 33);
    const auto add_pairs = [&](int count) {
        for (int i = 0; i < 2 * count; ++i) {
            look_.image = images[i % 2];
            look_.resolution = i % 2 == 0 ? ParticleResolution::Full : ParticleResolution::Half;
            emit({0, -0.1f * static_cast<float>(i + 1), 0}, {1, 0, 0}, 0.1f);
        }
        (void)radiance(view);  // fills caches
        shared_device().reset_stats();
        (void)radiance(view);
        return shared_device().stats().draws;
    };
    const int few = add_pairs(2);
    CHECK(few > 0);
    CHECK(add_pairs(4) == few);
}

TEST_CASE_FIXTURE(
    OrderScene, "particle order: water absorbs a sprite's light as far as the sprite, not the floor"
                    * technique("particle.distance-sort")) {
    add_floor();
    constexpr Vec3 kAbsorption = {0.5f, 0.2f, 0.1f};
    world.create(
        Water{.size = {16, 16}, .depth = 2, .absorption = kAbsorption, .scattering = Vec3(0)},
        WorldTransform{at({0, 0, 0})});
    ImageData white;
    white.width = white.height = 1;
    white.pixels = {255, 255, 255, 255};
    look_.image = add(white);
    look_.facing = ParticleFacing::Ground;
    for (const float aside : {0.1f, 3.0f}) {
        CAPTURE(aside);
        // The shader takes the angle of the pixel where the bent ray ends, which is some degrees
        // off.
        const double bound = aside < 1 ? 0.002 : 0.02;
        const RenderView view = look({0, 3, aside}, {0, 0, 0}, 33, 33);
        const auto seen_at = [&](float above_floor) {
            const Entity one = emit({0, above_floor - 2, 0}, {1, 1, 1});
            const Vec3 shown = rgb_at(radiance(view), 16, 16);
            world.destroy(one);
            return shown;
        };
        const Vec3 low = seen_at(0.2f);
        const Vec3 high = seen_at(1);
        const float sine = aside / std::hypot(aside, 3.0f) / Water{}.refractive_index;
        for (int i = 0; i < 3; ++i) {
            CAPTURE(i);
            const float gained = std::exp(kAbsorption[i] * 0.8f / std::sqrt(1 - sine * sine));
            CHECK(high[i] / low[i] == test::near(gained).epsilon(bound));
        }
    }
}

}  // namespace limn::test::particle_order_test

#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "render/particles/particle_weighted.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::test::particle_weighted_test {
namespace {

constexpr int kSize = 9;

struct WeightedScene : Scene {
    WeightedScene() { world.insert_resource(FrameTime{}); }

    /// A particle at rest on the view axis, of a look of its own.
    void emit(float z, const Vec3& color, float opacity, ParticleSort sort, float cover = 1) {
        ParticleLook look;
        look.size = 4;
        look.colors = {{.at = 0, .color = color, .opacity = opacity}};
        look.emission = 1;
        look.lit = 0;
        look.cover = cover;
        look.softness = 0;
        look.sort = sort;
        ParticlePool pool;
        for (auto* column : {&pool.x, &pool.y, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(0);
        }
        pool.z.push_back(z);
        pool.age.push_back(0.5f);
        pool.life.push_back(1);
        pool.look.push_back(7);
        made.push_back(world.create(ParticleEmitter{}, look, pool));
    }
    gpu::FloatImage draw_view() { return radiance(look({0, 0, 3}, {0, 0, 0}, kSize, kSize)); }
    Vec3 center_pixel() { return rgb_at(draw_view(), kSize / 2, kSize / 2); }
    void clear() {
        for (const Entity entity : made) {
            world.destroy(entity);
        }
        made.clear();
    }

    std::vector<Entity> made;
};

float largest_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    }
    return largest;
}

}  // namespace

TEST_CASE_FIXTURE(
    WeightedScene, "particle weighted: a single layer is what it is when sorted"
                       * technique("particle.weighted-blended")) {
    for (const float cover : {0.3f, 1.0f}) {
        CAPTURE(cover);
        emit(0, {4, 2, 1}, 0.7f, ParticleSort::Distance, cover);
        const gpu::FloatImage sorted = draw_view();
        clear();
        emit(0, {4, 2, 1}, 0.7f, ParticleSort::Weighted, cover);
        const gpu::FloatImage weighted = draw_view();
        clear();
        CHECK(rgb_at(sorted, kSize / 2, kSize / 2).x > 1);
        CHECK(largest_difference(sorted, weighted) < 4 * 1e-4f);
    }
}

TEST_CASE_FIXTURE(
    WeightedScene,
    "particle weighted: layers hide what is behind by the product of their transmittances"
        * technique("particle.weighted-blended")) {
    const Vec3 open = center_pixel();
    emit(-3, {9, 9, 9}, 1, ParticleSort::Distance);  // a white card behind
    const Vec3 card = center_pixel();
    for (const float z : {-2.0f, 0.0f, 1.5f}) {
        emit(z, {0, 0, 0}, 0.4f, ParticleSort::Weighted);
    }
    emit(1, {0, 0, 0}, 0.25f, ParticleSort::Weighted);
    const float kept = 0.6f * 0.6f * 0.6f * 0.75f;
    CHECK(card.x > open.x + 5);
    CHECK(center_pixel().x == near(kept * card.x).epsilon(2e-3));
}

TEST_CASE_FIXTURE(
    WeightedScene, "particle weighted: the image does not depend on the order"
                       * technique("particle.weighted-blended")) {
    const auto drawn = [&](bool reversed) {
        for (int i = 0; i < 12; ++i) {
            const int n = reversed ? 11 - i : i;
            const float fraction = static_cast<float>(n) / 11;
            emit(
                fraction * 2 - 1, {fraction, 1 - fraction, 0.5f}, 0.2f + 0.5f * fraction,
                ParticleSort::Weighted);
        }
        gpu::FloatImage image = draw_view();
        clear();
        return image;
    };
    CHECK(largest_difference(drawn(false), drawn(true)) < 1e-4f);
}

TEST_CASE_FIXTURE(
    WeightedScene, "particle weighted: the nearer of two colors wins, as when they are sorted"
                       * technique("particle.weighted-blended")) {
    for (const float side : {-1.0f, 1.0f}) {
        emit(side, {1, 0, 0}, 0.6f, ParticleSort::Weighted);
        emit(-side, {0, 0, 1}, 0.6f, ParticleSort::Weighted);
        const Vec3 found = center_pixel();
        clear();
        const float near_one = side > 0 ? found.x : found.z;
        const float far_one = side > 0 ? found.z : found.x;
        // Of 0.6 and 0.6 * 0.4, sorted, 71 % are the nearer one's; without weights it is a half.
        CHECK(near_one > 2 * far_one);
    }
}

TEST_CASE_FIXTURE(
    WeightedScene, "particle weighted: what only adds light adds, whatever the sort says") {
    emit(0.5f, {1, 0, 0}, 0.5f, ParticleSort::Weighted, 0);
    emit(0, {2, 0, 0}, 0.5f, ParticleSort::Weighted, 0);
    const Vec3 both = center_pixel();
    clear();
    const Vec3 none = center_pixel();
    CHECK(both.x - none.x == near(0.5 + 1.0).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    WeightedScene, "particle weighted: no position and no color makes a NaN"
                       * technique("particle.weighted-blended")) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    emit(kInfinity, {1, 1, 1}, 0.5f, ParticleSort::Weighted);
    emit(std::numeric_limits<float>::quiet_NaN(), {1, 1, 1}, 0.5f, ParticleSort::Weighted);
    emit(0, {1e6f, 1e6f, 1e6f}, 1, ParticleSort::Weighted);
    emit(2.99f, {1, 1, 1}, 1e-6f, ParticleSort::Weighted);
    for (const float value : draw_view().pixels) {
        CHECK(std::isfinite(value));
    }
}

TEST_CASE("particle weighted: weights range over the depths of a box, from the near plane on") {
    RenderView view;
    view.near = 0.1f;
    const Vec2 ahead = weight_range({Vec3(-1, -1, -7), Vec3(1, 1, -2)}, view);
    CHECK(ahead.x == near(2));
    CHECK(ahead.y == near(1.0 / 5));
    CHECK(weight_range({Vec3(-1, -1, -7), Vec3(1, 1, 3)}, view).x == near(0.1));
    CHECK(weight_range({Vec3(0, 0, -4), Vec3(0, 0, -4)}, view) == Vec2(4, 0));
    CHECK(weight_range({}, view) == Vec2(0, 0));
    CHECK(weight_range({Vec3(-INFINITY), Vec3(INFINITY)}, view) == Vec2(0, 0));
}

}  // namespace limn::test::particle_weighted_test

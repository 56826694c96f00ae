#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "render/light/light_list.h"
#include "render/particles/particle_scene.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::test::particle_pass_test {
namespace {

struct ParticleScene : Scene {
    ParticleScene() { world.insert_resource(FrameTime{}); }

    /// Particles at rest, halfway through their life of a second.
    Entity emit(const std::vector<Vec3>& positions, const ParticleLook& look) {
        return world.create(ParticleEmitter{}, look, pool_at(positions));
    }
    [[nodiscard]] RenderView view() const { return look({0, 0, 1}, {0, 0, 0}, 9, 9); }
    Vec3 center_pixel() { return rgb_at(radiance(view()), 4, 4); }
};

/// A disc that adds or hides light and does not soften.
ParticleLook disc(const Vec3& color, float opacity, float cover) {
    ParticleLook look;
    look.size = 1;
    look.colors = {{.at = 0, .color = color, .opacity = opacity}};
    look.emission = 1;
    look.lit = 0;
    look.cover = cover;
    look.softness = 0;
    return look;
}

/// White without an edge, 16 pixels wide in an image of 96 lines.
ParticleLook add_point_sprite(Scene& scene) {
    ParticleLook point = disc({1, 1, 1}, 1, 1);
    ImageData white;
    white.width = white.height = 1;
    white.pixels = {255, 255, 255, 255};
    point.image = scene.add(white);
    point.facing = ParticleFacing::Pixels;
    point.size = 16;
    point.turn_spread = 0;
    return point;
}

}  // namespace

TEST_CASE(
    "particle pass: curves are straight between their keys, in any order and where keys meet"
    * technique("particle.gpu-draw")) {
    CHECK(sample_curve({}, 0.3f) == 1.0f);
    CHECK(sample_curve({{0.5f, 3}}, 0.1f) == 3.0f);
    const std::vector<CurveKey> keys = {{0.75f, 6}, {0.25f, 2}};
    CHECK(sample_curve(keys, 0) == 2.0f);
    CHECK(sample_curve(keys, 0.5f) == test::near(4));
    CHECK(sample_curve(keys, 1) == 6.0f);
    const std::vector<CurveKey> step = {{0, 1}, {0.5f, 1}, {0.5f, 5}, {1, 5}};
    CHECK(sample_curve(step, 0.49f) == test::near(1));
    CHECK(sample_curve(step, 0.5f) == 5.0f);
    const Vec4 mixed = sample_colors({{0, {1, 0, 0}, 1}, {1, {0, 0, 1}, 0}}, 0.25f);
    CHECK(mixed.x == test::near(0.75));
    CHECK(mixed.z == test::near(0.25));
    CHECK(mixed.w == test::near(0.75));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a quad that the border cuts looks as within a wider image") {
    emit({{0.9f, 0.5f, 0}, {-0.2f, -1.3f, 0}, {-2.5f, 0, 0}}, disc({1, 0.5f, 0.25f}, 1, 1));
    const Affine pose = look_at({0, 0, 1}, {0, 0, 0});
    const RenderView wide = make_render_view(
        {.fov_y = 2 * std::atan(2.0f), .near = 0.05f}, pose, pose, {.width = 96, .height = 96});
    const gpu::FloatImage whole = radiance(wide);
    const gpu::FloatImage cut = radiance(look({0, 0, 1}, {0, 0, 0}, 48, 48));
    float worst = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 48; ++x) {
            const Vec3 off = rgb_at(cut, x, y) - rgb_at(whole, x + 24, y + 24);
            worst = std::max({worst, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
        }
    }
    CHECK(worst < 0.002f);
    // The first disc begins at pixel 33.6 and has its center at 45.6.
    CHECK(cut.at(33, 12, 0) < 1e-6f);
    CHECK(cut.at(45, 12, 0) > 0.95f);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a streak of few pixels is all of an ellipse, from rim to rim") {
    const Vec3 along = {0.6f, 0.8f, 0};
    ParticleLook streak = disc({1, 1, 1}, 1, 1);
    streak.facing = ParticleFacing::Velocity;
    for (const float width : {1.0f, 4.0f, 5.5f, 7.0f}) {  // [px]; the last is no small disc
        CAPTURE(width);
        constexpr float kPixel = 2.0f / 96;  // [m]
        streak.size = width * kPixel;
        streak.stretch = 20 * kPixel;  // at 1 m/s
        const Entity entity =
            world.create(ParticleEmitter{}, streak, pool_at({{Vec3(0, 0, 0)}}, along));
        const gpu::FloatImage shown = radiance(look({0, 0, 1}, {0, 0, 0}, 96, 96));
        float worst = 0;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 96; ++x) {
                const Vec2 position = {
                    static_cast<float>(x) - 47.5f, 47.5f - static_cast<float>(y)};
                const float up = glm::dot(position, Vec2(along)) / (0.5f * width + 10);
                const float right = (position.x * along.y - position.y * along.x) / (0.5f * width);
                const float expected = square(std::max(1 - square(up) - square(right), 0.0f));
                worst = std::max(worst, std::abs(shown.at(x, y, 0) - expected));
            }
        }
        CHECK(worst < 0.004f);
        world.destroy(entity);
    }
}

TEST_CASE(
    "particle pass: they are ordered from back to front, equal ones as they were, NaN first"
    * technique("particle.distance-sort")) {
    std::vector<ParticleInstance> instances(100);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        instances[i].position = {0, 0, -static_cast<float>((i * 37) % 50)};
    }
    instances[60].position.x = std::numeric_limits<float>::quiet_NaN();
    DistanceOrder found;
    order_by_distance(instances, {}, {0, 0, 5}, {0, 0, -1}, found);
    const std::vector<std::uint32_t>& order = found.indices;
    REQUIRE(order.size() == 100);
    CHECK(order[0] == 60);
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < 100; ++i) {
        CHECK(sorted[i] == i);
    }
    for (std::size_t i = 2; i < order.size(); ++i) {
        const float before = -instances[order[i - 1]].position.z;
        const float now = -instances[order[i]].position.z;
        const bool in_order = before > now || (before == now && order[i - 1] < order[i]);
        CHECK(in_order);
    }
}

TEST_CASE(
    "particle pass: particles that are sorted as one are ordered by their emitter's position"
    * technique("particle.distance-sort")) {
    std::vector<ParticleInstance> instances(6);
    for (std::uint32_t i = 0; i < 6; ++i) {
        instances[i].position = {0, 0, -static_cast<float>(i)};
        instances[i].look_and_life = (i % 2) << 16;
    }
    DistanceOrder found;
    // Looks 0 at 0, -2, -4 m; looks 1 all at -3 m.
    order_by_distance(
        instances, std::vector{std::optional<Vec3>(), std::optional(Vec3(0, 0, -3))}, {0, 0, 5},
        {0, 0, -1}, found);
    CHECK(found.indices == std::vector<std::uint32_t>{4, 1, 3, 5, 2, 0});
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: point sprites have the sizes of the book's table"
                       * technique("particle.gpu-draw")) {
    // psize (1, 0, 0.01, 16)
    ParticleLook point = add_point_sprite(*this);
    point.attenuation = {1, 0, 0.01f};
    for (const auto& row :
         {std::pair(0.1f, 15.9992f), std::pair(10.0f, 11.313708f), std::pair(100.0f, 1.592060f)}) {
        const float distance = row.first;
        const float size = row.second;
        CAPTURE(distance);
        const Entity sprite = emit({{0, 0, -distance}}, point);
        const gpu::FloatImage image = radiance(look({0, 0, 0}, {0, 0, -1}, 96, 96));
        double lit = 0;
        for (int x = 0; x < 96; ++x) {
            lit += rgb_at(image, x, 48).x > 0.5f ? 1 : 0;
        }
        CHECK(std::abs(lit - static_cast<double>(size)) <= 1);
        world.destroy(sprite);
    }
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: a point sprite is as large in a corner of the image as in the center"
        * technique("particle.gpu-draw")) {
    ParticleLook point = add_point_sprite(*this);
    for (const float shift : {0.0f, 1.0f, 1.9f}) {  // of 2.31 m from the center to the edge
        CAPTURE(shift);
        const Entity sprite = emit({{shift, shift, -4}}, point);
        const gpu::FloatImage image = radiance(look({0, 0, 0}, {0, 0, -1}, 96, 96));
        int lit = 0;
        for (int i = 0; i < 96 * 96; ++i) {
            lit += rgb_at(image, i % 96, i / 96).x > 0.5f ? 1 : 0;
        }
        CHECK(lit == 16 * 16);
        world.destroy(sprite);
    }
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: a chessboard is gray where it is small, alone and behind a large one"
        * technique("particle.gpu-draw")) {
    ParticleLook board = disc({1, 1, 1}, 1, 1);
    ImageData image;
    image.width = image.height = 64;
    for (int i = 0; i < 64 * 64; ++i) {
        const std::uint8_t value = ((i % 64 + i / 64) & 1) != 0 ? 255 : 0;
        image.pixels.insert(image.pixels.end(), {value, value, value, 255});
    }
    board.image = add(image);
    board.facing = ParticleFacing::Pixels;
    board.turn_spread = 0;
    const auto range_of = [&](const gpu::FloatImage& drawn, int center) {  // of 6 x 6 pixels
        float least = INFINITY;
        float most = 0;
        for (int i = 0; i < 36; ++i) {
            const float value = rgb_at(drawn, center - 3 + i % 6, 48 - 3 + i / 6).x;
            least = std::min(least, value);
            most = std::max(most, value);
        }
        return Vec2(least, most);
    };
    const auto drawn = [&] { return radiance(look({0, 0, 0}, {0, 0, -1}, 192, 96)); };
    board.size = 9;
    emit({{1, 0, -3}}, board);
    const Vec2 alone = range_of(drawn(), 112);  // 96 + 48 (1 m / 3 m)
    CHECK(alone.x > 0.4f);
    CHECK(alone.y < 0.6f);
    board.size = 64;
    emit({{-1, 0, -2}}, board);
    const gpu::FloatImage both = drawn();
    const Vec2 small = range_of(both, 112);
    CHECK(small.x > 0.4f);
    CHECK(small.y < 0.6f);
    const Vec2 large = range_of(both, 72);
    CHECK(large.y - large.x > 0.5f);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a disc drawn as a point is that drawn as a quad, to a tenth") {
    // Seen at a right angle, 7.5 to 30 pixels wide.
    for (const float size : {0.25f, 0.5f, 1.0f}) {
        for (const Vec3& position : {Vec3(0, 0, 0), Vec3(0.09f, -0.07f, 0.02f)}) {
            CAPTURE(size);
            ParticleLook look = disc({3, 2, 1}, 0.8f, 0.5f);
            look.size = size;
            const auto drawn = [&](ParticleFacing facing) {
                look.facing = facing;
                const Entity one = emit({position}, look);
                gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 60, 60));
                world.destroy(one);
                return image;
            };
            const gpu::FloatImage quad = drawn(ParticleFacing::Camera);
            const gpu::FloatImage point = drawn(ParticleFacing::Point);
            double difference = 0;
            double sum = 0;
            for (int y = 0; y < 60; ++y) {
                for (int x = 0; x < 60; ++x) {
                    const float a = rgb_at(quad, x, y).x;
                    const float b = rgb_at(point, x, y).x;
                    difference += std::abs(static_cast<double>(a - b));
                    sum += static_cast<double>(a);
                }
            }
            CHECK(sum > 10);
            CHECK(difference < 0.1 * sum);
        }
    }
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a disc has its profile in every pixel, small or large"
                       * technique("particle.gpu-draw")) {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    for (const int diameter : {2, 4, 8, 10, 12, 40}) {  // [px]; small ones are points
        CAPTURE(diameter);
        look.size = static_cast<float>(diameter) / 30;
        const Entity one = emit({{0, 0, 0}}, look);
        const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 60, 60));
        world.destroy(one);
        float largest = 0;
        for (int i = 0; i < 3600; ++i) {
            const Vec2 at =
                (Vec2(i % 60, i / 60) + 0.5f - 30.0f) * (2.0f / static_cast<float>(diameter));
            const float inside = std::max(1 - glm::dot(at, at), 0.0f);
            const float found = rgb_at(image, i % 60, i / 60).x;
            largest = std::max(largest, std::abs(found - inside * inside));
        }
        CHECK(largest <= 0.001f);
    }
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a small disc gives the light of its solid angle, to 2 %"
                       * technique("particle.gpu-draw")) {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    constexpr int kShifts = 8;                         // in a pixel, along each axis
    for (const float diameter : {0.5f, 1.5f, 3.0f}) {  // [px], of 30 a meter at the center
        for (const float aside : {0.0f, 0.8f}) {       // to the right and up [m], a meter ahead
            CAPTURE(diameter);
            CAPTURE(aside);
            look.size = diameter / 30;
            double sum = 0;
            for (int i = 0; i < kShifts * kShifts; ++i) {
                const Vec2 shift = Vec2(i % kShifts, i / kShifts) / (30.0f * kShifts);
                const Entity one = emit({Vec3(Vec2(aside) + shift, 0)}, look);
                const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 60, 60));
                world.destroy(one);
                for (int pixel = 0; pixel < 3600; ++pixel) {
                    sum += static_cast<double>(rgb_at(image, pixel % 60, pixel / 60).x);
                }
            }
            // Its profile integrates to a third of its area, and a pixel off the center spans less.
            const float cosine = 1 / glm::length(Vec3(aside, aside, 1));
            const float expected = kPi / 3 * square(0.5f * diameter) / cosine;
            CHECK(
                sum / (kShifts * kShifts)
                == test::near(static_cast<double>(expected)).epsilon(0.02));
        }
    }
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: a point smaller than a pixel is fainter, wherever it lies in the pixel") {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.facing = ParticleFacing::Point;
    const auto sum_of = [&](float diameter, float shift) {  // [px], of 30 a meter
        look.size = diameter / 30;
        const Entity one = emit({{shift / 30, 0.01f, 0}}, look);
        const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 60, 60));
        world.destroy(one);
        double sum = 0;
        for (int i = 0; i < 3600; ++i) {
            sum += static_cast<double>(rgb_at(image, i % 60, i / 60).x);
        }
        return sum;
    };
    for (const float shift : {0.1f, 0.4f, 0.8f}) {
        CAPTURE(shift);
        const double whole = sum_of(1, shift);
        CHECK(whole > 0.02);
        CHECK(sum_of(0.5f, shift) == near(whole / 4).epsilon(0.01));
        CHECK(sum_of(0.125f, shift) == near(whole / 64).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: points and quads among each other hide each other in order") {
    ParticleLook point = disc({1, 0, 0}, 1, 1);
    point.facing = ParticleFacing::Point;
    ParticleLook quad = disc({0, 1, 0}, 1, 1);
    ImageData white;
    white.width = white.height = 1;
    white.pixels = {255, 255, 255, 255};
    quad.image = add(white);
    quad.turn_spread = 0;
    emit({{0, 0, -0.2f}, {0, 0, 0.2f}}, point);
    emit({{0, 0, 0}}, quad);
    const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 60, 60));
    CHECK(rgb_at(image, 30, 30).x > 0.98f);  // the nearer point
    CHECK(rgb_at(image, 30, 30).y < 0.02f);
    // A corner of the quad, where a disc does not reach.
    CHECK(rgb_at(image, 17, 17).y > 0.98f);
    CHECK(rgb_at(image, 17, 17).x < 0.02f);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a disc on the ground is none of the points behind it") {
    ParticleLook point = disc({1, 0, 0}, 1, 1);
    point.facing = ParticleFacing::Point;
    ParticleLook flat = disc({0, 1, 0}, 1, 1);
    flat.facing = ParticleFacing::Ground;
    emit({{0, 0, -0.2f}}, point);
    emit({{0, 0.001f, 0}}, flat);  // edge-on
    CHECK(center_pixel().x > 0.98f);
    CHECK(center_pixel().y < 0.02f);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: the last seconds of a life fade out"
                       * technique("engine.particle-params, particle.gpu-draw")) {
    // Half a second of the life of one is left.
    ParticleLook look = disc({1, 1, 1}, 1, 1);
    const float whole = (emit({{0, 0, 0}}, look), center_pixel().x);
    const auto faded = [&](float fade) {
        world.query<ParticleLook>().each([&](ParticleLook& drawn) { drawn.fade = fade; });
        return center_pixel().x / whole;
    };
    CHECK(faded(0.25f) == near(1).epsilon(1e-3));
    CHECK(faded(0.5f) == near(1).epsilon(1e-3));
    CHECK(faded(1) == near(0.5).epsilon(2e-3));
    CHECK(faded(2) == near(0.25).epsilon(2e-3));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: the color at half the life is the mean of first and last"
                       * technique("engine.particle-params")) {
    ParticleLook look = disc({1, 0, 0}, 1, 1);
    look.colors.push_back({.at = 1, .color = {0, 0, 0.5f}});
    emit({{0, 0, 0}}, look);
    CHECK(center_pixel().x == near(0.5).epsilon(2e-3));
    CHECK(center_pixel().z == near(0.25).epsilon(2e-3));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a periodic function of the age chooses the color"
                       * technique("engine.particle-cpu")) {
    ParticleLook look = disc({1, 0, 0}, 1, 1);
    look.colors.push_back({.at = 1, .color = {0, 0, 1}});
    emit({{0, 0, 0}}, look);
    const float lag = 0;  // the frame shows the end of the step
    for (const Wave wave :
         {Wave::Sine, Wave::Triangle, Wave::Square, Wave::Sawtooth, Wave::Noise}) {
        for (const float phase : {0.0f, 0.15f, 0.6f}) {
            CAPTURE(static_cast<int>(wave));
            const PeriodicFunction function = {
                .wave = wave, .base = 0.4f, .amplitude = 0.5f, .phase = phase, .frequency = 1.3f};
            world.query<ParticleLook>().each(
                [&](ParticleLook& drawn) { drawn.color_function = function; });
            const double fraction = evaluate_share(function, 0.5 - static_cast<double>(lag));
            const Vec3 color = center_pixel();
            CHECK(color.z == near(fraction).scale(1).epsilon(5e-3));
            CHECK(color.x == near(1 - fraction).scale(1).epsilon(5e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: colors vary within their spread, each channel by itself, never below 0"
        * technique("engine.particle-cpu")) {
    ParticleLook look = disc({0.5f, 0.5f, 0.1f}, 1, 1);
    look.color_spread = {0.2f, 0, 0.4f};
    emit({{0, 0, 0}}, look);
    Vec3 low(10);
    Vec3 high(-10);
    for (std::uint32_t i = 0; i < 60; ++i) {
        world.query<ParticlePool>().each(
            [&](ParticlePool& pool) { pool.look[0] = i * 0x9e3779b9u; });
        const Vec3 color = center_pixel();
        low = glm::min(low, color);
        high = glm::max(high, color);
    }
    const float slack = 0.004f;
    CHECK(low.x >= 0.3f - slack);
    CHECK(low.x < 0.35f);
    CHECK(high.x <= 0.7f + slack);
    CHECK(high.x > 0.65f);
    CHECK(high.y - low.y < slack);
    CHECK(low.z == 0);
    CHECK(high.z <= 0.5f + slack);
    CHECK(high.z > 0.4f);
}

TEST_CASE(
    "particle pass: between steps they are earlier on their paths, and absent before birth"
    * technique("particle.gpu-draw")) {
    ParticlePool pool;
    for (const float age : {0.5f, 0.01f}) {
        pool.x.push_back(3);
        pool.y.push_back(0);
        pool.z.push_back(0);
        pool.vx.push_back(10);
        pool.vy.push_back(0);
        pool.vz.push_back(0);
        pool.age.push_back(age);
        pool.life.push_back(2);
        pool.look.push_back(1);
    }
    std::vector<ParticleInstance> instances;
    append_particles(pool, 5, 0.1f, instances);
    REQUIRE(instances.size() == 1);
    CHECK(instances[0].position.x == test::near(2));
    CHECK((instances[0].look_and_life >> 16) == 5);
    CHECK((instances[0].look_and_life & 0xffff) / 65535.0 == test::near(0.2).epsilon(1e-3));
}

TEST_CASE(
    "particle pass: streaks show velocities relative to the camera, which has none after a cut"
    * technique("engine.space-dust")) {
    World world;
    const Affine from = affine_from({1, 2, 3}, Quat(1, 0, 0, 0), Vec3(1));
    const Affine to = affine_from({1, 2, 2}, Quat(1, 0, 0, 0), Vec3(1));
    const Affine far = affine_from({1, 2, 900}, Quat(1, 0, 0, 0), Vec3(1));
    const Entity moving = world.create(WorldTransform{to}, PreviousWorldTransform{from});
    const Entity cut = world.create(WorldTransform{to}, PreviousWorldTransform{far});
    CHECK(entity_velocity(world, moving, 0.1f).z == near(-10));
    CHECK(entity_velocity(world, cut, 0.1f) == Vec3(0));
    CHECK(entity_velocity(world, Entity{}, 0.1f) == Vec3(0));
    ParticlePool pool;
    for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.life}) {
        column->push_back(1);
    }
    pool.age.push_back(0);
    pool.look.push_back(0);
    std::vector<ParticleInstance> instances;
    append_particles(pool, 0, 0, instances, {0, 0, -10});
    REQUIRE(instances.size() == 1);
    CHECK(instances[0].motion().z == near(11));
    CHECK(instances[0].position.z == 1);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: they fade near the camera and far from it, and in between not") {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    emit({{0, 0, 0}}, look);
    const float plain = center_pixel().x;
    world.clear();
    look.near_fade = 0.9f;  // the camera is 1 m away
    look.far_fade = 2;
    emit({{0, 0, 0}}, look);
    CHECK(center_pixel().x == near(plain));
    world.clear();
    look.near_fade = 2;
    emit({{0, 0, 0}}, look);
    CHECK(center_pixel().x == near(0.5f * plain).epsilon(0.01));
    world.clear();
    look.near_fade = 0;
    look.far_fade = 1.25f;  // midway between 0.75 and 1.25
    emit({{0, 0, 0}}, look);
    CHECK(center_pixel().x == near(0.5f * plain).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: light adds up, in any order; black and what is hidden add none"
                       * technique("particle.light-source-render")) {
    const std::vector<Vec3> positions = {{0, 0, -0.3f}, {0, 0, 0}, {0, 0, -0.1f}, {0, 0, 0.2f}};
    emit(positions, disc({0.25f, 0.5f, 1}, 0.5f, 0));
    const Vec3 four = center_pixel();
    for (int c = 0; c < 3; ++c) {
        CHECK(four[c] == near(4 * 0.5f * Vec3(0.25f, 0.5f, 1)[c]).epsilon(1e-5));
    }
    world.clear();
    emit({positions[3], positions[1], positions[0], positions[2]}, disc({0.25f, 0.5f, 1}, 0.5f, 0));
    CHECK(glm::length(center_pixel() - four) < 1e-5f);
    emit(positions, disc({0, 0, 0}, 1, 0));
    CHECK(glm::length(center_pixel() - four) < 1e-5f);
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        at({0, 0, -0.2f}));
    emit({{0, 0, -0.5f}}, disc({9, 9, 9}, 1, 1));
    CHECK(center_pixel().z == near(1 + 3 * 0.5f).epsilon(1e-5));  // one of the four is behind, too
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: those that cover are blended as by hand, whichever emitter they have") {
    const Vec3 red = {1, 0.1f, 0};
    const Vec3 green = {0, 1, 0.2f};
    const Vec3 blue = {0.3f, 0, 1};
    emit({{0, 0, 0}}, disc(blue, 0.25f, 1));
    emit({{0, 0, -0.6f}}, disc(red, 0.5f, 1));
    emit({{0, 0, -0.3f}}, disc(green, 0.75f, 1));
    Vec3 want = 0.5f * red;
    want = 0.25f * want + 0.75f * green;
    want = 0.75f * want + 0.25f * blue;
    CHECK(glm::length(center_pixel() - want) < 2e-3f);
    // Half a cover hides half as much.
    world.clear();
    emit({{0, 0, -0.6f}}, disc(red, 1, 1));
    emit({{0, 0, 0}}, disc(green, 0.5f, 0.5f));
    CHECK(glm::length(center_pixel() - (0.75f * red + 0.5f * green)) < 2e-3f);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: they fade over their softness where they meet a surface") {
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}}), at({0, 0, 0}));
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.softness = 0.4f;
    for (const float ahead : {0.1f, 0.2f, 0.4f, 0.6f}) {
        CAPTURE(ahead);
        emit({{0, 0, ahead}}, look);
        CHECK(center_pixel().x == near(std::min(ahead / 0.4f, 1.0f)).epsilon(1e-3));
        world.query<const ParticlePool>().each(
            [&](Entity entity, const ParticlePool&) { world.get<ParticlePool>(entity) = {}; });
    }
}

TEST_CASE_FIXTURE(
    ParticleScene,
    "particle pass: lit ones scatter as much as light falls on them, forward ones from behind") {
    ParticleLook look = disc({1, 1, 1}, 1, 1);
    look.emission = 0;
    look.lit = 1;
    emit({{0, 0, 0}}, look);
    CHECK(center_pixel() == Vec3(0));
    const auto sun = [&](const Vec3& travels, float illuminance) {
        world.query<const DirectionalLight>().each([&](Entity entity, const DirectionalLight&) {
            world.get<DirectionalLight>(entity).illuminance = 0;
        });
        shine(DirectionalLight{.illuminance = illuminance}, look_at(Vec3(0), travels));
        return center_pixel().x;
    };
    const float front = sun({0, 0, -1}, 1);
    const float behind = sun({0, 0, 1}, 1);
    CHECK(front > 0.1f);
    CHECK(front < 1 / kPi);
    CHECK(behind < 0.25f * front);
    CHECK(sun({0, 0, -1}, 3) == near(3 * front).epsilon(1e-4));
    world.query<const ParticleLook>().each([&](Entity entity, const ParticleLook&) {
        world.get<ParticleLook>(entity).forward = 0.9f;
    });
    // Mostly by the lobe, which is (1 - g^2) / (1 - g)^3 / 4 of 1 / pi.
    const float lobe = 0.9f * (1 - 0.81f) / (4 * 0.001f) / kPi;
    CHECK(sun({0, 0, 1}, 1) == near(lobe).epsilon(0.02));
    CHECK(sun({0, 0, -1}, 1) < 0.2f * front);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a streak is as long as its path, and points along it") {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.size = 0.1f;
    look.facing = ParticleFacing::Velocity;
    look.stretch = 0.1f;
    emit({{0, 0, 0}}, look);
    world.query<const ParticlePool>().each(
        [&](Entity entity, const ParticlePool&) { world.get<ParticlePool>(entity).vx = {10}; });
    const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 65, 65));
    int wide = 0;
    int high = 0;
    for (int i = 0; i < 65; ++i) {
        wide += image.at(i, 32, 0) > 0 ? 1 : 0;
        high += image.at(32, i, 0) > 0 ? 1 : 0;
    }
    CHECK(
        std::abs(wide - 1.1 * 32.5)
        <= 2);  // its diameter and 10 m/s for 0.1 s, 32.5 pixels a meter
    CHECK(std::abs(high - 0.1 * 32.5) <= 2);
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a flipbook shows the frame of its time, mixed with the next") {
    ImageData image;
    image.width = 8;
    image.height = 4;
    image.pixels.resize(8 * 4 * 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            std::uint8_t* const texel = &image.pixels[static_cast<std::size_t>(y * 8 + x) * 4];
            texel[0] = x < 4 ? 255 : 0;
            texel[1] = x < 4 ? 0 : 255;
            texel[2] = 0;
            texel[3] = 255;
        }
    }
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.image = add(image);
    look.columns = 2;
    look.turn_spread = 0;
    look.frame_rate =
        2.5f;  // half a second: a quarter into the second frame, before the first again
    emit({{0, 0, 0}}, look);
    const Vec3 color = center_pixel();
    CHECK(color.y == near(0.75f).epsilon(0.02));
    CHECK(color.x == near(0.25f).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: a picked frame stays and is not mixed; shuffled ones play on") {
    ImageData image;
    image.width = 8;
    image.height = 4;
    for (int i = 0; i < 8 * 4; ++i) {
        for (const int value : {i % 8 < 4 ? 255 : 0, i % 8 < 4 ? 0 : 255, 0, 255}) {
            image.pixels.push_back(static_cast<std::uint8_t>(value));
        }
    }
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.image = add(image);
    look.columns = 2;
    look.turn_spread = 0;
    look.frame_rate = 2.5f;
    look.frames = ParticleFrames::Pick;
    emit({{0, 0, 0}}, look);
    const Vec3 picked = center_pixel();
    CHECK(std::max(picked.x, picked.y) == near(1).epsilon(0.02));
    CHECK(std::min(picked.x, picked.y) == near(0));
    world.clear();
    look.frames = ParticleFrames::Shuffle;
    emit({{0, 0, 0}}, look);  // a quarter of the transition to the other frame
    const Vec3 shuffled = center_pixel();
    const bool is_second_first = picked.y > 0.5f;
    CHECK(shuffled.y == near(is_second_first ? 0.25f : 0.75f).epsilon(0.02));
}

TEST_CASE_FIXTURE(ParticleScene, "particle pass: tumbling quads are edge-on at times") {
    ParticleLook look = disc({1, 1, 1}, 1, 0);
    look.turn_spread = 0;
    const auto lit_pixels = [&] {
        int count = 0;
        const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 33, 33));
        for (int x = 0; x < 33; ++x) {
            count += rgb_at(image, x, 16).x > 0.01f ? 1 : 0;
        }
        return count;
    };
    emit({{0, 0, 0}}, look);
    const int whole = lit_pixels();
    int narrowest = whole;
    for (const float speed : {2.0f, 4.0f, 6.0f, 8.0f, 10.0f, 12.0f}) {
        world.clear();
        look.tumble = speed;
        emit({{0, 0, 0}}, look);
        const int count = lit_pixels();
        CHECK(count <= whole + 4);  // the near half looms
        narrowest = std::min(narrowest, count);
    }
    CHECK(narrowest < whole / 2);
}

TEST_CASE(
    "particle light: one for each particle that has been born, where it is, along its curve") {
    World world;
    register_all_components();
    ParticlePool pool;
    for (int i = 0; i < 10; ++i) {
        const auto at = static_cast<float>(i);
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vz}) {
            column->push_back(at);
        }
        pool.vy.push_back(0);
        pool.age.push_back(0.1f * at);
        pool.life.push_back(1);
        pool.look.push_back(i < 5 ? 0x1000 : 0xf000);
    }
    ParticleLight light{.color = {1, 0.5f, 0}, .intensity = 10, .radius = 2};
    light.curve = {{.at = 0, .value = 2}, {.at = 1, .value = 0}};
    const Entity entity = world.create(light, pool);
    LightList list;
    add_particle_lights(world, 0.05f, list);
    REQUIRE(list.records.size() == 9);  // the first was not there yet
    REQUIRE(list.ranges.size() == 9);
    CHECK(list.points == 9);
    for (int i = 1; i < 10; ++i) {
        const layout::LightRecord& record = list.records[static_cast<std::size_t>(i - 1)];
        CHECK(record.position.x == test::near(0.95 * i));
        CHECK(record.position.y == test::near(i));
        CHECK(record.color.x == test::near(20 * (1 - (0.1 * i - 0.05))));
        CHECK(record.color.y == test::near(10 * (1 - (0.1 * i - 0.05))));
        CHECK(record.position.w == test::near(0.25));
    }
    world.get<ParticleLight>(entity).share = 0.5f;
    list = {};
    add_particle_lights(world, 0, list);
    CHECK(list.points == 5);
    world.get<ParticleLight>(entity).share = 1;
    world.get<ParticleLight>(entity).count = 3;
    list = {};
    add_particle_lights(world, 0, list);
    CHECK(list.points == 3);
    CHECK(list.records[2].position.y == 2);  // the oldest
    world.get<ParticlePool>(entity) = {};
    list = {};
    add_particle_lights(world, 0, list);
    REQUIRE(list.points == 1);  // a black one, so that shaders stay the same
    CHECK(Vec3(list.records[0].color) == Vec3(0));
}

TEST_CASE_FIXTURE(
    ParticleScene, "particle pass: 1, 10 and 1,000 emitters of a look are as many draw calls") {
    const auto draws = [&] {
        device().reset_stats();
        draw(view());
        return device().stats().draws;
    };
    draws();  // the first image makes maps
    const int none = draws();
    emit({{0, 0, 0}}, disc({1, 1, 1}, 0.5f, 1));
    const int one = draws();
    CHECK(none < one);
    for (int emitters = 1; emitters < 1000; ++emitters) {
        if (emitters == 10) {
            CHECK(draws() == one);
        }
        emit({{0, 0, -0.001f * static_cast<float>(emitters)}}, disc({1, 1, 1}, 0.5f, 1));
    }
    CHECK(draws() == one);
}

}  // namespace limn::test::particle_pass_test

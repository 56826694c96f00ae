#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

namespace limn::test::particle_layer_test {
namespace {

/// Smoke that shines by itself, and bars in front of it.
struct LayerScene : Scene {
    Entity bars[5] = {};

    LayerScene() { world.insert_resource(FrameTime{}); }

    /// White, 5 cm wide, in z = 0, leaning a little.
    void add_bars() {
        const MeshId square = add(make_square());
        const MaterialId white =
            add(Material{.base_color = {0, 0, 0, 1}, .emission = {0.6f, 0.6f, 0.6f}});
        for (int i = 0; i < 5; ++i) {
            bars[i] = place(
                square, white,
                affine_from(
                    {0.4f * static_cast<float>(i) - 0.77f, 0, 0},
                    glm::angleAxis(0.1f, Vec3(0, 0, 1)), {0.05f, 2, 1}));
        }
    }
    Entity emit(const std::vector<Vec3>& positions, const ParticleLook& look) {
        ParticlePool pool;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            pool.x.push_back(positions[i].x);
            pool.y.push_back(positions[i].y);
            pool.z.push_back(positions[i].z);
            for (auto* column : {&pool.vx, &pool.vy, &pool.vz}) {
                column->push_back(0);
            }
            pool.age.push_back(0.5f);
            pool.life.push_back(1);
            pool.look.push_back(static_cast<std::uint32_t>(7 * i));
        }
        return world.create(ParticleEmitter{}, look, pool);
    }
    /// Thirty puffs behind the bars.
    void add_smoke() {
        std::vector<Vec3> positions;
        for (int i = 1; i <= 30; ++i) {
            const auto fraction = [&](double step) { return std::fmod(step * i, 1.0); };
            positions.emplace_back(
                3 * fraction(0.8191725134) - 1.5, 3 * fraction(0.6710436067) - 1.5,
                -0.5 - 2 * fraction(0.5497004779));
        }
        emit(positions, puff({0.9f, 0.2f, 0.1f}, 0.6f, 1.4f));
    }
    static ParticleLook puff(const Vec3& color, float opacity, float size) {
        ParticleLook look;
        look.size = size;
        look.colors = {{.at = 0, .color = color, .opacity = opacity}};
        look.emission = 1;
        look.lit = 0;
        return look;
    }
    void set_resolution(ParticleResolution resolution) {
        world.query<ParticleLook>().each([&](ParticleLook& look) { look.resolution = resolution; });
    }
    gpu::FloatImage drawn(ParticleResolution resolution, int width = 128, int height = 96) {
        set_resolution(resolution);
        return radiance(look({0, 0, 1}, {0, 0, 0}, width, height));
    }
};

double decibels(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const auto off = static_cast<double>(a.at(x, y, c) - b.at(x, y, c));
                sum += off * off;
                ++count;
            }
        }
    }
    return -10 * std::log10(sum / count);
}

}  // namespace

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: smoke behind bars is that of full resolution, to 36 dB"
                    * technique("particle.half-resolution")) {
    add_bars();
    add_smoke();
    const gpu::FloatImage full = drawn(ParticleResolution::Full);
    const gpu::FloatImage half = drawn(ParticleResolution::Half);
    CHECK(decibels(half, full) >= 36);
    CHECK(largest_difference(half, full) > 1e-4f);
    // At odd sizes too.
    CHECK(
        decibels(drawn(ParticleResolution::Half, 127, 95), drawn(ParticleResolution::Full, 127, 95))
        >= 36);
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: a flipbook plays whether those of the other layer play or not") {
    ImageData image;  // a red frame and a green one
    image.width = 8;
    image.height = 4;
    for (int i = 0; i < 8 * 4; ++i) {
        for (const int value : {i % 8 < 4 ? 255 : 0, i % 8 < 4 ? 0 : 255, 0, 255}) {
            image.pixels.push_back(static_cast<std::uint8_t>(value));
        }
    }
    ParticleLook playing = puff({1, 1, 1}, 1, 1);
    playing.image = add(image);
    playing.columns = 2;  // at half the life, halfway between the two
    ParticleLook picked = playing;
    picked.frames = ParticleFrames::Pick;
    for (const ParticleResolution resolution :
         {ParticleResolution::Half, ParticleResolution::Full}) {
        const bool is_half = resolution == ParticleResolution::Half;
        playing.resolution = resolution;
        picked.resolution = is_half ? ParticleResolution::Full : ParticleResolution::Half;
        emit({{0, 0, 0}}, playing);
        emit({{-1.5f, 0, 0}}, picked);
        const Vec3 mixed = rgb_at(radiance(look({0, 0, 2}, {0, 0, 0}, 33, 33)), 16, 16);
        CHECK(mixed.x == near(0.5f).epsilon(0.05));
        CHECK(mixed.y == near(0.5f).epsilon(0.05));
        world.clear();
        world.insert_resource(FrameTime{});
    }
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: a puff anywhere in the image is drawn whole, and when it is gone"
                    * technique("particle.half-resolution")) {
    for (const Vec3& position : {Vec3(0.6f, 0.4f, 0), Vec3(-0.9f, -0.7f, 0), Vec3(0, 0.9f, -3)}) {
        const Entity smoke = emit({position}, puff({0.9f, 0.2f, 0.1f}, 0.8f, 0.5f));
        const gpu::FloatImage full = drawn(ParticleResolution::Full);
        CHECK(decibels(drawn(ParticleResolution::Half), full) >= 40);
        CHECK(*std::max_element(full.pixels.begin(), full.pixels.end()) > 0.2f);
        world.add(smoke, ParticlePool{});
        const gpu::FloatImage none = drawn(ParticleResolution::Half);
        CHECK(none.at(64, 48, 0) == 0);
        world.destroy(smoke);
    }
}

TEST_CASE_FIXTURE(LayerScene, "particle layer: puffs far apart in the image are all drawn") {
    const ParticleLook small = puff({0.9f, 0.2f, 0.1f}, 0.8f, 0.3f);
    emit({{-0.9f, -0.7f, 0}, {0.9f, 0.7f, 0}, {0.9f, -0.6f, -1}}, small);
    const gpu::FloatImage full = drawn(ParticleResolution::Full);
    CHECK(decibels(drawn(ParticleResolution::Half), full) >= 40);
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: points are as large as at full resolution"
                    * technique("particle.half-resolution")) {
    for (const auto facing : {ParticleFacing::Point, ParticleFacing::Pixels}) {
        ParticleLook point = puff({0.9f, 0.2f, 0.1f}, 0.8f, 0.5f);
        point.facing = facing;
        point.size = facing == ParticleFacing::Pixels ? 24.0f : 0.5f;
        const Entity smoke = emit({{0.1f, -0.2f, 0}}, point);
        const gpu::FloatImage full = drawn(ParticleResolution::Full);
        CHECK(decibels(drawn(ParticleResolution::Half), full) >= 40);
        world.destroy(smoke);
    }
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: smoke does not spill over what stands before it"
                    * technique("particle.half-resolution")) {
    add_bars();
    const gpu::FloatImage bare = drawn(ParticleResolution::Full);
    add_smoke();
    const gpu::FloatImage half = drawn(ParticleResolution::Half);
    int on_bars = 0;
    float spilled = 0;
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            if (bare.at(x, y, 0) > 0.5f) {
                ++on_bars;
                spilled = std::max(spilled, std::abs(half.at(x, y, 1) - bare.at(x, y, 1)));
            }
        }
    }
    CHECK(on_bars > 800);
    CHECK(spilled <= 0.01f);
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: ground at a shallow angle shows no checkerboard through mist") {
    const MaterialId black = add(Material{.base_color = {0, 0, 0, 1}});
    place(
        add(make_square()), black,
        affine_from({0, -0.3f, 0}, glm::angleAxis(-1.570796f, Vec3(1, 0, 0)), {50, 50, 1}));
    ParticleLook mist = puff({0.9f, 0.9f, 0.9f}, 0.8f, 3);
    mist.softness = 2;
    emit({{0, -0.2f, -2}, {1, -0.2f, -4}, {-1, -0.2f, -6}}, mist);
    const gpu::FloatImage full = drawn(ParticleResolution::Full);
    const gpu::FloatImage half = drawn(ParticleResolution::Half);
    // What differs from pixel to pixel in both directions.
    double board = 0;
    for (int y = 0; y + 1 < half.height; ++y) {
        for (int x = 0; x + 1 < half.width; ++x) {
            const auto off = [&](int i, int j) {
                return static_cast<double>(half.at(x + i, y + j, 0) - full.at(x + i, y + j, 0));
            };
            board = std::max(board, std::abs(off(0, 0) - off(1, 0) - off(0, 1) + off(1, 1)));
        }
    }
    CHECK(board <= 0.03);
    CHECK(decibels(half, full) >= 40);
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: it lies in the order where its median particle does"
                    * technique("particle.half-resolution")) {
    ParticleLook half = puff({1, 0, 0}, 0.9f, 4);
    half.resolution = ParticleResolution::Half;
    emit({{0, 0, 0}}, half);
    emit({{0, 0, -1}}, puff({0, 1, 0}, 0.9f, 4));
    const RenderView view = look({0, 0, 1}, {0, 0, 0});
    const Vec3 before = rgb_at(radiance(view), 32, 32);
    CHECK(before.x == test::near(0.9).epsilon(0.01));
    CHECK(before.y == test::near(0.09).epsilon(0.05));
    emit({{0, 0, 0.2f}}, puff({0, 0, 1}, 0.9f, 4));
    const Vec3 between = rgb_at(radiance(view), 32, 32);
    CHECK(between.z == test::near(0.9).epsilon(0.01));
    CHECK(between.x == test::near(0.09).epsilon(0.05));
    CHECK(between.y == test::near(0.009).epsilon(0.1));
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: its depths are the nearest and the farthest of four, in turn"
                    * technique("particle.half-resolution")) {
    add_bars();
    add_smoke();
    FrameGraph& graph = frame_graph(shared_renderer());
    graph.keep_named("particles.layer depth");
    graph.keep_named("gbuffer.depth");
    set_resolution(ParticleResolution::Half);
    draw(look({0, 0, 1}, {0, 0, 0}, 128, 96));
    const gpu::FloatImage full = gpu::read_floats(*graph.texture(graph.find("gbuffer.depth")));
    const gpu::FloatImage half =
        gpu::read_floats(*graph.texture(graph.find("particles.layer depth")));
    graph.forget_named("particles.layer depth");
    graph.forget_named("gbuffer.depth");
    REQUIRE(half.width == 64);
    REQUIRE(half.height == 48);
    int edges = 0;
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            const float four[] = {
                full.at(2 * x, 2 * y, 0), full.at(2 * x + 1, 2 * y, 0),
                full.at(2 * x, 2 * y + 1, 0), full.at(2 * x + 1, 2 * y + 1, 0)};
            const auto [low, high] = std::minmax_element(std::begin(four), std::end(four));
            const int row = half.height - 1 - y;  // of the texture, from the bottom
            CHECK(half.at(x, y, 0) == ((x + row) % 2 == 0 ? *high : *low));
            edges += *low < *high ? 1 : 0;
        }
    }
    CHECK(edges > 100);
}

TEST_CASE_FIXTURE(
    LayerScene, "particle layer: without looks of half the resolution there is none"
                    * technique("particle.half-resolution")) {
    add_smoke();
    (void)drawn(ParticleResolution::Full);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("particles.enlarge"));
    (void)drawn(ParticleResolution::Half);
    CHECK(frame_graph(shared_renderer()).was_run("particles.enlarge"));
}

}  // namespace limn::test::particle_layer_test

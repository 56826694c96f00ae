#include "ecs/base/optics.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "render/graph/frame_graph.h"
#include "render/water/water_details.h"
#include "systems/water/water_wave_table.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::water_detail_test {
namespace {

constexpr int kMapSize = 32;

/// A normal map whose slopes along u and along v (down the image) are those.
template <typename Slopes>
ImageData normal_map(Slopes&& slopes) {
    ImageData image;
    image.name = "normals";
    image.width = image.height = kMapSize;
    image.format = PixelFormat::Rgba32F;
    std::vector<Vec4> texels;
    for (int y = 0; y < kMapSize; ++y) {
        for (int x = 0; x < kMapSize; ++x) {
            const Vec2 s = slopes(x, y);
            texels.emplace_back(0.5f + 0.5f * glm::normalize(Vec3(-s.x, s.y, 1)), 1);
        }
    }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texels.data());
    image.pixels.assign(bytes, bytes + texels.size() * sizeof(Vec4));
    return image;
}

Vec2 bumps(int x, int y) {
    const float turn = 2 * kPi / kMapSize;
    return {
        0.3f * std::sin(turn * static_cast<float>(2 * x + y)),
        0.2f * std::cos(turn * static_cast<float>(x - 3 * y))};
}

/// Dark water under a uniform sky of 1: a pixel is the reflectance.
class Tile : public Scene {
  public:
    Tile() {
        world.insert_resource(Exposure{});
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform,
            .zenith = Vec3(1),
            .horizon = Vec3(1),
            .ground = Vec3(1),
            .visible = true});
        set_time(0);
        pond = world.create(
            Water{.size = {40, 40}, .absorption = Vec3(1000), .scattering = Vec3(0)},
            WorldTransform{at({0, 0, 0})});
    }
    void set_time(double time) {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = time});
    }
    gpu::FloatImage with(const WaterDetail& detail) {
        world.add(pond, detail);
        gpu::FloatImage seen = radiance(view);
        world.remove<WaterDetail>(pond);
        return seen;
    }

    Entity pond;
    RenderView view = look({0, 2, 0}, {0, 0, -3.5f}, 64, 64);
};

WaveTable some_waves() {
    WaterWaves waves;
    for (int i = 0; i < 12; ++i) {
        const auto n = static_cast<float>(i);
        waves.waves.push_back(
            {.amplitude = 0.004f + 0.001f * n,
             .length = 6.0f / (1 + 0.4f * n),
             .direction = 0.7f * n,
             .phase = n});
    }
    WaveTable table;
    fill_wave_table({}, waves, 1.7, table);
    return table;
}

WaveLine line_of(float length, float amplitude = 0.01f) {
    return {.k = {2 * kPi / length, 0}, .amplitude = amplitude};
}

}  // namespace

TEST_CASE(
    "water detail: four waves displace vertices, sixteen more are in the texture, no others"
    * technique("water.geometric-texture-split")) {
    std::vector<WaveLine> lines;
    for (int i = 0; i < 30; ++i) {
        lines.push_back(line_of(20.0f - 0.5f * static_cast<float>(i)));
    }
    const WaveSplit split = split_waves(lines, {.split = 1}, 0.1f);
    CHECK(split.geometric == 4);
    CHECK(split.texture.size() == 16);
    CHECK(split.texture.front() == 4);
    CHECK(split.left_out.size() == 10);
}

TEST_CASE(
    "water detail: only waves of two cells or longer displace vertices, at any split"
    * technique("water.geometric-texture-split")) {
    const std::vector<WaveLine> lines = {line_of(9), line_of(3), line_of(1), line_of(0.5f)};
    CHECK(split_waves(lines, {.split = 0.1f}, 0.1f).geometric == 4);
    CHECK(split_waves(lines, {.split = 2}, 0.1f).geometric == 2);
    CHECK(split_waves(lines, {.split = 0.1f}, 0.6f).geometric == 2);
    CHECK(split_waves(lines, {.split = 0.1f}, 6).geometric == 0);
    // Nor are waves drawn that the texture could not show.
    CHECK(split_waves(lines, {.split = 10, .tile = 100}, 0.1f).texture.size() == 2);
    CHECK(split_waves(lines, {.split = 10, .tile = 100}, 0.1f).left_out.size() == 2);
}

TEST_CASE(
    "water detail: waves in the texture fit into its tile and keep their frequency"
    * technique("water.geometric-texture-split")) {
    const WaterDetail detail = {.split = 3, .tile = 5};
    const WaveTable before = some_waves();
    WaveTable table = before;
    snap_waves(detail, table);
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
        const WaveLine& line = table.lines[i];
        CHECK(line.frequency == before.lines[i].frequency);
        if (2 * kPi / glm::length(before.lines[i].k) >= detail.split) {
            CHECK(line.k == before.lines[i].k);
            continue;
        }
        const Vec2 whole = line.k * (detail.tile / (2 * kPi));
        CHECK(glm::distance(whole, glm::round(whole)) < 1e-4f);
        CHECK(glm::length(whole) > 0.5f);
        CHECK(glm::distance(line.k, before.lines[i].k) <= 0.71f * 2 * kPi / detail.tile);
    }
}

TEST_CASE_FIXTURE(
    Tile, "water detail: at any split, slopes are the same within 1e-4"
              * technique("water.geometric-texture-split")) {
    for (const float split : {0.5f, 2.0f, 4.0f, 100.0f}) {
        CAPTURE(split);
        const WaterDetail detail = {.split = split, .tile = 12};
        WaveTable table = some_waves();
        snap_waves(detail, table);
        world.add(pond, table);
        with(detail);
        FrameGraph& graph = frame_graph(shared_renderer());
        REQUIRE(graph.was_run("texture waves"));
        const gpu::FloatImage tile = gpu::read_floats(*graph.texture(graph.find("wave tiles")));
        WaveTable geometric = table;
        const float cell = 0.25f / 16;
        geometric.lines.resize(split_waves(table.lines, detail, cell).geometric);
        CHECK(geometric.lines.size() == (split < 3 ? 4 : split < 5 ? 2 : 0));
        for (int i = 0; i < 40; ++i) {
            const int x = i * 97 % kWaveTileSize;
            const int z = i * 61 % kWaveTileSize;
            // Beyond its border the tile begins anew.
            const Vec2 q = (Vec2(x, z) + 0.5f) * (detail.tile / kWaveTileSize)
                           + detail.tile * Vec2(i % 3 - 1, i % 2);
            const WavePoint all = evaluate_waves(table, q);
            const WavePoint moved = evaluate_waves(geometric, q);
            const int row = kWaveTileSize - 1 - z;
            CHECK(std::abs(all.by_x.y - moved.by_x.y - tile.at(x, row, 0)) < 1e-4f);
            CHECK(std::abs(all.by_z.y - moved.by_z.y - tile.at(x, row, 1)) < 1e-4f);
        }
        world.remove<WaveTable>(pond);
    }
}

TEST_CASE_FIXTURE(
    Tile, "water detail: a smaller mip level stores lost slopes as variance"
              * technique("water.geometric-texture-split")) {
    const WaterDetail detail = {.split = 100, .tile = 12};
    WaveTable table = some_waves();
    snap_waves(detail, table);
    world.add(pond, table);
    with(detail);
    FrameGraph& graph = frame_graph(shared_renderer());
    const gpu::Texture& tile = *graph.texture(graph.find("wave tiles"));
    double expected = 0;
    for (const WaveLine& line : table.lines) {
        expected += 0.5 * static_cast<double>(square(line.amplitude) * glm::dot(line.k, line.k));
    }
    const gpu::FloatImage last = gpu::read_floats(tile, 8);
    CHECK(std::abs(last.at(0, 0, 0)) < 1e-4f);
    CHECK(std::abs(last.at(0, 0, 2) - expected) < 0.01 * expected);
}

TEST_CASE_FIXTURE(
    Tile, "water detail: waves in the texture look like waves that displace vertices"
              * technique("water.geometric-texture-split")) {
    const WaterDetail detail = {.split = 100, .tile = 12};
    WaveTable table = some_waves();
    snap_waves(detail, table);
    for (WaveLine& line : table.lines) {
        line.amplitude *= 0.2f;  // so low that it does not matter where they are
    }
    const gpu::FloatImage flat = radiance(view);
    world.add(pond, table);
    const gpu::FloatImage moved = radiance(view);
    const gpu::FloatImage drawn = with(detail);
    double with_waves = 0;
    double off = 0;
    for (int y = 48; y < 64; ++y) {  // farther away vertices are too few for the shortest
        for (int x = 0; x < 64; ++x) {
            with_waves += static_cast<double>(square(moved.at(x, y, 0) - flat.at(x, y, 0)));
            off += static_cast<double>(square(moved.at(x, y, 0) - drawn.at(x, y, 0)));
        }
    }
    CHECK(with_waves > 5e-5);
    CHECK(off < 0.05 * with_waves);
}

TEST_CASE_FIXTURE(
    Tile, "water detail: flat layers, or layers of strength 0, do not change the water"
              * technique("water.scrolling-normal-map")) {
    const gpu::FloatImage plain = radiance(view);
    const ImageId map = add(normal_map(bumps));
    const ImageId even = add(normal_map([](int, int) { return Vec2(0); }));
    CHECK(
        largest_difference(with({.normal_map = map, .layers = {{.strength = 0}}}), plain) < 1e-4f);
    CHECK(largest_difference(with({.normal_map = map}), plain) == 0);
    CHECK(
        largest_difference(with({.normal_map = even, .layers = {{}, {.tile = 2}}}), plain) < 1e-4f);
    CHECK(largest_difference(with({.normal_map = map, .layers = {{}}}), plain) > 0.01f);
}

TEST_CASE_FIXTURE(
    Tile, "water detail: a layer scrolls like its map, and repeats after a tile"
              * technique("water.scrolling-normal-map")) {
    const ImageId map = add(normal_map(bumps));
    const WaterDetail moving = {
        .normal_map = map, .layers = {{.tile = 2, .direction = 0, .speed = 0.5f}}};
    const gpu::FloatImage start = with(moving);
    set_time(4);  // once around
    CHECK(largest_difference(with(moving), start) < 1e-3f);
    set_time(4.0e6);  // and after weeks
    CHECK(largest_difference(with(moving), start) < 1e-3f);
    set_time(1);  // a quarter of a copy, along +x
    const gpu::FloatImage moved = with(moving);
    CHECK(largest_difference(moved, start) > 0.01f);
    const ImageId shifted = add(normal_map(
        [](int x, int y) { return bumps((x + kMapSize - kMapSize / 4) % kMapSize, y); }));
    WaterDetail still = moving;
    still.normal_map = shifted;
    still.layers[0].speed = 0;
    const gpu::FloatImage as_moved = with(still);
    for (int y = 40; y < 64; ++y) {  // where its texels are visible, no smaller level
        for (int x = 0; x < 64; ++x) {
            CHECK(std::abs(as_moved.at(x, y, 0) - moved.at(x, y, 0)) < 1e-3f);
        }
    }
}

TEST_CASE_FIXTURE(
    Tile, "water detail: layers add up by their normals and strengths"
              * technique("water.scrolling-normal-map")) {
    // Maps of one slope: the water is tilted as a whole.
    const auto tilted = [](int, int) { return Vec2(0.1f, -0.15f); };
    const ImageId map = add(normal_map(tilted));
    const gpu::FloatImage seen =
        with({.normal_map = map, .layers = {{.tile = 3}, {.tile = 1.3f, .strength = 2}}});
    // (n.xy + 2 n.xy) / (n.z + n.z): one and a half times as steep.
    const Vec3 normal = glm::normalize(Vec3(-0.15f, 1, 0.225f));
    for (const int y : {36, 44, 52, 60}) {
        for (const int x : {10, 32, 50}) {
            const Vec2 ndc = (Vec2(x, 63 - y) + 0.5f) / 32.0f - 1.0f;
            const auto& pose = view.world_from_camera.row;
            const Vec3 in_camera = glm::normalize(Vec3(ndc * view.tangent, -1));
            const Vec3 ray(
                glm::dot(Vec3(pose[0]), in_camera), glm::dot(Vec3(pose[1]), in_camera),
                glm::dot(Vec3(pose[2]), in_camera));
            const float expected = fresnel(-glm::dot(ray, normal), 1.333f);
            CHECK(std::abs(seen.at(x, y, 0) - expected) < 0.01f * expected);
        }
    }
}

TEST_CASE_FIXTURE(
    Tile, "water detail: without it there is no pass, and no map is required"
              * technique("water.scrolling-normal-map")) {
    with({});
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("texture waves"));
    const gpu::FloatImage plain = radiance(view);
    CHECK(largest_difference(with({.normal_map = {77}, .layers = {{}}}), plain) == 0);
}

}  // namespace limn::test::water_detail_test

#include "content/bake/chart_samples.h"
#include "content/bake/detail_bake.h"
#include "content/bake/tangents.h"
#include "content/make/models/shapes.h"
#include "ecs/base/jobs.h"
#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace limn::detail_bake_test {
namespace {

constexpr DetailSettings kSmall = {
    .width = 64, .height = 64, .samples = 1, .distance = 0.1f, .padding = 2};

MeshData make_low_sphere() {
    return make_sphere({.radius = 1, .segments = 12, .rings = 6});
}

MeshData make_high_sphere() {
    return make_sphere({.radius = 1, .segments = 200, .rings = 100});
}

float degrees_between(const Vec3& a, const Vec3& b) {
    return degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

DetailBake bake(const MeshData& low, const MeshData& high, const DetailSettings& settings) {
    Result<DetailBake> baked = bake_detail(low, high, settings);
    REQUIRE_MESSAGE(baked.ok(), (baked ? std::string() : baked.error().message));
    return std::move(*baked);
}

/// Where the center of each texel is on the mesh.
std::vector<ChartSample> centers(const MeshData& mesh, const DetailSettings& settings) {
    const Charts charts(mesh.uvs, mesh.indices, settings.width, settings.height);
    std::vector<ChartSample> samples;
    (void)charts.sample(0, settings.height, samples);
    return samples;
}

template <typename T>
T interpolate(const MeshData& mesh, const ChartSample& sample, const std::vector<T>& values) {
    const std::size_t first = std::size_t{3} * static_cast<std::size_t>(sample.triangle);
    return sample.weights.x * values[mesh.indices[first]]
           + sample.weights.y * values[mesh.indices[first + 1]]
           + sample.weights.z * values[mesh.indices[first + 2]];
}

/// A square at z = `z` over 0 .. 1, the image upright.
MeshData make_square(float z) {
    MeshData mesh;
    mesh.name = "square";
    for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        mesh.positions.emplace_back(uv.x, 1 - uv.y, z);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.tangents.emplace_back(1, 0, 0, 1);
        mesh.uvs.push_back(uv);
    }
    mesh.indices = {0, 2, 1, 1, 2, 3};
    return mesh;
}

}  // namespace

TEST_CASE(
    "detail bake: a mesh baked to itself is flat, and has its own normals in object space"
    * technique("bump.nm-detail-recovery")) {
    const MeshData mesh = make_low_sphere();
    const DetailBake tangent = bake(mesh, mesh, kSmall);
    DetailSettings settings = kSmall;
    settings.object_space = true;
    const DetailBake object = bake(mesh, mesh, settings);
    CHECK(tangent.report.missed == 0);
    CHECK(tangent.report.overlapping == 0);
    const std::vector<ChartSample> samples = centers(mesh, kSmall);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].triangle < 0) {
            continue;
        }
        CHECK(degrees_between(decode_normal(Vec3(tangent.normal.texels[i])), {0, 0, 1}) < 0.1f);
        const Vec3 expected = interpolate(mesh, samples[i], mesh.normals);
        CHECK(degrees_between(decode_normal(Vec3(object.normal.texels[i])), expected) < 0.1f);
        CHECK(std::abs(tangent.height.texels[i].x - 0.5f) < 1e-4f);
    }
}

TEST_CASE(
    "detail bake: a coarse sphere gets the normals of a fine one within half a degree"
    * technique("bump.nm-detail-recovery")) {
    const MeshData low = make_low_sphere();
    DetailSettings settings = kSmall;
    settings.object_space = true;
    const DetailBake baked = bake(low, make_high_sphere(), settings);
    CHECK(baked.report.missed == 0);
    const std::vector<ChartSample> samples = centers(low, settings);
    float worst = 0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].triangle >= 0) {
            // The line along the normal, which points away from the center, meets the sphere there.
            const Vec3 n = glm::normalize(interpolate(low, samples[i], low.normals));
            const Vec3 p = interpolate(low, samples[i], low.positions);
            const float b = glm::dot(p, n);
            const Vec3 on_sphere = p + (std::sqrt(b * b + 1 - glm::dot(p, p)) - b) * n;
            const Vec3 found = decode_normal(Vec3(baked.normal.texels[i]));
            worst = std::max(worst, degrees_between(found, on_sphere));
            ++compared;
        }
    }
    CHECK(compared > 3000);
    CHECK(worst < 0.5f);
}

/// A sphere with waves: F(p) = |p| - 1 - 0.03 sin(6 x / |p|) = 0.
float distance_to_wave(const Vec3& p) {
    return glm::length(p) - 1 - 0.03f * std::sin(6 * p.x / glm::length(p));
}

TEST_CASE(
    "detail bake: shaded with its map, a coarse mesh has the normals of the fine one"
    * technique("bump.nm-detail-recovery")) {
    // As the renderer and MikkTSpace do: interpolated N and T, B = w cross(N, T), no normalization.
    const MeshData low = make_low_sphere();
    MeshData high = make_sphere({.radius = 1, .segments = 400, .rings = 200});
    for (Vec3& p : high.positions) {
        p *= 1 + 0.03f * std::sin(6 * p.x);
    }
    generate_normals(high);
    const DetailBake baked = bake(low, high, kSmall);
    const std::vector<std::uint8_t> bytes = map_bytes(baked.normal, 3);
    const std::vector<ChartSample> samples = centers(low, kSmall);
    double with_map = 0;
    double without = 0;
    double worst = 0;
    int count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].triangle < 0) {
            continue;
        }
        const Vec3 n = interpolate(low, samples[i], low.normals);
        const Vec4 t = interpolate(low, samples[i], low.tangents);
        const Vec3 b = glm::cross(n, Vec3(t)) * t.w;
        const Vec3 ts = Vec3(bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]) / 127.5f - 1.0f;
        const Vec3 shaded = ts.x * Vec3(t) + ts.y * b + ts.z * n;
        // Where the line along the normal meets the waves, and their gradient there.
        Vec3 p = interpolate(low, samples[i], low.positions);
        for (int k = 0; k < 30; ++k) {
            p -= distance_to_wave(p) * glm::normalize(n);
        }
        Vec3 truth;
        for (int c = 0; c < 3; ++c) {
            Vec3 h(0);
            h[c] = 1e-3f;
            truth[c] = distance_to_wave(p + h) - distance_to_wave(p - h);
        }
        worst = std::max<double>(worst, degrees_between(shaded, truth));
        with_map += degrees_between(shaded, truth);
        without += degrees_between(n, truth);
        ++count;
    }
    CHECK(without / count > 4);
    CHECK(with_map / count < 0.5);
    CHECK(worst < 1.5);
}

TEST_CASE("detail bake: slopes of the high mesh are the normals of the map, right and up") {
    const MeshData low = make_square(0);
    MeshData high = make_square(0);
    for (Vec3& p : high.positions) {  // rises by 0.1 to the right and falls by 0.05 upwards
        p.z = 0.1f * p.x - 0.05f * p.y;
    }
    generate_normals(high);
    const DetailBake baked = bake(low, high, kSmall);
    const Vec3 expected = glm::normalize(Vec3(-0.1f, 0.05f, 1));
    for (const Vec4& texel : baked.normal.texels) {
        CHECK(degrees_between(decode_normal(Vec3(texel)), expected) < 0.01f);
    }
    // The height is in fractions of the search distance, 0.1 of the diagonal.
    const float at_center = 0.1f * 0.5f - 0.05f * 0.5f;
    CHECK(
        std::abs(
            baked.height.texels[baked.height.at(32, 32)].x
            - (0.5f + 0.5f * at_center / (0.1f * std::sqrt(2.0f))))
        < 0.01f);
}

TEST_CASE("detail bake: mirrored texture coordinates give the same normals once shaded") {
    MeshData low = make_square(0);
    for (Vec2& uv : low.uvs) {
        uv.x = 1 - uv.x;
    }
    generate_tangents(low);
    CHECK(low.tangents[0].w == -1);
    MeshData high = make_square(0);
    for (Vec3& p : high.positions) {
        p.z = 0.1f * p.x - 0.05f * p.y;
    }
    generate_normals(high);
    const Vec3 expected = glm::normalize(Vec3(-0.1f, 0.05f, 1));
    for (const Vec4& texel : bake(low, high, kSmall).normal.texels) {
        const Vec3 ts = decode_normal(Vec3(texel));
        const Vec3 t(low.tangents[0]);
        const Vec3 n = {0, 0, 1};
        const Vec3 shaded = ts.x * t + ts.y * low.tangents[0].w * glm::cross(n, t) + ts.z * n;
        CHECK(degrees_between(shaded, expected) < 0.01f);
    }
}

TEST_CASE("detail bake: tangent frames invert what the renderer does") {
    const Vec3 normal = 0.9f * glm::normalize(Vec3(0.2f, 0.3f, 1));
    const Vec3 t = 0.95f * glm::normalize(Vec3(1, 0.1f, -0.2f));
    for (const float w : {1.0f, -1.0f}) {
        const Vec3 n = glm::normalize(Vec3(0.4f, -0.2f, 0.8f));
        const Vec3 ts = in_tangent_frame(n, normal, Vec4(t, w));
        CHECK(std::abs(glm::length(ts) - 1) < 1e-6f);
        const Vec3 back = ts.x * t + ts.y * w * glm::cross(normal, t) + ts.z * normal;
        CHECK(degrees_between(back, n) < 0.01f);
    }
    CHECK(in_tangent_frame({0, 0, 1}, {0, 0, 1}, {0, 0, 1, 1}) == Vec3(0, 0, 1));
    CHECK(in_tangent_frame({0, 0, 1}, Vec3(0), Vec4(0)) == Vec3(0, 0, 1));
}

TEST_CASE("detail bake: of several surfaces the nearest that faces the same way counts") {
    for (const float side : {1.0f, -1.0f}) {  // the one that faces it outside, then inside
        MeshData high = make_square(0.08f * side);
        high.positions[1].z += 0.02f;  // rises to the right
        high.positions[3].z += 0.02f;
        generate_normals(high);
        MeshData away = make_square(-0.02f * side);
        for (std::size_t i = 0; i + 3 <= away.indices.size(); i += 3) {
            std::swap(away.indices[i], away.indices[i + 1]);
        }
        const auto first = static_cast<std::uint32_t>(high.positions.size());
        high.positions.insert(high.positions.end(), away.positions.begin(), away.positions.end());
        high.normals.insert(high.normals.end(), 4, Vec3(0, 0, -1));
        for (const std::uint32_t i : away.indices) {
            high.indices.push_back(first + i);
        }
        const DetailBake baked = bake(make_square(0), high, kSmall);
        CHECK((baked.height.texels[0].x > 0.5f) == (side > 0));
        CHECK(decode_normal(Vec3(baked.normal.texels[0])).x < -0.01f);
    }
}

/// A cube of edge 1 around the origin with flat sides, each with a sixth of the image.
MeshData make_cube_with_charts() {
    MeshData cube;
    for (int side = 0; side < 6; ++side) {
        Vec3 n(0);
        n[side / 2] = side % 2 == 0 ? 1.0f : -1.0f;
        const Vec3 t = any_perpendicular(n);
        const Vec3 b = glm::cross(n, t);
        const auto first = static_cast<std::uint32_t>(cube.positions.size());
        for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
            cube.positions.push_back(0.5f * n + (uv.x - 0.5f) * t + (0.5f - uv.y) * b);
            cube.normals.push_back(n);
            cube.uvs.emplace_back((uv.x + static_cast<float>(side)) / 6, uv.y);
        }
        for (const std::uint32_t i : {0u, 2u, 1u, 1u, 2u, 3u}) {
            cube.indices.push_back(first + i);
        }
    }
    generate_tangents(cube);
    return cube;
}

TEST_CASE("detail bake: hard edges leave no gap between the lines of two faces") {
    // Along the normals of the sides, lines from near a corner would meet a ball around the cube at
    // (0.37, 0.5, 0.5) / 0.8; along averaged ones they meet its diagonal.
    const MeshData high = make_sphere({.radius = 0.8f, .segments = 200, .rings = 100});
    DetailSettings settings = kSmall;
    settings.width = 6 * 32;
    settings.height = 32;
    settings.distance = 0.5f;
    settings.object_space = true;
    const DetailBake baked = bake(make_cube_with_charts(), high, settings);
    CHECK(baked.report.missed == 0);
    CHECK(baked.report.from_point == 0);
    CHECK(baked.report.overlapping == 0);
    for (int k = 0; k < 24; ++k) {  // the corners of all sides
        const int x = 32 * (k / 4) + 31 * (k % 2);
        const int y = 31 * (k / 2 % 2);
        const Vec3 n = glm::abs(decode_normal(Vec3(baked.normal.texels[baked.normal.at(x, y)])));
        CHECK(std::min({n.x, n.y, n.z}) > 0.55f);
    }
}

TEST_CASE(
    "detail bake: triangles without area in texture space, overlaps and what is outside count") {
    MeshData low = make_square(0);
    const MeshData high = make_square(0);
    low.positions.insert(low.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    low.normals.insert(low.normals.end(), 3, Vec3(0, 0, 1));
    low.tangents.insert(low.tangents.end(), 3, Vec4(1, 0, 0, 1));
    low.uvs.insert(low.uvs.end(), 3, Vec2(0.5f));
    low.indices.insert(low.indices.end(), {4, 5, 6});
    CHECK(bake(low, high, kSmall).report.degenerate == 1);
    low.uvs[4] = {0, 0};
    low.uvs[5] = {0, 1};
    low.uvs[6] = {1, 0};
    const DetailReport overlap = bake(low, high, kSmall).report;
    CHECK(overlap.degenerate == 0);
    CHECK(overlap.overlapping > 1500);
    CHECK(overlap.overlapping < 2200);
    low.uvs[4] = {3, 0};
    low.uvs[5] = {3, 1};
    low.uvs[6] = {4, 0};
    const DetailReport outside = bake(low, high, kSmall).report;
    CHECK(outside.outside == 1);
    CHECK(outside.overlapping == 0);
    CHECK(outside.covered == 64 * 64);
}

TEST_CASE("detail bake: without charts there is an error, with NaN in them a chart less") {
    MeshData low = make_square(0);
    const MeshData high = make_square(0);
    for (Vec2& uv : low.uvs) {
        uv = {0.25f, 0.25f};
    }
    const auto none = bake_detail(low, high, kSmall);
    REQUIRE_FALSE(none.ok());
    CHECK(
        none.error().message.find("no triangle with an area in texture space")
        != std::string::npos);
    low = make_square(0);
    low.uvs[0].x = std::numeric_limits<float>::quiet_NaN();
    CHECK(bake(low, high, kSmall).report.covered < 64 * 64 * 3 / 4);
    low = make_square(0);
    low.uvs.clear();
    CHECK_FALSE(bake_detail(low, high, kSmall).ok());
    low = make_square(0);
    low.positions[0].z = std::numeric_limits<float>::quiet_NaN();
    for (const Vec4& texel : bake(low, high, kSmall).normal.texels) {
        CHECK(std::isfinite(texel.x + texel.y + texel.z));
    }
}

TEST_CASE("detail bake: a high mesh that is far away is missed, and the map stays flat") {
    const DetailBake baked = bake(make_square(0), make_square(5), kSmall);
    CHECK(baked.report.missed == baked.report.covered);
    for (const Vec4& texel : baked.normal.texels) {
        CHECK(texel == Vec4(0.5f, 0.5f, 1, 1));
    }
    const DetailBake empty = bake(make_square(0), MeshData(), kSmall);
    CHECK(empty.report.missed == empty.report.covered);
}

TEST_CASE("detail bake: where no line meets the high mesh its nearest point counts") {
    MeshData high = make_square(0.01f);
    for (Vec3& p : high.positions) {
        p.x = 0.1f + 0.8f * p.x;  // a margin that lines miss
    }
    const DetailBake baked = bake(make_square(0), high, kSmall);
    CHECK(baked.report.from_point > 0);
    CHECK(baked.report.missed == 0);
    for (const Vec4& texel : baked.normal.texels) {
        CHECK(degrees_between(decode_normal(Vec3(texel)), {0, 0, 1}) < 0.01f);
    }
}

TEST_CASE("detail bake: occlusion is 1 in the open and about 1/2 beside a high wall") {
    MeshData high = make_square(0);
    const auto first = static_cast<std::uint32_t>(high.positions.size());
    high.positions.insert(
        high.positions.end(), {{0.5f, -9, 0}, {0.5f, 9, 0}, {0.5f, -9, 9}, {0.5f, 9, 9}});
    high.normals.insert(high.normals.end(), 4, Vec3(-1, 0, 0));
    for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) {
        high.indices.push_back(first + i);
    }
    DetailSettings settings = kSmall;
    settings.width = settings.height = 32;
    settings.occlusion_rays = 256;
    settings.occlusion_reach = 100;
    const DetailBake baked = bake(make_square(0), high, settings);
    const float beside = baked.occlusion.texels[baked.occlusion.at(15, 16)].x;
    CHECK(std::abs(beside - 0.5f) < 0.05f);
    settings.occlusion_reach = 0.1f;
    const DetailBake near = bake(make_square(0), high, settings);
    CHECK(near.occlusion.texels[near.occlusion.at(2, 16)].x == 1);
}

TEST_CASE(
    "detail bake: the mesh of a relief is moved out until the high mesh is below it, depth by depth"
    * technique("bump.nm-detail-recovery")) {
    const MeshData low = make_square(0);
    MeshData high = make_square(0);
    high.positions[1].z = 0.08f;  // the right edge is high, the left one is low
    high.positions[3].z = 0.08f;
    high.positions[0].z = -0.02f;
    high.positions[2].z = -0.02f;
    const DetailBake baked = bake(low, high, kSmall);
    const DetailRelief relief = make_relief(baked);
    CHECK(relief.raised == test::near(0.08).epsilon(0.02));
    CHECK(relief.depth == test::near(0.1).epsilon(0.02));
    for (int x = 0; x < kSmall.width; ++x) {
        const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(kSmall.width);
        const float height = -0.02f + 0.1f * u;
        const Vec4& texel = relief.map.texels[relief.map.at(x, kSmall.height / 2)];
        CAPTURE(u);
        CHECK(std::abs(relief.raised - texel.w * relief.depth - height) < 1e-4f);
        CHECK(Vec3(texel) == Vec3(baked.normal.texels[baked.normal.at(x, kSmall.height / 2)]));
    }
    MeshData moved = low;
    move_out(moved, relief.raised);
    for (std::size_t v = 0; v < moved.positions.size(); ++v) {
        CHECK(moved.positions[v] == low.positions[v] + Vec3(0, 0, relief.raised));
    }
    CHECK(moved.bounds.max.z == relief.raised);
    // Both the same: a relief of hardly any depth, not 0 / 0.
    const DetailRelief none = make_relief(bake(low, low, kSmall));
    CHECK(none.depth > 0);
    CHECK(none.raised == 0.0f);
    CHECK(std::isfinite(none.map.texels[0].w));
}

TEST_CASE("detail bake: charts are dilated by the padding and no further") {
    MeshData low = make_square(0);
    for (Vec2& uv : low.uvs) {
        uv = 0.25f + 0.5f * uv;
    }
    MeshData high = make_square(0);
    for (Vec3& p : high.positions) {
        p.z = 0.1f * p.x;
    }
    generate_normals(high);
    const DetailBake baked = bake(low, high, kSmall);
    const auto tilted = [&](int x, int y) {
        return decode_normal(Vec3(baked.normal.texels[baked.normal.at(x, y)])).x < -0.05f;
    };
    CHECK(tilted(16, 32));
    CHECK(tilted(14, 32));
    CHECK_FALSE(tilted(13, 32));
    CHECK(tilted(49, 49));
    CHECK_FALSE(tilted(50, 32));
}

TEST_CASE("detail bake: threads change nothing, and samples smooth edges of the high mesh") {
    const MeshData low = make_low_sphere();
    const MeshData high = make_torus({.radius = 0.8f, .tube = 0.25f});
    DetailSettings settings = kSmall;
    settings.distance = 0.3f;
    settings.samples = 2;
    settings.occlusion_rays = 4;
    const int before = thread_count();
    set_thread_count(1);
    const DetailBake one = bake(low, high, settings);
    set_thread_count(4);
    const DetailBake four = bake(low, high, settings);
    set_thread_count(before);
    CHECK(one.normal.texels == four.normal.texels);
    CHECK(one.occlusion.texels == four.occlusion.texels);
    CHECK(one.report.covered > 4 * 3000);
}

TEST_CASE("chart samples: each sample of a plane of triangles is in one, with its coordinates") {
    MeshData mesh = make_plane({.size = {1, 1}, .divisions = 7});
    const Charts charts(mesh.uvs, mesh.indices, 90, 70);
    std::vector<ChartSample> samples;
    for (int first = 0; first < 70; first += 35) {
        CHECK(charts.sample(first, 35, samples) == 0);
        for (int i = 0; i < 90 * 35; ++i) {
            const ChartSample& sample = samples[static_cast<std::size_t>(i)];
            REQUIRE(sample.triangle >= 0);
            const Vec2 uv = interpolate(mesh, sample, mesh.uvs);
            CHECK(std::abs(uv.x * 90 - static_cast<float>(i % 90) - 0.5f) < 1e-3f);
            CHECK(std::abs(uv.y * 70 - static_cast<float>(first + i / 90) - 0.5f) < 1e-3f);
        }
    }
}

}  // namespace limn::detail_bake_test

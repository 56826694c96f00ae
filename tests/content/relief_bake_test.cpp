#include "content/bake/relief_bake.h"
#include "content/bake/relief_map.h"
#include "content/bake/tile_surface.h"
#include "content/make/models/shapes.h"
#include "ecs/base/jobs.h"
#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::relief_bake_test {
namespace {

/// A unit square at z = 0 with corners at +-1/2, and the sphere of radius 1/2 around its center:
/// the box is the unit cube.
MeshData make_ball() {
    return make_sphere({.radius = 0.5f, .segments = 400, .rings = 200});
}

struct Baked {
    TileSurface tile;
    ReliefBake bake;
};

Baked bake_face(
    const MeshData& mesh, BoxFace face, float depth, ReliefLayout layout, int width,
    int samples = 1) {
    Baked baked;
    baked.tile = tile_of(mesh, face, depth, false);
    baked.bake = bake_relief(baked.tile, TileCaster(baked.tile), layout, width, samples);
    return baked;
}

std::vector<std::uint8_t> bytes_at(const BakedMap& map, int x, int y) {
    const std::vector<std::uint8_t> bytes = map_bytes(map, 4);
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(4 * map.at(x, y));
    return {first, first + 4};
}

/// Each byte is within 1.
void check_bytes(const std::vector<std::uint8_t>& found, const std::vector<int>& expected) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(found[i] - expected[i]) <= 1);
    }
}

/// A square of the plane z = `z`, in a box from 0 to 1 that two tiny triangles span.
MeshData make_plane_in_box(float z) {
    MeshData mesh;
    mesh.positions = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {0, 0, 1}});
    mesh.indices = {0, 1, 2, 0, 2, 3, 4, 5, 5};
    return mesh;
}

}  // namespace

TEST_CASE(
    "relief bake: a hemisphere has the depth and normal of its formula"
    * technique("relief.map-bake, bump.nm-from-basrelief")) {
    // Fixture F-cap: 0.3 from the center the depth is 0.2 of the box, 0.5 deep.
    const Baked baked = bake_face(make_ball(), BoxFace::Front, 0.5f, ReliefLayout::Single, 101);
    const BakedMap& map = baked.bake.map;
    REQUIRE(map.height == 101);
    CHECK(baked.tile.depth == 0.5f);
    // Texel 50 is the center, of 101.
    const int offset = 30;  // texels: 0.297
    const float x = static_cast<float>(offset) / 101;
    const float z = std::sqrt(0.25f - x * x);
    check_bytes(
        bytes_at(map, 50 + offset, 50), {static_cast<int>(std::lround(127.5f * (1 + 2 * x))), 128,
                                         static_cast<int>(std::lround(127.5f * (1 + 2 * z))),
                                         static_cast<int>(std::lround(255 * (0.5f - z) / 0.5f))});
    check_bytes(bytes_at(map, 50, 50), {128, 128, 255, 0});
    check_bytes(bytes_at(map, 1, 1), {128, 128, 255, 255});  // beside the ball
    const Baked five = bake_face(make_ball(), BoxFace::Front, 0.5f, ReliefLayout::Single, 5);
    // The fourth of 5 texels is centered at 0.2 from the middle: depth (0.5 - sqrt(0.21)) / 0.5.
    check_bytes(bytes_at(five.bake.map, 3, 2), {179, 128, 244, 21});
}

TEST_CASE(
    "relief bake: 0.6 of the radius from the center the normal is (0.6, 0, 0.8)"
    * technique("bump.nm-from-basrelief, relief.map-bake")) {
    // Of 5 texels over a diameter of 2 the outer ones are centered 0.8 from the middle: a box that
    // is wider puts them at 0.6.
    MeshData mesh = make_sphere({.radius = 1, .segments = 400, .rings = 200});
    mesh.positions.insert(mesh.positions.end(), {{-1.5f, -1.5f, 0}, {1.5f, 1.5f, 0}});
    mesh.normals.insert(mesh.normals.end(), 2, Vec3(0, 0, 1));
    const Baked baked = bake_face(mesh, BoxFace::Front, 1, ReliefLayout::Single, 5);
    check_bytes(bytes_at(baked.bake.map, 3, 2), {204, 128, 230, 51});
    check_bytes(bytes_at(baked.bake.map, 2, 1), {128, 204, 230, 51});  // above: green
    check_bytes(bytes_at(baked.bake.map, 0, 0), {128, 128, 255, 255});
    CHECK(baked.bake.empty == 25 - 9);
}

TEST_CASE(
    "relief bake: a sphere in a deep box has its front and its back"
    * technique("relief.map-bake, relief.map-format")) {
    MeshData mesh = make_ball();
    const Baked baked = bake_face(mesh, BoxFace::Front, 1, ReliefLayout::Double, 100);
    const BakedMap& map = baked.bake.map;
    // 0.3 from the center: between texels 79 and 80.
    const Vec4 a = map.texels[map.at(79, 49)];
    const Vec4 b = map.texels[map.at(80, 49)];
    CHECK(std::abs(0.5f * (a.w + b.w) - 0.1f) < 1e-3f);
    CHECK(std::abs(0.5f * (a.z + b.z) - 0.9f) < 1e-3f);
    std::size_t holes = 0;
    for (const Vec4& texel : map.texels) {
        CHECK(texel.w <= texel.z);
        holes += texel.w == 1 && texel.z == 1 ? 1 : 0;
    }
    CHECK(holes == baked.bake.empty);
    CHECK(baked.bake.open == 0);
    CHECK(std::abs(static_cast<double>(holes) / 1e4 - (1 - 0.785398)) < 0.01);
}

TEST_CASE("relief bake: a plane at depth d is the constant map d" * technique("relief.map-bake")) {
    for (const float d : {0.0f, 0.25f, 0.9f, 1.0f}) {
        const Baked baked =
            bake_face(make_plane_in_box(1 - d), BoxFace::Front, 0, ReliefLayout::Single, 8);
        for (const Vec4& texel : baked.bake.map.texels) {
            CHECK(std::abs(texel.w - d) < 1e-6f);
            CHECK(Vec3(texel) == Vec3(0.5f, 0.5f, 1));
        }
        CHECK(baked.bake.empty == 0);
    }
}

TEST_CASE(
    "relief bake: it is what an orthographic rasterizer draws"
    * technique("relief.map-bake, bump.nm-from-basrelief")) {
    const MeshData mesh = make_torus({.segments = 32, .sides = 16});
    const Baked baked = bake_face(mesh, BoxFace::Top, 0, ReliefLayout::Single, 32);
    const TileSurface& tile = baked.tile;
    const BakedMap& map = baked.bake.map;
    // The nearest triangle at each texel center, by edge functions and a depth buffer.
    std::vector<double> nearest(map.texels.size(), 1);
    std::vector<bool> covered(map.texels.size(), false);
    for (std::size_t i = 0; i + 3 <= tile.indices.size(); i += 3) {
        const Vec3* p[3];
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = &tile.positions[tile.indices[i + k]];
        }
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                const double px = (x + 0.5) / map.width * tile.size.x;
                const double py = (1 - (y + 0.5) / map.height) * tile.size.y;
                const auto edge = [&](const Vec3& a, const Vec3& b) {
                    return (static_cast<double>(b.x) - a.x) * (py - a.y)
                           - (static_cast<double>(b.y) - a.y) * (px - a.x);
                };
                const double w[3] = {edge(*p[1], *p[2]), edge(*p[2], *p[0]), edge(*p[0], *p[1])};
                const double sum = w[0] + w[1] + w[2];
                if (sum == 0 || w[0] / sum < 0 || w[1] / sum < 0 || w[2] / sum < 0) {
                    continue;
                }
                const double z = (w[0] * p[0]->z + w[1] * p[1]->z + w[2] * p[2]->z) / sum;
                double& depth = nearest[map.at(x, y)];
                depth = std::min(depth, -z / tile.depth);
                covered[map.at(x, y)] = true;
            }
        }
    }
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        CHECK(std::abs(nearest[i] - map.texels[i].w) < 1e-5);
        drawn += covered[i] ? 1 : 0;
    }
    CHECK(drawn == map.texels.size() - baked.bake.empty);
    CHECK(drawn > 300);
}

TEST_CASE("relief bake: baked normals of a ball are within half a degree of the exact ones") {
    const Baked baked = bake_face(make_ball(), BoxFace::Front, 0.5f, ReliefLayout::Single, 128, 2);
    const BakedMap& map = baked.bake.map;
    const std::vector<std::uint8_t> bytes = map_bytes(map, 4);
    double worst = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const Vec2 at = (Vec2(x, y) + 0.5f) / 128.0f - 0.5f;
            const float r2 = glm::dot(at, at);
            if (r2 > 0.23f) {
                continue;  // near the outline, where a texel spans several degrees
            }
            const Vec3 expected = Vec3(at.x, -at.y, std::sqrt(0.25f - r2)) / 0.5f;
            const std::uint8_t* texel = &bytes[4 * map.at(x, y)];
            const Vec3 found = decode_normal(Vec3(texel[0], texel[1], texel[2]) / 255.0f);
            worst = std::max(
                worst, static_cast<double>(std::asin(glm::length(glm::cross(found, expected)))));
        }
    }
    CHECK(worst < 0.5 * 3.14159265 / 180);
}

TEST_CASE("relief bake: each side of a box shows what a viewer in front of it sees") {
    // A box with a tetrahedron that points at each viewer off center: up and to the right.
    struct Side {
        BoxFace face;
        Vec3 right;
        Vec3 up;
        Vec3 toward;
    };
    const Side sides[] = {
        {BoxFace::Front, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {BoxFace::Back, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
        {BoxFace::Right, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
        {BoxFace::Left, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
        {BoxFace::Top, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
        {BoxFace::Bottom, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    };
    for (const Side& side : sides) {
        MeshData mesh = make_box({.size = {1, 1, 1}});
        const Vec3 center = 0.3f * side.right + 0.2f * side.up + 0.5f * side.toward;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(
            mesh.positions.end(), {center + 0.1f * side.right, center + 0.1f * side.up,
                                   center - 0.1f * side.right, center + 0.25f * side.toward});
        mesh.indices.insert(
            mesh.indices.end(), {first, first + 1, first + 3, first + 1, first + 2, first + 3});
        mesh.normals.clear();
        const Baked baked = bake_face(mesh, side.face, 0, ReliefLayout::Single, 40);
        const BakedMap& map = baked.bake.map;
        std::size_t highest = 0;
        for (std::size_t i = 0; i < map.texels.size(); ++i) {
            highest = map.texels[i].w < map.texels[highest].w ? i : highest;
        }
        const int x = static_cast<int>(highest) % map.width;
        const int y = static_cast<int>(highest) / map.width;
        CHECK(x > 27);
        CHECK(y < 17);
    }
}

TEST_CASE("relief bake: an open mesh has a back at depth 1, and counts") {
    MeshData mesh = make_plane_in_box(0.7f);
    const Baked baked = bake_face(mesh, BoxFace::Front, 0, ReliefLayout::Double, 4);
    CHECK(baked.bake.open == 16);
    for (const Vec4& texel : baked.bake.map.texels) {
        CHECK(texel.z == 1);
        CHECK(std::abs(texel.w - 0.3f) < 1e-6f);
    }
}

TEST_CASE("relief bake: meshes inside out and that intersect themselves give unit normals") {
    MeshData mesh = make_ball();
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        std::swap(mesh.indices[i], mesh.indices[i + 1]);
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t count = mesh.indices.size();
    for (std::uint32_t v = 0; v < first; ++v) {
        mesh.positions.push_back(mesh.positions[v] + Vec3(0.1f, 0, 0));
        mesh.normals.push_back(mesh.normals[v]);
    }
    for (std::size_t i = 0; i < count; ++i) {
        mesh.indices.push_back(first + mesh.indices[i]);
    }
    const Baked baked = bake_face(mesh, BoxFace::Front, 0, ReliefLayout::Double, 32);
    for (const Vec4& texel : baked.bake.map.texels) {
        const ReliefTexel decoded = decode_relief(texel, ReliefLayout::Double);
        CHECK(std::abs(glm::length(decoded.normal) - 1) < 1e-4f);
        CHECK(decoded.normal.z >= 0);
        CHECK((texel.w >= 0 && texel.w <= texel.z && texel.z <= 1));
    }
}

TEST_CASE("relief bake: normals face the viewer, of a sheet from behind and of a ball inside out") {
    MeshData sheet = make_plane_in_box(0.5f);
    sheet.positions[1].z = sheet.positions[2].z = 0.6f;  // rises to the right
    for (std::size_t i = 0; i < 6; i += 3) {
        std::swap(sheet.indices[i], sheet.indices[i + 1]);
    }
    const Baked behind = bake_face(sheet, BoxFace::Front, 0, ReliefLayout::Single, 4);
    const Vec3 expected = glm::normalize(Vec3(-0.1f, 0, 1));
    for (const Vec4& texel : behind.bake.map.texels) {
        CHECK(glm::length(decode_normal(Vec3(texel)) - expected) < 1e-4f);
    }
    MeshData ball = make_ball();
    for (std::size_t i = 0; i + 3 <= ball.indices.size(); i += 3) {
        std::swap(ball.indices[i], ball.indices[i + 1]);
    }
    const Baked turned = bake_face(ball, BoxFace::Front, 0.5f, ReliefLayout::Single, 5);
    check_bytes(bytes_at(turned.bake.map, 3, 2), {179, 128, 244, 21});
}

TEST_CASE("relief bake: samples and threads") {
    const MeshData mesh = make_ball();
    const TileSurface tile = tile_of(mesh, BoxFace::Front, 0, false);
    const TileCaster caster(tile);
    const int before = thread_count();
    set_thread_count(1);
    const ReliefBake one = bake_relief(tile, caster, ReliefLayout::Single, 48, 3);
    set_thread_count(4);
    const ReliefBake four = bake_relief(tile, caster, ReliefLayout::Single, 48, 3);
    set_thread_count(before);
    CHECK(one.map.texels == four.map.texels);
    // At the outline, several samples see part of the ball.
    bool between = false;
    for (const Vec4& texel : one.map.texels) {
        between = between || (texel.w > 0.75f && texel.w < 0.95f);
    }
    CHECK(between);
}

TEST_CASE("relief bake: heights as triangles have the depths of the map they came from") {
    for (const bool repeats : {true, false}) {
        HeightMap map = {.width = 16, .height = 8, .repeats = repeats};
        for (int i = 0; i < 128; ++i) {
            map.heights.push_back(0.5f + 0.4f * std::sin(static_cast<float>(i) * 0.7f));
        }
        const TileSurface tile = tile_of(map, 0.2f);
        const TileCaster caster(tile);
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 16; ++x) {
                const Vec2 at = tile_point(
                    tile, 16, 8, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const auto hit = caster.nearest({.origin = Vec3(at, 0.5f)});
                REQUIRE(hit.has_value());
                CHECK(std::abs(hit->t - 0.5f - 0.2f * (1 - map.at(x, y))) < 1e-5f);
            }
        }
        // Slanted rays leave a tile that repeats only through its floor.
        const auto far = caster.nearest(
            {.origin = {0.5f, 0.25f, 0.01f}, .direction = {1, 0.3f, -0.01f}, .max_t = 100});
        CHECK(far.has_value() == repeats);
    }
}

}  // namespace limn::relief_bake_test

#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_strokes.h"
#include "ecs/base/math.h"
#include "tests/content/gltf_samples.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace limn::gltf_strokes_test {
namespace {

const std::vector<Vec3> kPositions = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {3, 4, 0}};

Vec3 place(const Strokes& strokes, std::uint32_t vertex) {
    return kPositions[strokes.sources[vertex]] + strokes.offsets[vertex];
}

}  // namespace

TEST_CASE("strokes: triangles of points and lines face outward, with unit normals") {
    for (const std::int32_t mode : {kGltfPoints, kGltfLines, kGltfLineLoop, kGltfLineStrip}) {
        CAPTURE(mode);
        const std::vector<std::uint32_t> list = {0, 1, 1, 2};
        const Strokes strokes = make_strokes(kPositions, list, mode);
        REQUIRE_FALSE(strokes.indices.empty());
        for (std::size_t i = 0; i < strokes.indices.size(); i += 3) {
            const std::uint32_t a = strokes.indices[i];
            const std::uint32_t b = strokes.indices[i + 1];
            const std::uint32_t c = strokes.indices[i + 2];
            const Vec3 facing = glm::cross(
                place(strokes, b) - place(strokes, a), place(strokes, c) - place(strokes, a));
            const Vec3 outward = strokes.normals[a] + strokes.normals[b] + strokes.normals[c];
            CHECK(glm::dot(facing, outward) > 0);
        }
        for (const Vec3& normal : strokes.normals) {
            CHECK(glm::length(normal) == test::near(1));
        }
    }
}

TEST_CASE("strokes: a line stays within its radius of the segment and reaches both ends") {
    const std::vector<std::uint32_t> list = {0, 1};
    const Strokes strokes = make_strokes(kPositions, list, kGltfLines);
    REQUIRE(strokes.sources.size() == 6);
    for (const Vec3& offset : strokes.offsets) {
        CHECK(offset.x == test::near(0).scale(1));  // across the line
        CHECK(glm::length(offset) == test::near(0.003 * 1.5));
    }
    CHECK(std::accumulate(strokes.sources.begin(), strokes.sources.end(), 0u) == 3);
}

TEST_CASE("strokes: lines without length and lists too short make nothing") {
    const std::vector<std::uint32_t> same = {2, 3};
    CHECK(make_strokes(kPositions, same, kGltfLines).indices.empty());
    const std::vector<std::uint32_t> one = {2};
    for (const std::int32_t mode : {kGltfLines, kGltfLineLoop, kGltfLineStrip}) {
        CHECK(make_strokes(kPositions, one, mode).found == 0);
    }
    CHECK(make_strokes(kPositions, {}, kGltfPoints).indices.empty());
}

TEST_CASE("strokes: more points than are drawn are thinned out over all of them") {
    const std::size_t count = 3 * kMaxStrokes + 1;
    std::vector<Vec3> positions(count);
    std::vector<std::uint32_t> list(count);
    for (std::size_t i = 0; i < count; ++i) {
        positions[i] = {static_cast<float>(i), 0, 0};
        list[i] = static_cast<std::uint32_t>(i);
    }
    const Strokes strokes = make_strokes(positions, list, kGltfPoints);
    CHECK(strokes.found == count);
    REQUIRE(strokes.sources.size() == 6 * kMaxStrokes);
    CHECK(strokes.sources.front() == 0);
    CHECK(strokes.sources.back() > count - 5);
    for (std::size_t i = 6; i < strokes.sources.size(); i += 6) {
        REQUIRE(strokes.sources[i] > strokes.sources[i - 6]);
        REQUIRE(strokes.sources[i] <= strokes.sources[i - 6] + 4);
    }
}

TEST_CASE("gltf: points and lines have the tangents that their triangles would get") {
    for (const int mode : {0, 1}) {
        const std::string json = test::replace_once(
            test::kSquareJson, R"("indices": 1)", fmt::format(R"("mode": {})", mode));
        const Result<GltfScene> scene =
            parse_gltf(test::make_glb(json, test::square_binary()), "square.glb", "");
        REQUIRE(scene.ok());
        MeshData mesh = scene->meshes.at(0);
        const std::vector<Vec4> tangents = mesh.tangents;
        const std::size_t vertices = mesh.positions.size();
        generate_tangents(mesh);
        CHECK(mesh.positions.size() == vertices);
        CHECK(mesh.tangents == tangents);
    }
}

}  // namespace limn::gltf_strokes_test

#include "content/bake/even_chart.h"
#include "content/make/head/head.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::even_chart_test {
namespace {

/// A third of a cylinder of radius 1 and height 1 whose texture coordinates crowd to one side.
MeshData make_trough() {
    constexpr std::uint32_t kColumns = 24;
    constexpr std::uint32_t kRows = 8;
    MeshData mesh;
    for (std::uint32_t j = 0; j <= kRows; ++j) {
        for (std::uint32_t i = 0; i <= kColumns; ++i) {
            const Vec2 uv = Vec2(i, j) / Vec2(kColumns, kRows);
            const float angle = 2 * kPi / 3 * uv.x;
            mesh.positions.emplace_back(std::sin(angle), 1 - uv.y, std::cos(angle));
            mesh.uvs.push_back({square(uv.x), 0.3f * uv.y});
        }
    }
    for (std::uint32_t j = 0; j < kRows; ++j) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const std::uint32_t a = j * (kColumns + 1) + i;
            const std::uint32_t b = a + kColumns + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    return mesh;
}

/// Ratio of the axes of the ellipse to which the chart maps a circle on triangle `t`.
float stretch_of(const MeshData& mesh, const std::vector<Vec2>& chart, std::size_t t) {
    const std::uint32_t* const v = &mesh.indices[3 * t];
    const Vec3 ab = mesh.positions[v[1]] - mesh.positions[v[0]];
    const Vec3 ac = mesh.positions[v[2]] - mesh.positions[v[0]];
    const Vec2 b = chart[v[1]] - chart[v[0]];
    const Vec2 c = chart[v[2]] - chart[v[0]];
    const float area = b.x * c.y - b.y * c.x;
    const Vec3 along_u = (ab * c.y - ac * b.y) / area;
    const Vec3 along_v = (ac * b.x - ab * c.x) / area;
    const float mean = 0.5f * (glm::dot(along_u, along_u) + glm::dot(along_v, along_v));
    const float half = 0.5f * (glm::dot(along_u, along_u) - glm::dot(along_v, along_v));
    const float radius = std::hypot(half, glm::dot(along_u, along_v));
    return std::sqrt((mean + radius) / std::max(mean - radius, 1e-12f));
}

/// The median stretch of the triangles of a head whose |x|, y and z are within a box [cm].
float stretch_within(
    const MeshData& head, const std::vector<Vec2>& chart, const Vec3& low, const Vec3& high) {
    std::vector<float> found;
    for (std::size_t t = 0; 3 * t < head.indices.size(); ++t) {
        const std::uint32_t* const v = &head.indices[3 * t];
        Vec3 center =
            100.0f / 3 * (head.positions[v[0]] + head.positions[v[1]] + head.positions[v[2]]);
        center.x = std::abs(center.x);
        if (glm::min(center, low) == low && glm::max(center, high) == high) {
            found.push_back(stretch_of(head, chart, t));
        }
    }
    REQUIRE(found.size() > 20);
    std::ranges::sort(found);
    return found[found.size() / 2];
}

}  // namespace

TEST_CASE("even chart: part of a cylinder unrolls to its size and keeps its axes") {
    const MeshData mesh = make_trough();
    const std::vector<float> importance(mesh.positions.size(), 1.0f);
    const std::vector<Vec2> chart = make_even_chart(mesh, 0.5f, importance);
    float worst = 0;
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.indices[i + k];
            const std::uint32_t b = mesh.indices[i + (k + 1) % 3];
            const float length = glm::distance(mesh.positions[a], mesh.positions[b]) / 0.5f;
            worst = std::max(worst, std::abs(glm::distance(chart[a], chart[b]) / length - 1));
        }
    }
    CHECK(worst < 0.02f);
    const Vec2 across = chart[24] - chart[0];  // of the first row
    CHECK(across.x > 3.9f);
    CHECK(std::abs(across.y) < 0.2f);
}

TEST_CASE("even chart: a triangle without area has no effect") {
    MeshData mesh = make_trough();
    const std::vector<float> importance(mesh.positions.size(), 1.0f);
    const std::vector<Vec2> without = make_even_chart(mesh, 0.5f, importance);
    mesh.indices.insert(mesh.indices.end(), {3, 3, 4});
    CHECK(make_even_chart(mesh, 0.5f, importance) == without);
}

TEST_CASE("even chart: joined sides of a seam stay a step apart, and triangles in between deform") {
    const MeshData mesh = make_trough();
    const std::vector<float> importance(mesh.positions.size(), 1.0f);
    std::vector<ChartJoin> joins;
    for (std::uint32_t row = 0; row <= 8; ++row) {
        joins.push_back({.from = row * 25, .to = row * 25 + 24, .step = {4, 0}});
    }
    const std::vector<Vec2> chart = make_even_chart(mesh, 0.5f, importance, joins);
    for (const ChartJoin& join : joins) {
        CHECK(glm::distance(chart[join.to], chart[join.from] + Vec2(4, 0)) < 1e-5f);
    }
    for (std::uint32_t i = 0; i < 24; ++i) {  // 4.19 long without joins
        CHECK(std::abs(glm::distance(chart[100 + i], chart[101 + i]) - 4.0f / 24) < 0.01f);
    }
}

TEST_CASE("head: behind the neck pores continue across the texture seam, hardly stretched") {
    HeadShape shape;
    shape.shoulders = true;
    const MeshData bust = make_head(shape);
    int joined = 0;
    for (std::uint32_t a = 0; a < bust.positions.size(); ++a) {
        const Vec3 p = 100.0f * bust.positions[a];
        if (p.z > 0 || std::abs(p.x) > 0.1f || p.y > -4 || p.y < -13 || bust.uvs[a].x > 0.5f) {
            continue;
        }
        for (std::uint32_t b = 0; b < bust.positions.size(); ++b) {
            if (bust.positions[b] == bust.positions[a] && bust.uvs[b].x > 0.5f) {
                ++joined;
                CHECK(glm::distance(bust.uvs1[b], bust.uvs1[a] + Vec2(7.0f / 5, 0)) < 1e-5f);
            }
        }
    }
    CHECK(joined > 8);
    CHECK(stretch_within(bust, bust.uvs1, {0, -13, -12}, {4, -4, -4}) < 1.35f);
    CHECK(stretch_within(bust, bust.uvs1, {0, 6.5f, 7}, {4, 10, 20}) < 1.2f);
}

TEST_CASE(
    "head: pores are nearly round all over the face, including beside the nose"
    * technique("skin.detail")) {
    const MeshData head = make_head({});
    REQUIRE(head.uvs1.size() == head.positions.size());
    CHECK(stretch_within(head, head.uvs1, {0, 6.5f, 7}, {4, 10, 20}) < 1.2f);     // forehead
    CHECK(stretch_within(head, head.uvs1, {2.5f, -2, 7}, {5, 1.5f, 20}) < 1.3f);  // cheek
    CHECK(stretch_within(head, head.uvs1, {0.8f, 0.5f, 9.5f}, {1.8f, 2.6f, 20}) < 1.6f);  // nose
    CHECK(stretch_within(head, head.uvs1, {1, -1.2f, 9.5f}, {2.2f, 0.5f, 20}) < 1.6f);    // wings
    CHECK(stretch_within(head, head.uvs1, {0, -2.4f, 10}, {2, -1.2f, 20}) < 1.5f);        // lip
}

}  // namespace limn::even_chart_test

#include "content/bake/tangents.h"
#include "content/make/models/refine_mesh.h"
#include "content/make/models/shapes.h"
#include "ecs/components/weld.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace limn::refine_mesh_test {

using test::near;

namespace {

/// A ball whose upper half folds across y, with a morph target and two joints.
MeshData make_ball() {
    MeshData mesh = make_sphere({.radius = 0.1f, .segments = 24, .rings = 12});
    VertexRegion& upper = mesh.regions.emplace_back();
    upper.name = "upper";
    MorphTarget& flat = mesh.morphs.emplace_back();
    flat.name = "flat";
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        upper.weights.push_back(p.y > 0.02f ? 1.0f : 0.0f);
        upper.across.emplace_back(0, 1, 0);
        if (p.y > 0) {
            flat.vertices.push_back(v);
            flat.positions.emplace_back(0, -0.5f * p.y, 0);
        }
        mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
        const float weight = std::clamp(0.5f + 5 * p.y, 0.0f, 1.0f);
        for (const auto& [joint, share] : {std::pair(0, 1 - weight), std::pair(1, weight)}) {
            if (share > 0) {
                mesh.skin.joints.push_back(static_cast<std::uint16_t>(joint));
                mesh.skin.weights.push_back(share);
            }
        }
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    return mesh;
}

/// How many triangles' edges join each pair of positions, one way less the other: 0 in a surface
/// without holes.
int open_edges(const MeshData& mesh) {
    const std::vector<std::uint32_t> welded = weld_positions(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = welded[mesh.indices[i]];
        const std::uint32_t b = welded[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]];
        if (a != b) {
            sides[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    return static_cast<int>(
        std::ranges::count_if(sides, [](const auto& side) { return side.second != 0; }));
}

float longest_edge(const MeshData& mesh, float min_weight) {
    float longest = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
        if (std::max(mesh.regions[0].weights[a], mesh.regions[0].weights[b]) > min_weight) {
            longest = std::max(longest, glm::distance(mesh.positions[a], mesh.positions[b]));
        }
    }
    return longest;
}

MeshData refined(const MeshData& mesh, float edge, int times) {
    MeshData fine = mesh;
    refine_mesh(fine, edge, times);
    return fine;
}

}  // namespace

TEST_CASE(
    "refined: edges of regions that fold are short, the rest is unchanged, and no gap opens"
    * technique("wrinkle.displacement")) {
    const MeshData ball = make_ball();
    REQUIRE(open_edges(ball) == 0);
    const MeshData fine = refined(ball, 0.008f, 5);
    CHECK(longest_edge(ball, 0) > 0.02f);
    CHECK(longest_edge(fine, 0) <= 0.008f);
    CHECK(open_edges(fine) == 0);
    CHECK(fine.positions.size() > 3 * ball.positions.size());
    CHECK(std::equal(ball.positions.begin(), ball.positions.end(), fine.positions.begin()));
    const auto below = [](const MeshData& mesh) {
        return std::ranges::count_if(mesh.positions, [](const Vec3& p) { return p.y < -0.03f; });
    };
    CHECK(below(fine) == below(ball));
    CHECK(refined(ball, 0.008f, 0).positions.size() == ball.positions.size());
    CHECK(refined(ball, 1, 5).positions.size() == ball.positions.size());
}

TEST_CASE("refined: a sphere becomes rounder, a plane stays flat") {
    const auto flattest = [](const MeshData& mesh) {
        float least = 1;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec3 middle =
                (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[i + 1]]
                 + mesh.positions[mesh.indices[i + 2]])
                / 3.0f;
            least = std::min(least, middle.y > 0.04f ? glm::length(middle) / 0.1f : 1.0f);
        }
        return 1 - least;
    };
    const MeshData ball = make_ball();
    const MeshData fine = refined(ball, 0.008f, 5);
    CHECK(flattest(fine) < 0.15f * flattest(ball));
    for (std::size_t v = 0; v < fine.positions.size(); ++v) {
        CHECK(glm::length(fine.positions[v]) == near(0.1).epsilon(2e-3));
        CHECK(glm::length(fine.normals[v]) == near(1).epsilon(1e-4));
        CHECK(glm::dot(fine.normals[v], fine.positions[v]) > 0.0999f * 0.999f);
    }
    const MeshData plane = refined(make_plane({.size = {1, 1}}), 0.1f, 5);
    CHECK(plane.positions.size() > 100);
    for (const Vec3& p : plane.positions) {
        CHECK(p.y == 0);
    }
}

TEST_CASE("refined: weights sum to 1, and morph targets move midpoints by the mean of both ends") {
    const MeshData ball = make_ball();
    const MeshData fine = refined(ball, 0.008f, 5);
    REQUIRE(fine.skin.first.size() == fine.positions.size() + 1);
    for (std::size_t v = 0; v < fine.positions.size(); ++v) {
        const auto begin = fine.skin.weights.begin() + fine.skin.first[v];
        const auto end = fine.skin.weights.begin() + fine.skin.first[v + 1];
        CHECK(std::accumulate(begin, end, 0.0f) == near(1));
        CHECK(end - begin <= 2);
        CHECK(fine.regions[0].weights[v] >= 0);
        CHECK(fine.regions[0].weights[v] <= 1);
        CHECK(glm::length(fine.regions[0].across[v]) == near(1));
    }
    // Half of y, from the equator up, on both sides of the middles' bulge.
    const MorphTarget& flat = fine.morphs[0];
    CHECK(std::ranges::is_sorted(flat.vertices));
    CHECK(flat.vertices.size() > 2 * ball.morphs[0].vertices.size());
    for (std::size_t i = 0; i < flat.vertices.size(); ++i) {
        const float y = fine.positions[flat.vertices[i]].y;
        CHECK(std::abs(flat.positions[i].y + 0.5f * std::max(y, 0.0f)) <= 0.0015f);
    }
}

TEST_CASE("refined: a missing mesh, no regions, a NaN, and edges too short to reach") {
    CHECK(make_refined({.mesh = {3}}, Assets{}).positions.empty());
    MeshData ball = make_ball();
    ball.positions[5].x = std::numeric_limits<float>::quiet_NaN();
    CHECK(refined(ball, 0.001f, 5).positions.size() == ball.positions.size());
    const MeshData plain = make_sphere({.radius = 0.1f, .segments = 24, .rings = 12});
    CHECK(open_edges(refined(plain, 0.008f, 5)) == 0);
    CHECK(refined(plain, 0.008f, 5).positions.size() > 4 * plain.positions.size());
    CHECK(refined(make_sphere({.radius = 10}), 1e-5f, 5).positions.size() <= 1000000);
}

}  // namespace limn::refine_mesh_test

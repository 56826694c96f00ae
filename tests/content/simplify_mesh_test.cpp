#include "content/make/models/shapes.h"
#include "content/make/models/simplify_mesh.h"
#include "content/make/person/person.h"
#include "ecs/components/surface.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limn::simplify_mesh_test {

using test::near;

namespace {

Bounds box_of(const MeshData& mesh) {
    Bounds box = {mesh.positions[0], mesh.positions[0]};
    for (const Vec3& p : mesh.positions) {
        box.min = glm::min(box.min, p);
        box.max = glm::max(box.max, p);
    }
    return box;
}

/// Whether a triangle joins the lower legs, which touch in no triangle of a person.
bool joins_legs(const MeshData& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        bool left = false;
        bool right = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = mesh.positions[mesh.indices[i + k]];
            left = left || (p.y < 0.5f && p.x > 0.02f);
            right = right || (p.y < 0.5f && p.x < -0.02f);
        }
        if (left && right) {
            return true;
        }
    }
    return false;
}

}  // namespace

TEST_CASE(
    "merge: a person of a few hundred triangles keeps size, skin and colors"
    * technique("engine.lod-mesh")) {
    Assets assets;
    assets.meshes.push_back(make_person({.seed = 3, .head_triangles = 800, .triangles = 3000}));
    const MeshData& person = assets.meshes[0];
    const Bounds whole = box_of(person);
    const MeshData kept = make_simplified({.mesh = {0}, .triangles = 150}, assets);
    CHECK(kept.indices.size() > 3 * 1000);  // closed parts stay closed
    CHECK_FALSE(joins_legs(person));
    for (const int triangles : {600, 150, 100}) {
        const MeshData merged =
            make_simplified({.mesh = {0}, .triangles = triangles, .merge = true}, assets);
        CAPTURE(triangles);
        CAPTURE(merged.indices.size());
        CHECK(merged.indices.size() <= 3 * static_cast<std::size_t>(triangles));
        CHECK(merged.indices.size() >= 3 * static_cast<std::size_t>(triangles) / 2);
        CHECK_FALSE(joins_legs(merged));
        CHECK(merged.positions.size() < merged.indices.size());
        CHECK(merged.colors.size() == merged.positions.size());
        CHECK(merged.skin.first.size() == merged.positions.size() + 1);
        const Bounds box = box_of(merged);
        CHECK(box.max.y - box.min.y == near(whole.max.y - whole.min.y).epsilon(0.12));
        CHECK(
            *std::max_element(merged.indices.begin(), merged.indices.end())
            < merged.positions.size());
    }
}

TEST_CASE(
    "simplify: with colors, a line between bright and dark stays where it is"
    * technique("engine.lod-mesh")) {
    // A ball with a dark cap.
    MeshData ball = make_sphere({.radius = 1, .segments = 64, .rings = 48});
    for (const Vec3& p : ball.positions) {
        ball.colors.emplace_back(Vec3(p.z > 0.7f ? 0.1f : 1.0f), 1.0f);
    }
    // Mean difference of the red that a simplified ball shows in the directions of its vertices.
    const auto error_of = [&](const MeshData& mesh) {
        double sum = 0;
        for (std::size_t p = 0; p < ball.positions.size(); ++p) {
            for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
                const std::uint32_t* const v = &mesh.indices[i];
                const Mat3 corners(
                    mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
                const Vec3 w = glm::inverse(corners) * ball.positions[p];
                if (std::min({w.x, w.y, w.z}) > -1e-3f) {
                    const float red = (w.x * mesh.colors[v[0]].x + w.y * mesh.colors[v[1]].x
                                       + w.z * mesh.colors[v[2]].x)
                                      / (w.x + w.y + w.z);
                    sum += double{std::abs(red - ball.colors[p].x)};
                    break;
                }
            }
        }
        return sum / static_cast<double>(ball.positions.size());
    };
    MeshData colored = ball;
    simplify_mesh(colored, 300, 0.3f);
    MeshData plain = ball;
    simplify_mesh(plain, colored.indices.size() / 3);
    CHECK(colored.indices.size() <= 3 * 360);
    CHECK(error_of(colored) < 0.6 * error_of(plain));
    for (const Vec3& p : colored.positions) {
        CHECK(glm::length(p) == near(1));  // vertices that are left have not moved
    }
}

}  // namespace limn::simplify_mesh_test

#include "content/make/models/simplify_mesh.h"
#include "content/make/person/person.h"
#include "ecs/components/surface.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

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
    // A dark disc in the middle of a flat square: by its shape alone, two triangles are enough.
    constexpr std::uint32_t kSide = 49;
    constexpr float kRadius = 0.3f;
    MeshData square;
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const Vec2 at = Vec2(x, y) / static_cast<float>(kSide - 1) - 0.5f;
            square.positions.emplace_back(at, 0);
            square.normals.emplace_back(0, 0, 1);
            square.uvs.push_back(at);
            square.colors.emplace_back(Vec3(glm::length(at) < kRadius ? 0.1f : 1.0f), 1.0f);
        }
    }
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t i = y * kSide + x;
            square.indices.insert(
                square.indices.end(), {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide});
        }
    }
    const auto dark_area = [](const MeshData& mesh) {
        double area = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* const v = &mesh.indices[i];
            const Vec3& a = mesh.positions[v[0]];
            const double size =
                0.5
                * double{
                    glm::length(glm::cross(mesh.positions[v[1]] - a, mesh.positions[v[2]] - a))};
            for (std::size_t k = 0; k < 3; ++k) {
                area += size / 3 * (1 - double{mesh.colors[v[k]].x}) / 0.9;
            }
        }
        return area;
    };
    const double whole = dark_area(square);
    MeshData plain = square;
    simplify_mesh(plain, 200);
    MeshData colored = square;
    simplify_mesh(colored, 200, 0.3f);
    CHECK(colored.indices.size() <= 3 * 220);
    CHECK(std::abs(dark_area(plain) - whole) > 0.3 * whole);
    CHECK(std::abs(dark_area(colored) - whole) < 0.1 * whole);
    for (const Vec3& p : colored.positions) {
        CHECK(p.z == 0);  // vertices that are left have not moved
    }
}

}  // namespace limn::simplify_mesh_test

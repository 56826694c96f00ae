#include "content/make/models/patch_mesh.h"
#include "ecs/base/rng.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::patch_mesh_test {

using namespace limn::test;

namespace {

QuadraticPatch random_patch(std::uint64_t seed) {
    Random random(seed, 0, name_hash("random_patch"), 0);
    QuadraticPatch patch;
    for (auto& row : patch.q) {
        for (Vec3& point : row) {
            point = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        }
    }
    return patch;
}

/// Two patches side by side and two rows of them: a wavy cloth.
PatchMeshShape cloth() {
    PatchMeshShape shape = {.width = 5, .points = {}, .divisions = 6};
    for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 5; ++column) {
            shape.points.emplace_back(
                column, std::sin(1.7f * static_cast<float>(column + row)), row);
        }
    }
    return shape;
}

}  // namespace

TEST_CASE(
    "patch mesh: the weights of a quadratic sum to 1 and are positive inside"
    * technique("anim.biquadratic-patch")) {
    for (int k = 0; k <= 100; ++k) {
        const Vec3 w = quadratic_weights(static_cast<float>(k) / 100);
        CHECK(w.x + w.y + w.z == near(1).epsilon(1e-6));
        CHECK(std::min({w.x, w.y, w.z}) >= 0);
    }
    CHECK(quadratic_weights(0) == Vec3(1, 0, 0));
    CHECK(quadratic_weights(0.5f) == Vec3(0.25f, 0.5f, 0.25f));
}

TEST_CASE(
    "patch mesh: the elevated cubic is the quadratic at 121 points"
    * technique("anim.biquadratic-patch")) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const QuadraticPatch patch = random_patch(seed);
        const BezierPatch cubic = elevate_patch(patch);
        for (int i = 0; i <= 10; ++i) {
            for (int j = 0; j <= 10; ++j) {
                const float u = static_cast<float>(i) / 10;
                const float v = static_cast<float>(j) / 10;
                // In double precision, straight from the definition.
                const double b[2][3] = {
                    {(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), double(u) * u},
                    {(1.0 - v) * (1.0 - v), 2.0 * v * (1.0 - v), double(v) * v}};
                glm::dvec3 exact(0);
                for (std::size_t k = 0; k < 3; ++k) {
                    for (std::size_t l = 0; l < 3; ++l) {
                        exact += b[0][k] * b[1][l] * glm::dvec3(patch.q[k][l]);
                    }
                }
                CHECK(glm::distance(exact, glm::dvec3(patch_point(cubic, u, v))) < 1e-6);
                CHECK(glm::distance(exact, glm::dvec3(patch_point(patch, u, v))) < 1e-6);
            }
        }
    }
}

TEST_CASE(
    "patch mesh: a quarter circle is at most 6.1 % too far out, in its middle"
    * technique("anim.biquadratic-patch")) {
    QuadraticPatch arch;
    for (std::size_t j = 0; j < 3; ++j) {
        const auto z = static_cast<float>(j);
        arch.q[0][j] = {1, 0, z};
        arch.q[1][j] = {1, 1, z};
        arch.q[2][j] = {0, 1, z};
    }
    float farthest = 0;
    for (int i = 0; i <= 100; ++i) {
        const Vec3 point = patch_point(arch, static_cast<float>(i) / 100, 0.3f);
        const float radius = std::hypot(point.x, point.y);
        CHECK(radius >= 1 - 1e-6f);
        farthest = std::max(farthest, radius);
    }
    CHECK(farthest == near(1.06066).epsilon(1e-5));
    const Vec3 middle = patch_point(arch, 0.5f, 0.5f);
    CHECK(std::hypot(middle.x, middle.y) == near(farthest).epsilon(1e-6));
}

TEST_CASE(
    "patch mesh: neighbors share their edge to the bit, all vertices are on the surface"
    * technique("anim.biquadratic-patch")) {
    const PatchMeshShape shape = cloth();
    CHECK(list_patches(shape).size() == 4);
    const MeshData mesh = make_patch_grid(shape);
    CHECK(mesh.positions.size() == 4 * 49);
    CHECK(mesh.indices.size() == 4 * 36 * 6);
    // The last column of the first patch is the first one of the second.
    for (std::size_t j = 0; j < 7; ++j) {
        CHECK(mesh.positions[j * 7 + 6] == mesh.positions[49 + j * 7]);
    }
    for (const Vec3& normal : mesh.normals) {
        CHECK(glm::length(normal) == near(1).epsilon(1e-5));
        CHECK(normal.y < 0);  // u x v of a sheet with rows along +z
    }
    // Finer triangles are nearer to the surface: four times per doubling.
    const auto error_of = [&](int divisions) {
        const QuadraticPatch patch = list_patches(shape)[0];
        float largest = 0;
        for (int i = 0; i < divisions; ++i) {
            const auto at = [&](float k) {
                return patch_point(patch, k / static_cast<float>(divisions), 0);
            };
            const auto k = static_cast<float>(i);
            largest = std::max(largest, glm::distance(0.5f * (at(k) + at(k + 1)), at(k + 0.5f)));
        }
        return largest;
    };
    CHECK(error_of(8) == near(error_of(4) / 4).epsilon(1e-2));
    PatchMeshShape both = shape;
    both.double_sided = true;
    const MeshData sheet = make_patch_grid(both);
    CHECK(sheet.indices.size() == 2 * mesh.indices.size());
    CHECK(sheet.normals[4 * 49 + 3] == -sheet.normals[3]);
    PatchMeshShape fine = shape;
    fine.tolerance = 0.001f;
    CHECK(make_patch_grid(fine).positions.size() > mesh.positions.size());
}

TEST_CASE("patch mesh: a grid without a whole patch is empty, and more points are ignored") {
    PatchMeshShape shape;
    CHECK(make_patch_grid(shape).indices.size() == 8 * 8 * 6);
    shape.points.pop_back();
    CHECK(make_patch_grid(shape).indices.empty());
    shape.points.assign(14, Vec3(1, 2, 3));
    CHECK(list_patches(shape).size() == 1);
    for (const Vec3& normal : make_patch_grid(shape).normals) {
        CHECK(is_finite(normal));
    }
    shape.width = 4;
    CHECK(list_patches(shape).size() == 1);
    shape.points.clear();
    CHECK(list_patches(shape).empty());
}

}  // namespace limn::patch_mesh_test

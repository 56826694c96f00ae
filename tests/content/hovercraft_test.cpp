#include "content/make/models/hovercraft.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::hovercraft_test {

using namespace test;

TEST_CASE("hovercraft: closed, facing outward, of the requested length, simplified or not") {
    for (const int triangles : {0, 14000}) {
        CAPTURE(triangles);
        const MeshData mesh = make_hovercraft({.triangles = triangles});
        CHECK(open_edges(mesh) == 0);
        CHECK(crowded_edges(mesh) == 0);
        CHECK(signed_volume(mesh) > 2);  // [m^3]
        CHECK(mesh.bounds.max.z - mesh.bounds.min.z == test::near(4.75).epsilon(0.02));
        if (triangles > 0) {
            CHECK(mesh.indices.size() / 3 < 16500);
        }
        double inward = 0;
        double area = 0;
        for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
            const Vec3 twice = double_area(mesh, t);
            area += static_cast<double>(glm::length(twice));
            if (glm::dot(twice, mesh.normals[mesh.indices[3 * t]]) < 0) {
                inward += static_cast<double>(glm::length(twice));
            }
        }
        CHECK(inward < 1e-3 * area);
    }
    const MeshData small = make_hovercraft({.length = 0.5f, .detail = 0.1f});
    CHECK(small.bounds.max.z - small.bounds.min.z == test::near(0.475).epsilon(0.05));
}

TEST_CASE("hovercraft: mirror symmetric, with orthogonal frames") {
    const MeshData mesh = make_hovercraft({.detail = 0.06f, .triangles = 0});
    CHECK(mesh.bounds.max.x == test::near(-mesh.bounds.min.x).epsilon(1e-3));
    double left = 0;
    double right = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        (mesh.positions[i].x > 0 ? left : right) += 1;
        REQUIRE(glm::length(mesh.normals[i]) == test::near(1));
        REQUIRE(glm::length(Vec3(mesh.tangents[i])) == test::near(1));
        REQUIRE(std::abs(glm::dot(mesh.normals[i], Vec3(mesh.tangents[i]))) < 1e-4f);
    }
    CHECK(left == test::near(right).epsilon(0.05));
    CHECK(mesh.colors.size() == mesh.positions.size());
}

}  // namespace limn::hovercraft_test

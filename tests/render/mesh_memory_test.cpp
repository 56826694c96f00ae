// What is kept of meshes is what would be computed of them anew.

#include "render/geometry/mesh_curvature.h"
#include "render/geometry/mesh_memory.h"
#include "render/geometry/triangle_order.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::mesh_memory_test {
namespace {

/// A wavy sheet of 20 x 20 quads, bent in both directions.
MeshData sheet() {
    constexpr std::uint32_t kSide = 21;
    MeshData mesh;
    for (std::uint32_t z = 0; z < kSide; ++z) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const Vec2 at = Vec2(x, z) / 20.0f;
            const Vec3 slope = {2 * at.x, 0, std::cos(4 * at.y)};
            mesh.positions.emplace_back(at.x, at.x * at.x + 0.25f * std::sin(4 * at.y), at.y);
            mesh.normals.push_back(glm::normalize(Vec3(-slope.x, 1, -slope.z)));
            mesh.tangents.emplace_back(glm::normalize(Vec3(1, slope.x, 0)), 1.0f);
        }
    }
    for (std::uint32_t z = 0; z + 1 < kSide; ++z) {
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t a = z * kSide + x;
            mesh.indices.insert(
                mesh.indices.end(), {a, a + kSide, a + 1, a + 1, a + kSide, a + kSide + 1});
        }
    }
    return mesh;
}

bool is_of(const PreparedMesh& found, const MeshData& mesh, bool curved) {
    const std::vector<CoarseTriangles> expected = simplify_triangles(mesh);
    bool same = found.coarse.size() == expected.size();
    for (std::size_t i = 0; same && i < expected.size(); ++i) {
        same = found.coarse[i].indices == expected[i].indices
               && found.coarse[i].error == expected[i].error;
    }
    return same && found.ordered == order_for_cache(mesh.indices, mesh.positions.size())
           && (!curved || found.curvatures == fit_curvatures(mesh));
}

}  // namespace

TEST_CASE("mesh memory: what is kept is of the mesh, whatever changes in it") {
    MeshMemory memory;
    MeshData mesh = sheet();
    const std::vector<const MeshData*> meshes = {nullptr, &mesh, &mesh};
    const auto check = [&](bool curved) {
        for (int time = 0; time < 2; ++time) {
            const std::vector<const PreparedMesh*> found = memory.prepare(meshes, curved);
            CHECK(found[0] == nullptr);
            CHECK(found[1] == found[2]);
            CHECK(is_of(*found[1], mesh, curved));
        }
    };
    REQUIRE_FALSE(simplify_triangles(mesh).empty());
    check(false);
    check(true);
    mesh.positions[70] *= 1.5f;
    check(true);
    mesh.tangents[70].w = -1;
    mesh.normals[71] = {0, 0, 1};
    check(true);
    mesh.indices.resize(mesh.indices.size() - 3);
    check(true);
    mesh.morphs.resize(1);  // which is simplified by edge collapse only
    check(true);
}

}  // namespace limn::mesh_memory_test

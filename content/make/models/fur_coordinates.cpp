#include "content/make/models/fur_coordinates.h"

#include "content/make/models/keep_triangles.h"
#include "ecs/components/fur.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

// Techniques: shade.fur

namespace limn {
namespace {

/// The axis that a triangle faces most.
int facing_axis(const MeshData& mesh, const std::uint32_t* corner) {
    const Vec3 a = mesh.positions[corner[0]];
    const Vec3 facing =
        glm::abs(glm::cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a));
    return facing.x >= facing.y && facing.x >= facing.z ? 0 : facing.y >= facing.z ? 1 : 2;
}

/// Different axes have different parts of the plane.
Vec2 projected_along(const Vec3& p, int axis) {
    constexpr std::array<Vec2, 3> kOffset = {Vec2(17.3f, 5.1f), Vec2(0, 0), Vec2(-11.9f, 23.7f)};
    const auto i = static_cast<std::size_t>(axis);
    return Vec2(p[(axis + 1) % 3], p[(axis + 2) % 3]) + kOffset[i];
}

}  // namespace

void add_fur_coordinates(MeshData& mesh) {
    if (mesh.positions.empty() || !mesh.uvs1.empty()) {
        return;
    }
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> made;
    std::vector<std::uint32_t> source;
    std::vector<Vec2> coordinates;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const int axis = facing_axis(mesh, &mesh.indices[i]);
        for (std::size_t k = i; k < i + 3; ++k) {
            const std::uint32_t vertex = mesh.indices[k];
            const auto [found, is_new] =
                made.try_emplace({vertex, axis}, static_cast<std::uint32_t>(source.size()));
            if (is_new) {
                source.push_back(vertex);
                coordinates.push_back(projected_along(mesh.positions[vertex], axis));
            }
            mesh.indices[k] = found->second;
        }
    }
    gather_vertices(mesh, source);
    mesh.uvs1 = std::move(coordinates);
    ++mesh.version;
}

void add_fur_coordinates(World& world) {
    auto* const assets = world.find_resource<Assets>();
    if (assets == nullptr) {
        return;
    }
    world.query<const Fur, const MeshInstance>().each([&](const Fur&, const MeshInstance& surface) {
        if (surface.mesh.index < assets->meshes.size()) {
            add_fur_coordinates(assets->meshes[surface.mesh.index]);
        }
    });
}

}  // namespace limn

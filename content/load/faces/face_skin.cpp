#include "content/load/faces/face_skin.h"

#include "content/bake/surface_fit.h"
#include "ecs/base/triangle.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>

// Techniques: face.retarget-fit

namespace limn {
namespace {

/// Barycentric weights of `p` in the plane of a triangle; at its first corner if it has no area.
Vec3 barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = glm::cross(b - a, c - a);
    const float area2 = glm::dot(normal, normal);
    if (!(area2 > 0.0f)) {
        return {1, 0, 0};
    }
    const float at_b = glm::dot(glm::cross(p - a, c - a), normal) / area2;
    const float at_c = glm::dot(glm::cross(b - a, p - a), normal) / area2;
    return {1.0f - at_b - at_c, at_b, at_c};
}

}  // namespace

std::size_t count_moved(const MeshData& mesh) {
    std::size_t moved = 0;
    for (const MorphTarget& morph : mesh.morphs) {
        moved += morph.vertices.size();
    }
    return moved;
}

const MeshData* find_face_skin(std::span<const MeshData> meshes) {
    const MeshData* skin = nullptr;
    std::size_t most = 0;
    for (const MeshData& mesh : meshes) {
        const std::size_t moved = count_moved(mesh);
        if (moved > most) {
            most = moved;
            skin = &mesh;
        }
    }
    return skin;
}

Vec3 position_on(const SkinPoint& point, std::span<const Vec3> positions) {
    Vec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k) {
        sum += point.weights[static_cast<int>(k)] * positions[point.vertices[k]];
    }
    return sum;
}

SkinPoint nearest_on_mesh(const MeshData& mesh, const Vec3& position) {
    const std::uint32_t vertex = label_vertices(std::span(&position, 1), mesh.positions)[0];
    SkinPoint found{{vertex, vertex, vertex}, {1, 0, 0}};
    float nearest = glm::distance(mesh.positions[vertex], position);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::array corners = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        const Vec3& a = mesh.positions[corners[0]];
        const Vec3& b = mesh.positions[corners[1]];
        const Vec3& c = mesh.positions[corners[2]];
        const Vec3 point = nearest_on_triangle(position, a, b, c);
        const float away = glm::distance(point, position);
        if (away < nearest) {
            nearest = away;
            found = {corners, barycentric(point, a, b, c)};
        }
    }
    return found;
}

std::optional<SkinPoint> hit_mesh_at(
    const MeshData& mesh, std::span<const Vec3> positions, const Vec3& origin,
    const Vec3& direction) {
    std::optional<SkinPoint> found;
    float nearest = INFINITY;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::array corners = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        const auto hit = hit_triangle(
            origin, direction, positions[corners[0]], positions[corners[1]], positions[corners[2]]);
        if (hit && hit->distance < nearest) {
            nearest = hit->distance;
            found = SkinPoint{corners, {1.0f - hit->b - hit->c, hit->b, hit->c}};
        }
    }
    return found;
}

}  // namespace limn

#include "systems/particles/gpu_shapes.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <variant>

// Techniques: particle.constraints, particle.heightfield-collision

namespace limn {
namespace {

float shape_word(std::size_t bits) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}

/// Adds the descendants of a node in depth-first order; triangles to a list of their own.
void add_shape_nodes(
    const MeshBvh& bvh, std::uint32_t index, std::vector<Vec4>& nodes,
    std::vector<Vec4>& triangles) {
    const MeshBvh::Node& node = bvh.nodes[index];
    for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
        const std::uint32_t child = node.child[i];
        if (child == MeshBvh::kNoChild) {
            continue;
        }
        const std::size_t at = nodes.size();
        const auto& b = node.bounds;
        nodes.emplace_back(b[0][0][i], b[0][1][i], b[0][2][i], 0.0f);
        nodes.emplace_back(b[1][0][i], b[1][1][i], b[1][2][i], 0.0f);
        if ((child & MeshBvh::kLeafBit) == 0) {
            add_shape_nodes(bvh, child, nodes, triangles);
        } else {
            const MeshBvh::Leaf& leaf = bvh.leaves[child & ~MeshBvh::kLeafBit];
            const std::size_t first = triangles.size() / kShapeTriangleTexels;
            for (std::size_t t = 0; t < MeshBvh::kTriangles; ++t) {
                if (leaf.triangle[t] == kNoTriangle) {
                    continue;
                }
                for (const auto& corner : leaf.corner) {
                    triangles.emplace_back(
                        corner[0][t], corner[1][t], corner[2][t], shape_word(leaf.triangle[t]));
                }
            }
            const std::size_t count = triangles.size() / kShapeTriangleTexels - first;
            nodes[at + 1].w = shape_word(8 * first + count);
        }
        nodes[at].w = shape_word(nodes.size() / kShapeNodeTexels);
    }
}

/// `space_from_world` in which what moved with `world` is where it was at `then`; none if the world
/// has no inverse.
std::optional<Affine> shape_from_world(const Affine& then, const Affine& world) {
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(to_mat4(world)));
    const glm::dmat4 found = glm::dmat4(to_mat4(then)) * inverse;
    Affine rows;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            rows.row[row][column] = static_cast<float>(found[column][row]);
            if (!std::isfinite(rows.row[row][column])) {
                return std::nullopt;
            }
        }
    }
    return rows;
}

bool are_equal_rows(const Affine& a, const Affine& b) {
    return std::equal(std::begin(a.row), std::end(a.row), std::begin(b.row));
}

GpuCollider
make_gpu_collider(const PlaneCollider& plane, const ParticleObstacles&, GpuShapes::Entry&) {
    const Vec3 normal = normalize_or(plane.normal, Vec3(0, 1, 0));
    return {.kind = GpuColliderKind::Plane, .rows = {Vec4(normal, plane.offset)}};
}

GpuCollider
make_gpu_collider(const SphereCollider& sphere, const ParticleObstacles&, GpuShapes::Entry&) {
    return {
        .kind = GpuColliderKind::Sphere,
        .rows = {Vec4(sphere.center, sphere.radius), Vec4(sphere.inverted ? 1.0f : 0.0f)}};
}

GpuCollider make_gpu_collider(const BoxCollider& box, const ParticleObstacles&, GpuShapes::Entry&) {
    GpuCollider found{.kind = GpuColliderKind::Box, .half = box.half};
    const Affine& world = box.world_from_box;  // a rotation: its transpose is its inverse
    const Vec3 center = {world.row[0].w, world.row[1].w, world.row[2].w};
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 unit = {world.row[0][axis], world.row[1][axis], world.row[2][axis]};
        found.rows[axis] = Vec4(unit, -glm::dot(unit, center));
    }
    return found;
}

GpuCollider
make_gpu_collider(const HeightCollider& field, const ParticleObstacles&, GpuShapes::Entry& entry) {
    const bool is_same = entry.shape != nullptr && !entry.is_mesh && entry.width == field.width
                         && std::ranges::equal(entry.heights, field.heights);
    if (!is_same) {
        entry = {
            .shape = std::make_shared<const std::vector<Vec4>>(make_height_texels(field)),
            .heights = {field.heights.begin(), field.heights.end()},
            .width = field.width};
    }
    return {
        .kind = GpuColliderKind::Heights,
        .rows = {Vec4(field.origin, field.cell.x), Vec4(field.cell.y, 0, 0, 0)},
        .half = Vec3(field.width, field.depth, 0),
        .shape = entry.shape};
}

GpuCollider make_gpu_collider(
    const MeshCollider& mesh, const ParticleObstacles& obstacles, GpuShapes::Entry& entry) {
    const auto found =
        std::find_if(obstacles.meshes.begin(), obstacles.meshes.end(), [&](const auto& one) {
            return &one.bvh == mesh.bvh;
        });
    const ObstacleMesh* const source = found != obstacles.meshes.end() ? &*found : nullptr;
    std::optional<Affine> rows;
    if (source != nullptr && !source->deforms && entry.is_mesh && entry.shape != nullptr
        && entry.mesh == source->mesh && entry.version == source->version) {
        rows = are_equal_rows(entry.world, source->world)
                   ? Affine{}
                   : shape_from_world(entry.world, source->world);
    }
    if (!rows) {
        MeshTexels made = make_mesh_texels(*mesh.bvh);
        if (!entry.is_mesh || entry.shape == nullptr || *entry.shape != made.texels) {
            entry.shape = std::make_shared<const std::vector<Vec4>>(std::move(made.texels));
        }
        entry.is_mesh = true;
        entry.nodes = made.nodes;
        entry.mesh = source != nullptr ? source->mesh : MeshId{};
        entry.version = source != nullptr ? source->version : 0;
        entry.world = source != nullptr ? source->world : Affine{};
        rows = Affine{};
    }
    GpuCollider collider{
        .kind = GpuColliderKind::Mesh,
        .half = Vec3(static_cast<float>(entry.nodes), mesh.bvh->largest, 0),
        .shape = entry.shape};
    std::copy(std::begin(rows->row), std::end(rows->row), std::begin(collider.rows));
    return collider;
}

}  // namespace

std::vector<Vec4> make_height_texels(const HeightCollider& field) {
    std::vector<Vec4> texels;
    for (int j = 0; j + 1 < field.depth; ++j) {
        const float* const row =
            field.heights.data() + static_cast<std::ptrdiff_t>(j) * field.width;
        for (int i = 0; i + 1 < field.width; ++i) {
            const float* const below = row + field.width;
            texels.emplace_back(row[i], row[i + 1], below[i], below[i + 1]);
        }
    }
    return texels;
}

MeshTexels make_mesh_texels(const MeshBvh& bvh) {
    MeshTexels made;
    if (bvh.nodes.empty()) {
        return made;
    }
    std::vector<Vec4> triangles;
    add_shape_nodes(bvh, 0, made.texels, triangles);
    made.nodes = static_cast<std::uint32_t>(made.texels.size() / kShapeNodeTexels);
    made.texels.insert(made.texels.end(), triangles.begin(), triangles.end());
    return made;
}

std::vector<GpuCollider> find_gpu_colliders(const ParticleObstacles& obstacles, GpuShapes& shapes) {
    const std::vector<Collider>& colliders = obstacles.solid.colliders;
    shapes.entries.resize(colliders.size());
    std::vector<GpuCollider> found;
    found.reserve(colliders.size());
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        found.push_back(std::visit(
            [&](const auto& shape) {
                return make_gpu_collider(shape, obstacles, shapes.entries[i]);
            },
            colliders[i]));
    }
    return found;
}

void limit_shape_memory(std::size_t bytes, std::vector<GpuParticleStep>& steps) {
    const auto shape_of = [](const GpuCollider& collider) { return collider.shape; };
    const std::size_t count = steps.size();
    if (count > 1
        && std::ranges::equal(
            steps[count - 1].colliders, steps[count - 2].colliders, {}, shape_of, shape_of)) {
        return;  // nothing was added
    }
    std::size_t used = 0;
    for (std::size_t i = steps.size(); i-- > 0;) {
        std::vector<GpuCollider>& colliders = steps[i].colliders;
        const std::vector<GpuCollider>* const later =
            i + 1 < steps.size() ? &steps[i + 1].colliders : nullptr;
        for (std::size_t k = 0; k < colliders.size(); ++k) {
            GpuCollider& one = colliders[k];
            const bool has_later = later != nullptr && k < later->size()
                                   && (*later)[k].kind == one.kind && (*later)[k].shape != nullptr;
            if (one.shape == nullptr || (has_later && (*later)[k].shape == one.shape)) {
                continue;
            }
            if (has_later && used + one.shape->size() * sizeof(Vec4) > bytes) {
                one = (*later)[k];
            } else {
                used += one.shape->size() * sizeof(Vec4);
            }
        }
    }
}

}  // namespace limn

#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "render/culling.h"
#include "render/mesh_pool.h"
#include "render/render_view.h"
#include "render/skinning/deformed_list.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Access to the world's mesh instances, one chunk at a time, shared by culling and drawing.

/// The columns of a chunk that a query returned.
struct InstanceRows {
    std::span<const MeshInstance> surfaces;
    std::span<const WorldTransform> now;
    std::span<const PreviousWorldTransform> before;  ///< empty: static
    std::span<const Inflate> inflate;                ///< empty: not inflated
    std::span<const Deformed> deformed;              ///< empty: in rest pose
    std::span<const Entity> entities;
    const DeformedList& shapes;

    /// Index into `shapes`, or DeformedList::kNone.
    [[nodiscard]] std::uint32_t shape(std::size_t i) const {
        return deformed.empty() ? DeformedList::kNone : shapes.find(entities[i]);
    }
    /// Local-space box of the surface. The mesh must exist.
    [[nodiscard]] Bounds bounds(std::size_t i, const std::vector<MeshRange>& meshes) const {
        const std::uint32_t its = shape(i);
        const Bounds& box =
            its != DeformedList::kNone ? shapes[its].bounds : meshes[surfaces[i].mesh.index].bounds;
        return inflate.empty() ? box : inflated(box, inflate[i]);
    }
    [[nodiscard]] Affine at(std::size_t i, float alpha) const {
        return before.empty() || alpha == 1.0f ? now[i].world
                                               : mix_affine(before[i].world, now[i].world, alpha);
    }
};

/// World-space boxes of the rows; rows without triangles or with non-finite transforms get a box
/// that no frustum contains. `mirrored` receives the sign of each determinant.
void fill_boxes(
    const InstanceRows& rows, float alpha, const std::vector<MeshRange>& meshes, BoxBlock& boxes,
    std::uint8_t* mirrored);

}  // namespace limn

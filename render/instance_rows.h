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

// The world's mesh instances, a chunk at a time: what culls and draws them reads them here.

/// What a chunk of a query shows of its rows.
struct InstanceRows {
    std::span<const MeshInstance> surfaces;
    std::span<const WorldTransform> now;
    std::span<const PreviousWorldTransform> before;  ///< empty: never moved
    std::span<const Inflate> inflate;                ///< empty: as they are
    std::span<const Deformed> deformed;              ///< empty: as at rest
    std::span<const Entity> entities;
    const DeformedList& shapes;

    /// Index into `shapes`, or its kNone.
    [[nodiscard]] std::uint32_t shape(std::size_t i) const {
        return deformed.empty() ? DeformedList::kNone : shapes.find(entities[i]);
    }
    /// Box of the surface in its own space. The mesh must be there.
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

/// World boxes of the rows; what has no triangles or is not finite gets a box that is nowhere.
/// `mirrored` gets the sign of each determinant.
void fill_boxes(
    const InstanceRows& rows, float alpha, const std::vector<MeshRange>& meshes, BoxBlock& boxes,
    std::uint8_t* mirrored);

}  // namespace limn

#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "render/culling.h"
#include "render/mesh_pool.h"
#include "render/render_view.h"

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

    [[nodiscard]] Affine at(std::size_t i, float alpha) const {
        return before.empty() || alpha == 1.0f ? now[i].world
                                               : mix_affine(before[i].world, now[i].world, alpha);
    }
};

/// World boxes of the rows; what has no triangles or is not finite gets a box that is nowhere.
/// `mirrored` gets the sign of each determinant.
void fill_boxes(
    const InstanceRows& rows,
    float alpha,
    const std::vector<MeshRange>& meshes,
    BoxBlock& boxes,
    std::uint8_t* mirrored);

}  // namespace limn

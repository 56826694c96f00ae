#pragma once

#include "ecs/base/depth_sort.h"
#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// First hits of short segments, the paths of particles, on a triangle mesh: a bounding volume
// hierarchy with eight children per node, built by the surface area heuristic over 16 bins per axis
// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007), directly with
// eight children (Wald, Benthin and Boulos 2008). Children and triangles are tested with SIMD.
//
// Watertight (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013): a segment
// never slips between triangles that share an edge or a vertex. Fractions are tested with a
// tolerance for rounding, so that nothing slips between two segments with a common end either.
// Triangles are two-sided. Results are bit-identical on every machine.

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct Segment {
    Vec3 from = Vec3(0);
    Vec3 to = Vec3(0);
};

struct MeshHit {
    float fraction = 0;                    ///< of the segment, 0 .. 1
    std::uint32_t triangle = kNoTriangle;  ///< indices[3 * triangle ...]; kNoTriangle: none hit
    Vec3 normal = Vec3(0);                 ///< unit; counterclockwise triangles face it
};

/// Plain arrays; node 0 is the root, children follow their parents. No nodes: an empty mesh.
struct MeshBvh {
    static constexpr std::size_t kChildren = 8;
    static constexpr std::size_t kTriangles = 4;         ///< in a leaf
    static constexpr std::uint32_t kLeafBit = 1u << 31;  ///< of a child: an index into `leaves`
    static constexpr std::uint32_t kNoChild = 0xffffffffu;

    struct alignas(32) Node {
        float bounds[2][3][kChildren];  ///< minima, maxima of x, y, z; +-infinity without a child
        std::uint32_t child[kChildren];
    };
    struct alignas(32) Leaf {
        float corner[3][3][kTriangles];      ///< x, y, z of each corner; NaN: never hit
        std::uint32_t triangle[kTriangles];  ///< kNoTriangle: fewer
    };
    std::vector<Node> nodes{};
    std::vector<Leaf> leaves{};
    float largest = 0;  ///< absolute coordinate
};

/// Three indices per triangle. Leaves out triangles without area, with coordinates that are not
/// finite and with indices beyond `positions`; what is left may be empty. Deterministic. Below 2^31
/// triangles; 101,000 take about 40 ms.
[[nodiscard]] MeshBvh
build_mesh_bvh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

/// Refits the same tree to moved vertices; tracing is slower the more triangles have moved relative
/// to each other. `indices` must be those it was built from. Triangles that were left out stay so.
void refit_mesh_bvh(
    MeshBvh& bvh, std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

/// The first triangle along the segment; of equally near ones, that with the smallest index. None
/// for segments that are not finite or shorter than 1e-30.
[[nodiscard]] MeshHit first_hit(const MeshBvh& bvh, const Segment& segment);

/// Calls visit(number, a, b, c) for the triangles whose bounds overlap the box, in the order of the
/// tree.
template <typename Visit>
void visit_triangles(const MeshBvh& bvh, const Bounds& box, Visit&& visit) {
    if (bvh.nodes.empty()) {
        return;
    }
    std::vector<std::uint32_t> open = {0};
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        open.pop_back();
        if ((index & MeshBvh::kLeafBit) != 0) {
            const MeshBvh::Leaf& leaf = bvh.leaves[index & ~MeshBvh::kLeafBit];
            for (std::size_t t = 0; t < MeshBvh::kTriangles; ++t) {
                if (leaf.triangle[t] == kNoTriangle) {
                    continue;
                }
                Vec3 corners[3];
                Bounds own;
                for (int k = 0; k < 3; ++k) {
                    const auto& corner = leaf.corner[k];
                    corners[k] = {corner[0][t], corner[1][t], corner[2][t]};
                    grow(own, corners[k]);
                }
                bool touches = true;
                for (int axis = 0; axis < 3; ++axis) {
                    touches =
                        touches && own.min[axis] <= box.max[axis] && box.min[axis] <= own.max[axis];
                }
                if (touches) {
                    visit(leaf.triangle[t], corners[0], corners[1], corners[2]);
                }
            }
            continue;
        }
        const MeshBvh::Node& node = bvh.nodes[index];
        for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
            bool overlaps = node.child[i] != MeshBvh::kNoChild;
            for (int axis = 0; axis < 3; ++axis) {
                overlaps = overlaps && node.bounds[0][axis][i] <= box.max[axis]
                           && node.bounds[1][axis][i] >= box.min[axis];
            }
            if (overlaps) {
                open.push_back(node.child[i]);
            }
        }
    }
}

/// Scratch memory of first_hits: keep it from frame to frame.
struct SegmentBatch {
    std::vector<std::uint32_t> keys{};
    std::vector<std::uint32_t> order{};
    SortScratch sort{};
};

/// hits[i] = first_hit(bvh, segments[i]), with equal bits, in the order of the Morton codes of
/// their midpoints: neighbors read the same nodes. Both spans have the same size.
void first_hits(
    const MeshBvh& bvh, std::span<const Segment> segments, std::span<MeshHit> hits,
    SegmentBatch& batch);

}  // namespace limn

#pragma once

#include "ecs/components/gpu_particles.h"
#include "systems/particles/particle_obstacles.h"

#include <vector>

namespace limn {

// Colliders as the GPU reads them. The texels of a height field are its cells, row by row: the
// heights at (0, 0), (1, 0), (0, 1) and (1, 1). Those of a mesh are the nodes of its hierarchy in
// depth-first order, each with the number of the node after its descendants (Smits, "Efficiency
// Issues for Ray Tracing", 1998), so that it is walked without a stack, and then its triangles.

/// Texels of a node: minimum, number of the next node that is no descendant (word); maximum, its
/// triangles: first * 8 + number (word).
inline constexpr std::size_t kShapeNodeTexels = 2;
/// Texels of a triangle: its corners; the first has its number (word).
inline constexpr std::size_t kShapeTriangleTexels = 3;

[[nodiscard]] std::vector<Vec4> make_height_texels(const HeightCollider& field);

struct MeshTexels {
    std::vector<Vec4> texels{};
    std::uint32_t nodes = 0;
};
[[nodiscard]] MeshTexels make_mesh_texels(const MeshBvh& bvh);

/// Resource: the shapes of the latest step, in the order of the colliders.
struct GpuShapes {
    struct Entry {
        GpuShape shape{};
        std::vector<float> heights{};  ///< of a field: what it was made of
        int width = 0;                 ///< likewise
        MeshId mesh{};                 ///< of a mesh that does not deform, likewise
        std::uint32_t version = 0;     ///< likewise
        Affine world{};                ///< of a mesh when it was made
        std::uint32_t nodes = 0;       ///< of a mesh
        bool is_mesh = false;
    };
    std::vector<Entry> entries{};
};

/// The solid colliders of this step. A mesh that moves without being deformed keeps its shape.
[[nodiscard]] std::vector<GpuCollider>
find_gpu_colliders(const ParticleObstacles& obstacles, GpuShapes& shapes);

/// Limits the memory of shapes that change from step to step: steps whose shapes exceed `bytes`
/// get those of the step after, which only matters to a GPU that starts over.
void limit_shape_memory(std::size_t bytes, std::vector<GpuParticleStep>& steps);

}  // namespace limn

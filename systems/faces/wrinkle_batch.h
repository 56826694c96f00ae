#pragma once

#include "ecs/components/wrinkle.h"

#include <span>

namespace limn {

// Wrinkle intensities of a crowd: faces with the same mesh at rest, eight at a time, one per SIMD
// lane. Neighboring lanes then read one vertex of eight faces, so that triangles need no gathers,
// and weights and directions are read once for all eight. Compression is bit-identical to
// vertex_compression(); intensity, by another logarithm, is within 1e-6 of wrinkle_intensity().

/// One face of the crowd.
struct CrowdFace {
    std::span<const Vec3> deformed;  ///< its vertices, as many as the mesh at rest has
    float lambda = 1.05f;            ///< of WrinkleSurface, > 0
    float beta = 4;                  ///< of WrinkleSurface
    std::span<float> intensity;      ///< destination, one per vertex, -1 .. 1
    float resting_weight = 0;        ///< weight of the folds at rest, that of their shape, 0 .. 1
};

/// Writes wrinkle_intensity() of every vertex of every face, without its mask. `rests` and
/// `resting`, which is not for a radial driver, are those of the WrinkleState of the mesh: zero,
/// one or three rests, and a shortening per vertex or nothing. Threads get groups of eight faces;
/// results do not depend on the grouping.
void find_intensities(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting = {});

/// The same, face by face on this thread.
void find_intensities_scalar(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting = {});

}  // namespace limn

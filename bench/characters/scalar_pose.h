#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::bench {

// Poses as people write them by hand, one joint after another: what `limn bench characters`
// compares with. Rotations are float arrays q[4 n], translations t[3 n], matrices 12 floats a
// joint.

/// Uniform frames of all joints, as floats.
struct ScalarClip {
    std::size_t joints = 0;
    std::size_t frames = 0;
    float rate = 30.0f;               ///< frames per second
    std::vector<float> rotations;     ///< frames * joints * 4
    std::vector<float> translations;  ///< frames * joints * 3
};

void sample_scalar(const ScalarClip& clip, float time, float* q, float* t);
void blend_scalar(
    const float* qa, const float* ta, const float* qb, const float* tb, float weight,
    std::size_t joints, float* q, float* t);
void multiply_scalar(
    const std::int32_t* parents, const float* q, const float* t, std::size_t joints, float* model);
/// out = model * bind, for each joint.
void skin_scalar(const float* model, const float* bind, std::size_t joints, float* out);

/// Vertices with `influences` joints each: position and normal, three floats each.
void skin_vertices_scalar(
    const float* palette, const std::uint16_t* joints, const float* weights, int influences,
    const float* positions, const float* normals, std::size_t count, float* out_positions,
    float* out_normals);

}  // namespace limn::bench

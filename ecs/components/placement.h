#pragma once

#include "ecs/base/rotation.h"
#include "ecs/components/transform.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace limn {

/// Decomposes `matrix` into translation, rotation and scale. Shear is dropped; a mirroring matrix
/// gets a negative x scale; a degenerate axis keeps a scale of 1e-6, since 0 is not invertible.
[[nodiscard]] inline Transform decompose_affine(const Affine& matrix) {
    constexpr float kMinAxisScale = 1e-6f;
    Transform result;
    Mat3 axes;
    for (int i = 0; i < 3; ++i) {
        axes[i] = Vec3(matrix.row[0][i], matrix.row[1][i], matrix.row[2][i]);
        result.position[i] = matrix.row[i].w;
        result.scale[i] = std::max(glm::length(axes[i]), kMinAxisScale);
    }
    if (glm::determinant(axes) < 0.0f) {
        axes[0] = -axes[0];
        result.scale.x = -result.scale.x;
    }
    result.rotation = extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
    return result;
}

}  // namespace limn

#pragma once

#include "systems/animation/ik/joint_tree.h"

#include <cstddef>
#include <vector>

namespace limn {

// The Jacobian of forward kinematics: velocity of an effector = J * rates of the axes. It depends
// on theta: valid for one pose only. The column of a hinge about unit axis a through p is
// (a x (effector - p), a), that of a slide (a, 0); of an axis that does not move the effector, 0.
// Techniques: char.ik-jacobian

/// A dense matrix, row by row.
struct IkMatrix {
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<float> values;

    void resize(std::size_t new_rows, std::size_t new_columns) {
        rows = new_rows;
        columns = new_columns;
        values.assign(rows * columns, 0.0f);
    }
    [[nodiscard]] float& at(std::size_t row, std::size_t column) {
        return values[row * columns + column];
    }
    [[nodiscard]] float at(std::size_t row, std::size_t column) const {
        return values[row * columns + column];
    }
};

/// The geometric Jacobian: 3 rows of position or, with `turn_scale` > 0, 3 more of orientation,
/// times `turn_scale` [m/rad]; a column per axis.
void find_jacobian(
    const JointTree& tree, const JointFrames& frames, const Effector& effector, float turn_scale,
    IkMatrix& jacobian);

/// product = matrix * vector.
void multiply(const IkMatrix& matrix, std::span<const float> vector, std::span<float> product);

}  // namespace limn

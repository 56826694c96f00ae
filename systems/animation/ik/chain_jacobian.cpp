#include "systems/animation/ik/chain_jacobian.h"

#include <glm/geometric.hpp>

// Techniques: char.ik-jacobian

namespace limn {

void find_jacobian(
    const JointTree& tree, const JointFrames& frames, const Effector& effector, float turn_scale,
    IkMatrix& jacobian) {
    jacobian.resize(turn_scale > 0 ? 6 : 3, tree.axes.size());
    const Vec3 end = effector_position(frames, effector);
    // Axes and ancestors of the effector are both visited in descending order of joints.
    std::int32_t above = effector.joint;
    for (std::size_t i = tree.axes.size(); i-- > 0;) {
        const JointAxis& axis = tree.axes[i];
        while (above > axis.joint) {
            above = tree.parents[above];
        }
        if (above != axis.joint) {
            continue;
        }
        const bool turns = axis.kind != AxisKind::Slide;
        const Vec3& a = frames.axes[i];
        const Vec3 velocity = turns ? glm::cross(a, end - frames.centers[i]) : a;
        for (int row = 0; row < 3; ++row) {
            jacobian.at(row, i) = velocity[row];
            if (turn_scale > 0 && turns) {
                jacobian.at(row + 3, i) = turn_scale * a[row];
            }
        }
    }
}

void multiply(const IkMatrix& matrix, std::span<const float> vector, std::span<float> product) {
    for (std::size_t row = 0; row < matrix.rows; ++row) {
        float sum = 0;
        for (std::size_t column = 0; column < matrix.columns; ++column) {
            sum += matrix.at(row, column) * vector[column];
        }
        product[row] = sum;
    }
}

}  // namespace limn

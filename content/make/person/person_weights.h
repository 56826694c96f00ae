#pragma once

#include "content/make/person/person_mesh.h"

#include <array>
#include <vector>

namespace limn {

/// Weights of all joints at a vertex; sum to 1.
using JointWeights = std::array<float, kPersonJoints>;

/// Which joints move the vertices of `mesh`: smooth functions of the position along limbs and back,
/// smoothed over the surface where they meet. Twist joints take their share where they are.
[[nodiscard]] std::vector<JointWeights>
person_weights(const PersonFrame& frame, const BodyMesh& mesh);

/// Weights at a point of the neck or the head, reference units.
[[nodiscard]] JointWeights head_weights_at(const PersonFrame& frame, const Vec3& p);

/// Appends the four largest, which sum to 1.
void append_weights(SkinWeights& skin, const JointWeights& weights);

}  // namespace limn

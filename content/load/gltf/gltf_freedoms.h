#pragma once

#include "content/load/gltf/gltf_document.h"
#include "content/load/gltf/gltf_scene.h"

#include <cstdint>

namespace limn {

// Limits of joints, which glTF has no place for: nodes[i].extras.jointLimits is a list of at most
// three objects with `axis`, in the joint's space, `min`, `max`, `middle` [rad] and `stiffness`, as
// in JointFreedom.

/// The freedoms of a joint; empty: none.
[[nodiscard]] tinygltf::Value::Array
write_joint_limits(const SkeletonData& skeleton, std::uint16_t joint);

/// Adds those of all nodes that are joints to the scene's skeleton. What is not a range about an
/// axis is left out with a warning.
void read_joint_limits(GltfDocument& document, GltfScene& scene);

}  // namespace limn

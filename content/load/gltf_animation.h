#pragma once

#include "content/load/gltf_document.h"
#include "content/load/gltf_scene.h"

namespace limn {

/// Fills the skeleton of `scene`, its skins and its clips, from the nodes that are there already
/// (gltf_node.h). Joint 0 is the scene itself; the others are the nodes that a skin or an animation
/// names, and those above them, parents first. Who only has moving morph weights is no joint.
///
/// Channels of an animation with the same times and interpolation become one sheet. Rotations are
/// made unit, each near the key before it. Left out, with a warning: what glTF cannot animate, and
/// weights of a node without morph targets. Fails when a sampler has no fitting number of values,
/// times do not grow, a rotation has length 0, two channels move the same, a joint is in no scene,
/// or a matrix of a skin has no inverse.
[[nodiscard]] Status build_animations(GltfDocument& document, GltfScene& scene);

}  // namespace limn

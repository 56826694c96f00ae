#pragma once

#include "content/load/gltf_document.h"
#include "content/load/gltf_scene.h"

#include <vector>

namespace limn {

/// For each mesh of the file the parts that draw it.
using GltfParts = std::vector<std::vector<GltfPart>>;

/// Fills `scene.nodes` with the nodes of the file's scene, parents first, with their cameras and
/// lights, and `scene.morph_weights`. Fails when the graph has a cycle, a node with two parents or
/// is too deep, and when a node has not as many weights as its mesh has morph targets.
///
/// A skinned mesh stands where its joints put it: in a node of its own, without a parent and behind
/// the others.
[[nodiscard]] Status build_nodes(GltfDocument& document, const GltfParts& parts, GltfScene& scene);

}  // namespace limn

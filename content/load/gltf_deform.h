#pragma once

#include "content/load/gltf_document.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// What moves the vertices of a primitive: joints and morph targets.

/// A primitive and those of its vertices that are kept, as numbers in its accessors.
struct GltfVertices {
    const tinygltf::Primitive& primitive;
    std::string place;  ///< "file: meshes[2].primitives[0]"
    std::size_t count;  ///< elements of each attribute
    std::span<const std::uint32_t> used;
};

/// JOINTS_n and WEIGHTS_n of all n; empty when the file has none. Weights of 0 are dropped, those
/// of a joint that is named twice are added, and all are made to sum to 1: where they were off by
/// more than 1e-3 a warning says so. A vertex without any weight follows the first joint, with a
/// warning. Fails at a joint that is not below `joints`, at a negative weight and where one of the
/// two attributes is missing.
[[nodiscard]] Result<SkinWeights>
read_skin_weights(GltfDocument& document, const GltfVertices& vertices, std::size_t joints);

/// The targets of the primitive, with the vertices that move; `names` may be shorter than the list.
[[nodiscard]] Result<std::vector<MorphTarget>> read_morph_targets(
    GltfDocument& document, const GltfVertices& vertices, const std::vector<std::string>& names);

}  // namespace limn

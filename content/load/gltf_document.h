#pragma once

#include "content/load/gltf_load.h"
#include "content/load/json_document.h"

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace limn {

/// Weights of the morph targets of one node: places in GltfScene::morph_weights.
struct GltfMorphs {
    std::int32_t first = -1;
    std::size_t count = 0;
};

/// A glTF file on its way into a GltfScene. Everything the model says has the right type, and every
/// index in it is in range (gltf_schema.h); every buffer view lies within its buffer.
struct GltfDocument {
    std::string file;    ///< what messages begin with
    std::string folder;  ///< for images
    GltfLimits limits;
    JsonValue json;         ///< for what tinygltf does not keep: extras, images
    tinygltf::Model model;  ///< without buffers, images and animations
    std::vector<std::vector<std::byte>> buffers;  ///< by the index of the file
    std::uint64_t values_left = 0;                ///< of limits.max_values
    std::vector<std::int32_t>
        scene_nodes;                      ///< node of the file -> of the scene, -1; by build_nodes
    std::vector<GltfMorphs> node_morphs;  ///< of each node of the file; by build_nodes
    std::vector<std::string> warnings;
};

/// Reads container, JSON and buffers; images come with the materials (gltf_material.h).
[[nodiscard]] Result<GltfDocument> open_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits);

/// The bytes of buffer view `index`.
[[nodiscard]] std::span<const std::byte>
view_bytes(const GltfDocument& document, std::size_t index);

/// Item `index` of the array `array` of the JSON; it exists.
[[nodiscard]] const JsonValue&
json_item(const GltfDocument& document, std::string_view array, std::size_t index);

}  // namespace limn

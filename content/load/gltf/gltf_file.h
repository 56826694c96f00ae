#pragma once

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_document.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// glTF files are parsed and written by tinygltf. It is lenient where we want a message, and
// stricter than existing files: its limitations are worked around in gltf_file.cpp, and listed
// there.

/// The chunks of a GLB, or a .gltf as JSON only; views into the file's bytes.
struct GltfChunks {
    std::string_view json;
    std::span<const std::byte> binary;
    bool has_binary = false;
    std::size_t trailing = 0;  ///< bytes after the GLB, ignored
};

/// Fails when a GLB is truncated, has chunks longer than itself or is not version 2.
[[nodiscard]] Result<GltfChunks>
split_gltf(std::span<const std::byte> bytes, const std::string& file);

/// Reads container, JSON and buffers; images are loaded with the materials. No file is opened
/// outside of `folder`, none at all if that is "".
[[nodiscard]] Result<GltfDocument> open_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits);

/// The number of a new view of these bytes, which are appended to the first buffer.
int append_view(tinygltf::Model& model, std::span<const std::byte> bytes);

/// The number of a new accessor of type TINYGLTF_TYPE_..., with these values if there are any.
int append_accessor(
    tinygltf::Model& model, int type, int component, std::size_t count,
    std::span<const std::byte> values);

/// Sets the smallest and largest value of increasing times, as glTF requires.
int append_times(tinygltf::Model& model, std::span<const float> times);

void append_channel(
    tinygltf::Animation& animation, int node, const char* path, int times, int values);

/// A .glb of these two chunks; the second has a multiple of four bytes, or none.
[[nodiscard]] Result<std::vector<std::byte>>
pack_json(const JsonValue& json, std::span<const std::byte> binary, const std::string& name);

/// The bytes of a .glb; the first buffer is its binary chunk. `name` is the prefix of messages.
[[nodiscard]] Result<std::vector<std::byte>>
pack_model(const tinygltf::Model& model, const std::string& name);

}  // namespace limn

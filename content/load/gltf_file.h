#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The outside of a glTF file: the GLB container, and URIs, which lead to base64 text or to files
// under one folder and nowhere else.

/// A GLB taken apart, or a .gltf as JSON alone; views into the file's bytes.
struct GltfChunks {
    std::string_view json;
    std::span<const std::byte> binary;
    bool has_binary = false;
};

/// Fails when a GLB is cut short, its lengths disagree or it is not version 2.
[[nodiscard]] Result<GltfChunks>
split_gltf(std::span<const std::byte> bytes, const std::string& file);

/// The bytes that `uri` stands for: those of a data: URI, or of a file under `folder`. Refused are
/// schemes, absolute paths, "..", symbolic links out of the folder, and files at all when `folder`
/// is "".
[[nodiscard]] Result<std::vector<std::byte>> fetch_uri(
    const std::string& uri, const std::string& folder, const std::string& place,
    std::uint64_t max_bytes);

}  // namespace limn

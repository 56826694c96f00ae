#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The container of a glTF file: GLB chunks, and URIs, which may be data or files under one folder
// and nothing else.

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

/// The bytes of a data: URI, or of a file under `folder`. Rejects other schemes, absolute paths,
/// "..", symbolic links out of the folder, and all files when `folder` is "".
[[nodiscard]] Result<std::vector<std::byte>> fetch_uri(
    const std::string& uri, const std::string& folder, const std::string& place,
    std::uint64_t max_bytes);

}  // namespace limn

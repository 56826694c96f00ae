#pragma once

#include "content/load/gltf_document.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Numbers out of buffers. An accessor may have any component type, a stride, normalized integers,
// no buffer view (zeros) and sparse replacements; its extent is computed with 64 bits and compared
// with its view before a byte is read. What all accessors of a file give together is limited,
// because a small file can name the same bytes a million times.

/// All elements of accessor `index`, one after another; integers become floats, normalized ones 0
/// .. 1 or -1 .. 1. Fails unless it has `components` numbers an element and all are finite.
[[nodiscard]] Result<std::vector<float>>
read_floats(GltfDocument& document, int index, int components, const std::string& place);

/// The elements of accessor `index`, which must be unsigned integers, one number each.
[[nodiscard]] Result<std::vector<std::uint32_t>>
read_indices(GltfDocument& document, int index, const std::string& place);

/// Numbers an element of accessor `index` has: 3 for VEC3.
[[nodiscard]] int component_count(const GltfDocument& document, int index);

}  // namespace limn

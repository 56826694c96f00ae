#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace limn {

struct ImageData;
struct ImageLimits;

// DDS files of one two-dimensional image in blocks, BC5 or BC7, with mip levels. Others are
// refused: volumes, cubes, arrays and all other formats. After Microsoft, "Programming Guide for
// DDS": DDS_HEADER, and DDS_HEADER_DXT10 for BC7; BC5 may have the older codes ATI2 and BC5U.

[[nodiscard]] bool is_dds_file(std::span<const std::byte> bytes);

/// Reads an untrusted file; ImageData::srgb is what the file says. `location` is the prefix of
/// messages. Fails with "location: found X, expected Y". Bytes after the last level are ignored.
[[nodiscard]] Result<ImageData> decode_dds(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits);

/// The bytes of a file. `image` must be complete and in blocks.
[[nodiscard]] std::vector<std::byte> encode_dds(const ImageData& image);

}  // namespace limn

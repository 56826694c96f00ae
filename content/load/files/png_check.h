#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

// Checks the integrity of a PNG file before libpng reads it, since libpng prints errors to stderr
// and accepts truncated files. Checks the chain of chunks from IHDR to IEND, their lengths and
// checksums, not their contents.

/// CRC-32 of PNG and zlib (polynomial 0xedb88320).
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::byte> bytes);

/// Fails with "location: ..." when `bytes` is truncated, corrupt or not a PNG.
[[nodiscard]] Status check_png(std::span<const std::byte> bytes, const std::string& location);

}  // namespace limn

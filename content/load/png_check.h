#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

// Is this PNG whole? Looked at before libpng sees it, since libpng reports damage on stderr by
// itself and takes a picture without its end. Checks the chain of chunks from IHDR to IEND, their
// lengths and their checksums; not what is in them.

/// CRC-32 of PNG and zlib (polynomial 0xedb88320).
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::byte> bytes);

/// Fails with "place: ..." when `bytes` is cut short, damaged or not a PNG at all.
[[nodiscard]] Status check_png(std::span<const std::byte> bytes, const std::string& place);

}  // namespace limn

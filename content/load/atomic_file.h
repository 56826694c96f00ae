#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Files come into being whole: bytes go to a file without a name (O_TMPFILE), are flushed, and get
// their name in one step, so that a program stopped at any moment leaves the old file or the new
// one and no half of either. Where the file system has no nameless files, or when an old file must
// be replaced, the bytes take their name from a hidden neighbor `.<name>.<process>.partial`; only a
// kill in that case can leave the neighbor behind.

/// Writes `bytes` as the file `path`, replacing what was there. Fails with "path: why" when the
/// folder does not exist, is not writable, or the disk is full; then nothing has changed.
[[nodiscard]] Status write_file(const std::string& path, std::span<const std::byte> bytes);

/// The same for text.
[[nodiscard]] Status write_file(const std::string& path, const std::string& text);

/// All of a regular file. Fails with "path: found X, expected Y" when it does not exist, is a
/// folder or a device, or is larger than `max_size` bytes.
[[nodiscard]] Result<std::vector<std::byte>>
read_file(const std::string& path, std::uint64_t max_size = std::uint64_t{1} << 31);

}  // namespace limn

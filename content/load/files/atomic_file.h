#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Atomic file writes: bytes go to an unnamed file (O_TMPFILE), are flushed, and the file is linked
// to its name in one step, so that a program stopped at any time leaves either the old file or the
// complete new one. Where the file system has no O_TMPFILE, or when an existing file is replaced, a
// hidden file `.<name>.<process>.partial` in the same folder is renamed instead; only a kill in
// that case can leave it behind.

/// Writes `bytes` as the file `path`, replacing what was there. Fails with "path: why" when the
/// folder does not exist, is not writable, or the disk is full; then nothing is changed.
[[nodiscard]] Status write_file(const std::string& path, std::span<const std::byte> bytes);

/// The same for text.
[[nodiscard]] Status write_file(const std::string& path, const std::string& text);

/// " (did you mean Fox.glb?)" with the nearest name in the folder of `path`, or "".
[[nodiscard]] std::string file_suggestion(const std::string& path);

/// Reads a whole regular file. Fails with "path: found X, expected Y" when it does not exist, is a
/// folder or a device, or is larger than `max_size` bytes.
[[nodiscard]] Result<std::vector<std::byte>>
read_file(const std::string& path, std::uint64_t max_size = std::uint64_t{1} << 31);

/// Lists the files that read_file reads, on any thread, while it exists; one at a time.
class ReadRecorder {
  public:
    ReadRecorder();
    ReadRecorder(const ReadRecorder&) = delete;
    ReadRecorder& operator=(const ReadRecorder&) = delete;
    ~ReadRecorder();
    /// As they were given to read_file, in any order.
    [[nodiscard]] std::vector<std::string> paths() const;
};

}  // namespace limn

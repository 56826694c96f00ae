#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <string>

namespace limn {

/// What a rendered image holds, decoded whole.
struct FrameFile {
    IVec2 size = {0, 0};       ///< pixels
    std::uint64_t pixels = 0;  ///< hash of all values: a PNG's bytes, or all channels of an EXR
};

/// Decodes a PNG, or an EXR with all of its layers. Fails with "path: found X, expected Y" unless
/// it is whole and of that size.
[[nodiscard]] Result<FrameFile> read_frame_file(const std::string& path, const IVec2& size);

/// Decodes a JSON file that a task wrote; its text is what is hashed.
[[nodiscard]] Result<FrameFile> read_task_file(const std::string& path);

}  // namespace limn

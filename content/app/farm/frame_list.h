#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Lists of frames: "0:99", "0:99:10" (every tenth), "7", and several of these with commas between.

/// Frames in rising order, each once; 0 .. kMaxFrames - 1. Fails with what was found and expected.
[[nodiscard]] Result<std::vector<int>> parse_frame_list(std::string_view text);

/// The shortest text that parse_frame_list reads as these frames (rising, each once).
[[nodiscard]] std::string write_frame_list(const std::vector<int>& frames);

/// Which frames are rendered first.
enum class FrameOrder {
    Plain,    ///< rising
    Preview,  ///< every 16th, on a grid from the first, then the rest
};

/// The frames in chunks of at most `size`, in the order in which they are to be rendered; frames
/// within a chunk rise.
[[nodiscard]] std::vector<std::vector<int>>
make_chunks(const std::vector<int>& frames, int size, FrameOrder order);

}  // namespace limn

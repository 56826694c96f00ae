#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

struct RenderOptions;

/// What the pixels of frames depend on, a line of "name: value" each: program version, scene and a
/// hash of its file, size, rate and all other options. Two renders with the same text are the same.
[[nodiscard]] std::string describe_render(const RenderOptions& options);

/// Writes the text beside frames, as the file `path`; where one is there already, fails unless it
/// is the same, with the first line that differs.
[[nodiscard]] Status claim_frames(const std::string& path, const std::string& description);

}  // namespace limn

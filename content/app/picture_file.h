#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

struct FrameOutput;

// What the renderer drew, as files: PNG for eyes, EXR for numbers. Both appear whole or not at all.

enum class PictureKind : std::uint8_t { Png, Exr };

/// By the end of the name, ".png" or ".exr" in any case; others are an error that says so.
[[nodiscard]] Result<PictureKind> picture_kind(std::string_view path);

/// Whether the name has a place for the number of a frame: exactly one "%d" or "%0Nd", N = 1 .. 9.
/// Any other '%' is an error.
[[nodiscard]] Result<bool> has_frame_number(std::string_view path);

/// "frame_%04d.png" and 7 -> "frame_0007.png"; a name without a place is returned as it is.
[[nodiscard]] std::string numbered_path(std::string_view path, int frame);

/// Text attributes of an EXR: name, value.
using PictureNotes = std::vector<std::pair<std::string, std::string>>;

/// PNG: the display's sRGB bytes. EXR: linear radiance as R, G, B, A and every AOV of `frame` as a
/// layer: depth.Z, normal.X ... albedo.R ... velocity.X ... emission.R ..., all as 32-bit floats.
[[nodiscard]] Status
write_picture(const std::string& path, const FrameOutput& frame, const PictureNotes& notes = {});

}  // namespace limn

#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

struct FrameOutput;

// Writes rendered frames to files: PNG as displayed, EXR with linear radiance. Files are written
// atomically.

enum class ImageFileKind : std::uint8_t { Png, Exr };

/// Whether the name ends in `extension`, ".png" in small letters, in any case; a name that is
/// nothing else does not.
[[nodiscard]] bool has_extension(std::string_view path, std::string_view extension);

/// By the file name's extension, ".png" or ".exr" in any case; any other is an error.
[[nodiscard]] Result<ImageFileKind> image_file_kind(std::string_view path);

/// Whether the name has a placeholder for the frame number: exactly one "%d" or "%0Nd", N = 1 .. 9.
/// Any other '%' is an error.
[[nodiscard]] Result<bool> has_frame_number(std::string_view path);

/// "frame_%04d.png" and 7 -> "frame_0007.png"; a name without a placeholder is returned unchanged.
[[nodiscard]] std::string numbered_path(std::string_view path, int frame);

/// Text attributes of an EXR, as pairs of name and value.
using ImageAttributes = std::vector<std::pair<std::string, std::string>>;

/// PNG: the display's sRGB bytes. EXR: linear radiance as R, G, B, A and every AOV of `frame` as a
/// layer: depth.Z, normal.X ... albedo.R ... velocity.X ... emission.R ..., all as 32-bit floats.
[[nodiscard]] Status write_image_file(
    const std::string& path, const FrameOutput& frame, const ImageAttributes& notes = {});

}  // namespace limn

#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device_caps.h"
#include "render/render_frame.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Strict parsers of option values: "640x360" is accepted; "640x", "640x360x2", "nan" and "1e999"
// are not. Every error says what was found and what was expected.

/// First and last frame of a range, both drawn.
struct FrameRange {
    int first = 0;
    int last = 0;  ///< >= first
    bool operator==(const FrameRange&) const = default;
};

/// `path=value` of --set.
struct Assignment {
    std::string path;   ///< "lamp.point_light.intensity" or "exposure.ev"
    std::string value;  ///< JSON, or a bare word
};

inline constexpr int kMaxImageSide = 16384;      ///< pixels
inline constexpr int kMaxImagePixels = 1 << 26;  ///< 1 GiB as RGBA32F
inline constexpr int kMaxFrames = 1'000'000;

/// "1280x720": width and height, each 1 .. kMaxImageSide, together at most
/// kMaxImagePixels.
[[nodiscard]] Result<IVec2> parse_size(std::string_view text);

/// "A:B" with 0 <= A <= B < kMaxFrames, or "A" for one frame.
[[nodiscard]] Result<FrameRange> parse_frame_range(std::string_view text);

/// An integer from `min` to `max`, without trailing text.
[[nodiscard]] Result<std::int64_t>
parse_integer(std::string_view text, std::int64_t min, std::int64_t max);

/// A decimal number from `min` to `max`; never NaN.
[[nodiscard]] Result<double> parse_number(std::string_view text, double min, double max);

/// "path=value"; neither may be empty.
[[nodiscard]] Result<Assignment> parse_assignment(std::string_view text);

/// The parts between the commas; an empty part is an error.
[[nodiscard]] Result<std::vector<std::string>> parse_list(std::string_view text);

/// "gpu" or "software".
[[nodiscard]] Result<gpu::Profile> parse_profile(std::string_view text);

/// "light" or "displayed".
[[nodiscard]] Result<SampleMean> parse_average(std::string_view text);

/// A message without line breaks.
[[nodiscard]] std::string one_line(std::string text);

/// A message of one or several lines without other control characters, which a terminal would obey.
[[nodiscard]] std::string printable_lines(std::string text);

}  // namespace limn

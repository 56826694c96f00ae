#pragma once

#include <cmath>

namespace limn {

/// One sRGB component 0 .. 1 to linear, IEC 61966-2-1.
[[nodiscard]] inline float linear_from_srgb(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

}  // namespace limn

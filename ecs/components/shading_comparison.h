#pragma once

#include "ecs/components/rendering.h"

namespace limn {

/// What a comparison of two methods of shading shows.
enum class ComparisonImage : std::uint8_t {
    Split,       ///< one method left of the divider, the other right of it
    Difference,  ///< of the two, per channel
};

/// Resource: every opaque surface is lit twice, by `rendering.shading` and by `right`, and the two
/// are compared. Absent: one method alone.
struct ShadingComparison {
    ShadingRate right = ShadingRate::Pixel;
    ComparisonImage image = ComparisonImage::Split;
    float divider = 0.5f;
    float gain = 1.0f;
    float exponent = 0.1f;
};

LIMN_FIELDS(ShadingComparison) {
    LIMN_FIELD(
        right, .doc = "shading right of the divider; left of it: rendering.shading",
        .values = kShadingRateNames);
    LIMN_FIELD(
        image, .doc = "both methods side by side, or their difference",
        .values = "split difference");
    LIMN_FIELD(
        divider, "position between the left (0) and right (1) border of the image", "", 0, 1);
    LIMN_FIELD(gain, "factor of differences", "", 0, 1000);
    LIMN_FIELD(
        exponent,
        "differences of 0 .. 1 are displayed as their power; 0.1: one step of 255 as 0.57", "",
        0.01, 10);
}

/// Resource: plots the brightness of one row of the image, (r + g + b) / 3 with each channel
/// clamped to 0 .. 1, across its lower part; of both methods where two are compared.
struct ScanlinePlot {
    float row = 0.55f;
    float height = 0.24f;
};

LIMN_FIELDS(ScanlinePlot) {
    LIMN_FIELD(row, "between the lower (0) and upper (1) border of the image", "", 0, 1);
    LIMN_FIELD(height, "of the plot / of the image; 0 = no plot", "", 0, 1);
}

}  // namespace limn

#pragma once

#include "content/make/patterns/patterns.h"

#include <vector>

namespace limn {

/// An ellipse of one channel.
struct MaskRegion {
    int channel = 0;
    Vec2 at = {0.5f, 0.5f};
    Vec2 radius = {0.2f, 0.2f};
};

LIMN_FIELDS(MaskRegion) {
    LIMN_FIELD(channel, "0 red, 1 green, 2 blue, 3 opacity", "", 0, 3);
    LIMN_FIELD(at, "center: u to the right, v down", "", 0, 1);
    LIMN_FIELD(radius, "along u and v", "", 1e-3, 2);
}

/// Masks of up to four regions of a surface, one per channel, as used by wrinkle_maps: the base
/// color is linear. Overlapping soft borders are scaled down so that their sum is at most 1.
struct MasksPattern {
    PatternSize image;
    std::vector<MaskRegion> regions = {
        {0, {0.25f, 0.25f}}, {1, {0.75f, 0.25f}}, {2, {0.25f, 0.75f}}, {3, {0.75f, 0.75f}}};
    float softness = 0.5f;
    float wander = 0.2f;
};

LIMN_FIELDS(MasksPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(regions, "ellipses; those of the same channel add up");
    LIMN_FIELD(softness, "width of their borders, inwards / radius", "", 0.01, 1);
    LIMN_FIELD(wander, "irregularity of their borders / radius", "", 0, 1);
}

[[nodiscard]] PatternMaps make_masks(const MasksPattern& pattern);

}  // namespace limn

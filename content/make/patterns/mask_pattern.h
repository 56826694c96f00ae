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

/// Where up to four regions of a surface are, a channel each, as wrinkle_maps uses them: its base
/// color is linear. Where soft borders overlap all are dimmed so that their sum is at most 1.
struct MasksPattern {
    PatternSize image;
    std::vector<MaskRegion> regions = {
        {0, {0.25f, 0.25f}}, {1, {0.75f, 0.25f}}, {2, {0.25f, 0.75f}}, {3, {0.75f, 0.75f}}};
    float softness = 0.5f;
    float wander = 0.2f;
};

LIMN_FIELDS(MasksPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(regions, "ellipses; those of one channel add up");
    LIMN_FIELD(softness, "width of their borders, inwards, as a share of the radius", "", 0.01, 1);
    LIMN_FIELD(wander, "of their borders, as a share of the radius", "", 0, 1);
}

[[nodiscard]] PatternMaps make_masks(const MasksPattern& pattern);

}  // namespace limn

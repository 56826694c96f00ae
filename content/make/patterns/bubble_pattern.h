#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Air bubbles in water, a different one per frame: clear in the center; beyond 3/4 of the radius,
/// the inverse of the index of refraction, a ring of total reflection (Marston 1979). It is bright
/// where it reflects the sky above; y upwards.
struct BubblePattern {
    PatternSize image;
    int frames = 4;
    float flatness = 0.2f;
};

LIMN_FIELDS(BubblePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(flatness, "largest flattening: 1 - height / width", "", 0, 0.6);
}

[[nodiscard]] PatternMaps make_bubble(const BubblePattern& pattern);

}  // namespace limn

#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Air bubbles in water, each frame another one: clear in the middle; beyond 3/4 of the radius, the
/// inverse of the index of refraction, a ring of total reflection (Marston 1979). It is bright
/// where it shows what is above. Lit by a sky that is overhead; y upwards.
struct BubblePattern {
    PatternSize image;
    int frames = 4;
    float flatness = 0.2f;
};

LIMN_FIELDS(BubblePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(flatness, "by how much they are lower than wide, at most", "", 0, 0.6);
}

[[nodiscard]] PatternMaps make_bubble(const BubblePattern& pattern);

}  // namespace limn

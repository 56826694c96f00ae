#pragma once

#include "content/make/patterns.h"

namespace limn {

// Flipbooks for particles: `frames` x `frames` white images whose opacity is the shape, in order
// from the top left. Every frame is transparent at its border.

/// A puff that swirls and frays.
struct SmokePattern {
    PatternSize image;
    int frames = 4;
    float detail = 0.7f;
};

LIMN_FIELDS(SmokePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(detail, "share of the opacity that varies within", "", 0, 1);
}

/// A tongue of fire that rises and breaks apart.
struct FlamePattern {
    PatternSize image;
    int frames = 4;
    float detail = 0.8f;
};

LIMN_FIELDS(FlamePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(detail, "share of the opacity that varies within", "", 0, 1);
}

[[nodiscard]] PatternMaps make_smoke(const SmokePattern& pattern);
[[nodiscard]] PatternMaps make_flame(const FlamePattern& pattern);

}  // namespace limn

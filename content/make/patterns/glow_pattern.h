#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Light that spreads in air and lens around what is too small and too bright to see: brightest in
/// the middle and without a rim. The intensity is the product of color and opacity, which are
/// equal, so that eight bits of each hold the faint parts too: for particles that only add light
/// (`cover` 0).
struct GlowPattern {
    PatternSize image;
    int frames = 1;
    float core = 0.06f;
    float rays = 0.3f;
};

LIMN_FIELDS(GlowPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other, each with other rays", "", 1, 16);
    LIMN_FIELD(core, "radius at half the intensity, as a share of half the frame", "", 0.01, 0.5);
    LIMN_FIELD(rays, "share of the light in rays out of the middle", "", 0, 1);
}

[[nodiscard]] PatternMaps make_glow(const GlowPattern& pattern);

}  // namespace limn

#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Glow in air and lens around a source that is too small and bright to resolve: brightest in
/// the center and without a rim. The intensity is the product of color and opacity, which are
/// equal, so that eight bits of each resolve the faint parts too: for additive particles (`cover`
/// 0).
struct GlowPattern {
    PatternSize image;
    int frames = 1;
    float core = 0.06f;
    float rays = 0.3f;
};

LIMN_FIELDS(GlowPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image, each with different rays", "", 1, 16);
    LIMN_FIELD(core, "radius at half the intensity, in half frames", "", 0.01, 0.5);
    LIMN_FIELD(rays, "fraction of the light in rays from the center", "", 0, 1);
}

[[nodiscard]] PatternMaps make_glow(const GlowPattern& pattern);

}  // namespace limn

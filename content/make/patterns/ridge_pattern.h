#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Wooded hills on the horizon, crest behind crest, for a cylindrical PanoramaLayer: the horizon is
/// the middle row. Opacity is the transmittance of the air in front of a crest, so that the sky's
/// own light takes the place of what is lost: distant crests fade to the color of the sky behind.
struct RidgePattern {
    PatternSize image = {.size = 1024};
    float aspect = 5.0f;
    int crests = 5;
    float height = 0.8f;
    float air = 0.7f;
    Vec3 color = {0.022f, 0.034f, 0.016f};
    Vec3 bare_color = {0.075f, 0.078f, 0.042f};
    float wooded = 0.62f;
};

LIMN_FIELDS(RidgePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(
        aspect,
        "angle that the image spans around the horizon / angle from its lower to its upper edge",
        "", 0.1, 100);
    LIMN_FIELD(crests, "how many, from the farthest to the nearest", "", 1, 12);
    LIMN_FIELD(
        height, "of the farthest crest above the horizon, in half image heights", "", 0.05, 1);
    LIMN_FIELD(air, "fraction of the light of the farthest crest that the air takes", "", 0, 1);
    LIMN_FIELD(color, .doc = "radiance of woods", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(
        bare_color, .doc = "radiance of meadows and rock", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(wooded, "fraction of the slopes", "", 0, 1);
}

[[nodiscard]] PatternMaps make_ridges(const RidgePattern& pattern);

}  // namespace limn

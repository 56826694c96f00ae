#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: post.glare-heat-haze

/// Resource: star-shaped streaks around highlights, as from diffraction at the straight edges of
/// aperture blades. None if absent or of strength 0.
struct Glare {
    float strength = 0.05f;
    float threshold = 1.0f;
    int blades = 6;
    float length = 0.2f;
    float rotation = 0.3f;

    bool operator==(const Glare&) const = default;
};

LIMN_FIELDS(Glare) {
    LIMN_FIELD(strength, "fraction of the light above the threshold that is added", "", 0, 10);
    LIMN_FIELD(threshold, "luminance above which pixels cause streaks", "", 0, 65504);
    LIMN_FIELD(blades, "aperture blades; even: as many streaks, odd: twice as many", "", 3, 16);
    LIMN_FIELD(
        length, "length of a streak to either side, as a fraction of the image height", "", 0.005,
        2);
    LIMN_FIELD(rotation, "rotation of the aperture", "rad");
}

}  // namespace limn

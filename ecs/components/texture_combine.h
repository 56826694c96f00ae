#pragma once

#include "ecs/components/surface.h"

namespace limn {

// Techniques: tex.combine

/// Two scrolling copies of a water texture under a grating, rendered into an image before each
/// frame (tex.combine); materials that use that image show it. Textures repeat; the grating covers
/// the water where its alpha is 0.
struct TextureCombine {
    ImageId water = {};
    ImageId grating = {};
    ImageId target = {};  ///< rendered to; keeps its size and format
    Vec2 speed = {0.05f, 0.05f};
    float gain = 0.5f;
};

LIMN_FIELDS(TextureCombine) {
    LIMN_FIELD(water, "water texture, scrolled in two directions");
    LIMN_FIELD(grating, "texture that covers the water where its alpha is 0");
    LIMN_FIELD(target, "image to render to");
    LIMN_FIELD(speed, "speed of one copy along u and of the other along v", "1/s", -100, 100);
    LIMN_FIELD(gain, "factor on the sum of both copies", "", 0, 2);
}

}  // namespace limn

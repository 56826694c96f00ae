#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: shadow.projector

/// Cookie (projected texture) of the spot or directional light on the same entity: the light's
/// color is multiplied by the image, and there is no light beyond the image's edges. From the
/// light, the image is upright along the entity's +y. An animation is a grid of frames in one image
/// (flipbook), row by row from the top left.
struct Projector {
    ImageId image = {};
    float width = radians(40.0f);
    float aspect = 1.0f;
    int columns = 1;
    int rows = 1;
    int frames = 1;  ///< of the animation, <= columns * rows
    float fps = 24.0f;
    float start = 0.0f;
    bool loop = true;  ///< restarts after the last frame; otherwise holds it
};

LIMN_FIELDS(Projector) {
    LIMN_FIELD(image, "projected image, by name");
    LIMN_FIELD(
        width, "width of the image: angle of a spot light, meters for a directional light", "rad",
        0.001, 1000);
    LIMN_FIELD(aspect, "width / height of a frame", "", 0.01, 100);
    LIMN_FIELD(columns, "frames per row of the image", "", 1, 64);
    LIMN_FIELD(rows, "rows of frames in the image", "", 1, 64);
    LIMN_FIELD(frames, "frames of the animation", "", 1, 4096);
    LIMN_FIELD(fps, "frames per second", "1/s", 0, 1000);
    LIMN_FIELD(start, "time of frame 0", "s");
    LIMN_FIELD(loop, "restarts after the last frame");
}

}  // namespace limn

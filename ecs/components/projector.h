#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

/// The spot or directional light beside it throws an image, like a slide or movie projector: its
/// color is multiplied by that of the image, and there is no light beyond the image's edges. The
/// image stands upright to the entity's +y, seen from the light. A film is a grid of frames in one
/// image, row by row from the top left.
struct Projector {
    ImageId image = {};
    float width = radians(40.0f);  ///< of a spot: angle [rad]; of a directional light: [m]; > 0
    float aspect = 1.0f;           ///< width / height of a frame, > 0
    int columns = 1;               ///< frames side by side in the image, 1 .. 64
    int rows = 1;                  ///< and below each other
    int frames = 1;                ///< of the film, <= columns * rows
    float fps = 24.0f;             ///< frames a second, >= 0
    float start = 0.0f;            ///< time of frame 0 [s]
    bool loop = true;              ///< begins again after the last frame; else that stays
};

template <typename Visitor>
void visit_fields(Projector& projector, Visitor&& visit) {
    visit("image", projector.image, {.doc = "what is thrown, by name"});
    visit(
        "width", projector.width,
        {.doc = "of the image: of a spot light its angle, of a directional light meters",
         .unit = "rad",
         .min = 0.001,
         .max = 1000});
    visit(
        "aspect", projector.aspect,
        {.doc = "width over height of a frame", .min = 0.01, .max = 100});
    visit("columns", projector.columns, {.doc = "frames side by side", .min = 1, .max = 64});
    visit("rows", projector.rows, {.doc = "frames below each other", .min = 1, .max = 64});
    visit("frames", projector.frames, {.doc = "of the film", .min = 1, .max = 4096});
    visit("fps", projector.fps, {.doc = "frames a second", .unit = "1/s", .min = 0, .max = 1000});
    visit("start", projector.start, {.doc = "time of frame 0", .unit = "s"});
    visit("loop", projector.loop, {.doc = "begins again after the last frame"});
}

}  // namespace limn

#pragma once

#include "ecs/components/surface.h"

namespace limn {

/// Water that moves two ways under a grating, drawn into an image before each picture
/// (tex.combine): whatever is made of that image shows it. Textures repeat; where the grating's
/// alpha is 0 it hides the water.
struct TextureCombine {
    ImageId water = {};
    ImageId grating = {};
    ImageId target = {};          ///< another one; keeps its size and format
    Vec2 speed = {0.05f, 0.05f};  ///< of one copy along u, of the other along v [1/s]
    float gain = 0.5f;  ///< of the sum of both: 1 as the book has it, which may be as much as 2
};

template <typename Visitor>
void visit_fields(TextureCombine& combine, Visitor&& visit) {
    visit("water", combine.water, {.doc = "moves two ways"});
    visit("grating", combine.grating, {.doc = "lies over it where its alpha is 0"});
    visit("target", combine.target, {.doc = "image that becomes both"});
    visit(
        "speed", combine.speed,
        {.doc = "of one copy along u, of the other along v",
         .unit = "1/s",
         .min = -100,
         .max = 100});
    visit("gain", combine.gain, {.doc = "of the two copies' sum", .min = 0, .max = 2});
}

}  // namespace limn

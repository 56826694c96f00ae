#pragma once

#include "ecs/reflect.h"

namespace limn {

/// Resource: what moves while the shutter is open is smeared. Absent: as if the shutter opened for
/// no time. The exposure is centered on the moment shown and lasts shutter / 360 of the time
/// between two pictures.
struct MotionBlur {
    float shutter = 180.0f;  ///< angle of a rotary shutter [deg], 0 = off, 360 = always open
    int samples = 16;      ///< along a smear, 4 .. 64; what fast things do costs no more than that
    float longest = 0.2f;  ///< smear, as a share of the picture's height; longer ones are cut
};

template <typename Visitor>
void visit_fields(MotionBlur& blur, Visitor&& visit) {
    visit(
        "shutter",
        blur.shutter,
        {.doc = "angle of a rotary shutter; 0 = no blur, 360 = open all the time",
         .unit = "deg",
         .min = 0,
         .max = 1440});
    visit("samples", blur.samples, {.doc = "along a smear", .min = 4, .max = 64});
    visit(
        "longest",
        blur.longest,
        {.doc = "smear, as a share of the picture's height; longer ones are cut",
         .min = 0.01,
         .max = 1});
}

}  // namespace limn

#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Resource: streaks about what is bright, as light takes them that is diffracted at the straight
/// edges of an aperture's blades. Absent, or of strength 0: none.
struct Glare {
    float strength = 0.05f;  ///< share of the light above the threshold that is added, 0 .. 10
    float threshold = 1.0f;  ///< luminance, >= 0
    int blades = 6;  ///< 3 .. 16; an even number makes as many streaks, an odd one twice so many
    float length = 0.2f;    ///< of a streak to either side, as a share of the picture's height
    float rotation = 0.3f;  ///< of the aperture [rad]

    bool operator==(const Glare&) const = default;
};

template <typename Visitor>
void visit_fields(Glare& glare, Visitor&& visit) {
    visit(
        "strength", glare.strength,
        {.doc = "share of the light above the threshold that is added", .min = 0, .max = 10});
    visit("threshold", glare.threshold, {.doc = "luminance above which", .min = 0, .max = 65504});
    visit(
        "blades", glare.blades,
        {.doc = "of the aperture; even: as many streaks, odd: twice as many", .min = 3, .max = 16});
    visit(
        "length", glare.length,
        {.doc = "of a streak, as a share of the picture's height", .min = 0.005, .max = 2});
    visit("rotation", glare.rotation, {.doc = "of the aperture", .unit = "rad"});
}

}  // namespace limn

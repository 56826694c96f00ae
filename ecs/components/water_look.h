#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// How much light the surface mirrors, seen from above (ecs/base/optics.h). From below, where there
/// is total reflection, it is always exact.
enum class WaterFresnel : std::uint8_t {
    Exact,    ///< the Fresnel equations
    Schlick,  ///< within 0.06 of them
    Angle,    ///< after the book: even up to 45 degrees, then a parabola; too bright by up to 0.27
};

/// What the surface mirrors, seen from above.
enum class WaterReflection : std::uint8_t {
    Picture,      ///< what the picture itself shows, else the surroundings
    Environment,  ///< the surroundings alone
    Planar,       ///< the scene drawn once more, from a camera mirrored in the surface at rest
};

/// Beside a Water: ways to draw it that are not the usual ones.
struct WaterLook {
    WaterFresnel fresnel = WaterFresnel::Exact;
    WaterReflection reflection = WaterReflection::Picture;
    float distortion = 1;    ///< of Planar: by waves, 1: as they bend it; 0: as if flat
    float map_scale = 0.5f;  ///< of Planar: side of its picture over that of the whole
};

template <typename Visitor>
void visit_fields(WaterLook& look, Visitor&& visit) {
    visit(
        "fresnel",
        look.fresnel,
        {.doc = "how much it mirrors: exactly, or by a cheap form",
         .values = "exact schlick angle"});
    visit(
        "reflection",
        look.reflection,
        {.doc = "what it mirrors: the picture, the surroundings alone, or the scene drawn again",
         .values = "picture environment planar"});
    visit(
        "distortion",
        look.distortion,
        {.doc = "of planar reflections by waves, 1: as they bend them", .min = 0, .max = 4});
    visit(
        "map_scale",
        look.map_scale,
        {.doc = "side of a planar reflection over that of the picture", .min = 0.1, .max = 1});
}

}  // namespace limn

#pragma once

#include "ecs/components/surface.h"
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

/// What is seen through the surface from above.
enum class WaterRefraction : std::uint8_t {
    Traced,   ///< what the picture shows where bent rays go
    Shifted,  ///< after the book: the picture, shifted as normals lean
    Floor,    ///< after the book: floor_map where bent rays meet the bottom, lit from above
};

/// Beside a Water: ways to draw it that are not the usual ones.
struct WaterLook {
    WaterFresnel fresnel = WaterFresnel::Exact;
    WaterReflection reflection = WaterReflection::Picture;
    WaterRefraction refraction = WaterRefraction::Traced;
    float distortion = 1;    ///< of Planar and Shifted: by waves, 1: as they bend it; 0: as if flat
    float map_scale = 0.5f;  ///< of Planar: side of its picture over that of the whole
    ImageId floor_map{};     ///< of Floor, where depth > 0; all waters share one
    float floor_tile = 2;    ///< side of a copy of it [m]
};

template <typename Visitor>
void visit_fields(WaterLook& look, Visitor&& visit) {
    visit(
        "fresnel", look.fresnel,
        {.doc = "how much it mirrors: exactly, or by a cheap form",
         .values = "exact schlick angle"});
    visit(
        "reflection", look.reflection,
        {.doc = "what it mirrors: the picture, the surroundings alone, or the scene drawn again",
         .values = "picture environment planar"});
    visit(
        "refraction", look.refraction,
        {.doc =
             "what is seen through it: along bent rays, the picture shifted, or a map of the floor",
         .values = "traced shifted floor"});
    visit(
        "distortion", look.distortion,
        {.doc = "of planar reflections and shifts by waves, 1: as they bend them",
         .min = 0,
         .max = 4});
    visit(
        "map_scale", look.map_scale,
        {.doc = "side of a planar reflection over that of the picture", .min = 0.1, .max = 1});
    visit("floor_map", look.floor_map, {.doc = "color of the bottom"});
    visit(
        "floor_tile", look.floor_tile,
        {.doc = "side of a copy of the floor's map", .unit = "m", .min = 0.01, .max = 1e4});
}

}  // namespace limn

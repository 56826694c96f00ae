#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// What glows, and how.
enum class GlowKind : std::uint8_t {
    Lens,  ///< everything by its light, as glass scatters it: no light is made or lost
    Mask,  ///< what surfaces emit themselves, blurred by 7 x 7 pixels of half the size and added
};

/// Resource: light that spreads about what is bright. Absent, or of strength 0: none. Of a lens
/// there is no threshold: every pixel gives the same share.
struct Glow {
    GlowKind kind = GlowKind::Lens;
    float strength = 0.08f;  ///< share of the light that is scattered; of a mask, added; 0 .. 1
    float radius = 0.15f;    ///< of a lens: standard deviation of the widest part, of the height
    float falloff = 2.4f;    ///< of a lens: light falls with this power of the distance, 1 .. 4
    float firefly = 100.0f;  ///< of a lens: luminance from which on lone pixels glow no more; 0 =
                             ///< no such limit
    int passes = 1;          ///< of a mask: how often it is blurred, 1 .. 16

    bool operator==(const Glow&) const = default;
};

template <typename Visitor>
void visit_fields(Glow& glow, Visitor&& visit) {
    visit(
        "kind", glow.kind,
        {.doc = "everything by its light, or what surfaces emit", .values = "lens mask"});
    visit(
        "strength", glow.strength,
        {.doc = "share of the light that is scattered; of a mask, added", .min = 0, .max = 1});
    visit(
        "radius", glow.radius,
        {.doc = "of a lens: of the widest scattering, as a share of the picture's height",
         .min = 0.001,
         .max = 1});
    visit(
        "falloff", glow.falloff,
        {.doc = "of a lens: light falls with this power of the distance", .min = 1, .max = 4});
    visit(
        "firefly", glow.firefly,
        {.doc = "of a lens: luminance from which on lone pixels glow no more; 0 = no such limit",
         .min = 0,
         .max = 65504});
    visit(
        "passes", glow.passes, {.doc = "of a mask: how often it is blurred", .min = 1, .max = 16});
}

}  // namespace limn

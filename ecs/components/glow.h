#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Kind of bloom.
enum class GlowKind : std::uint8_t {
    Lens,  ///< scattering in the lens: affects all light and conserves energy
    Mask,  ///< only emissive surfaces: blurred at half resolution by 7 x 7 pixels and added
};

/// Resource: bloom around bright pixels. None if absent or of strength 0. Lens bloom has no
/// threshold: every pixel scatters the same fraction.
struct Glow {
    GlowKind kind = GlowKind::Lens;
    float strength = 0.08f;
    float radius = 0.15f;
    float falloff = 2.4f;
    float firefly = 100.0f;
    int passes = 1;

    bool operator==(const Glow&) const = default;
};

LIMN_FIELDS(Glow) {
    LIMN_FIELD(
        kind, .doc = "scattering of all light in the lens, or only emissive surfaces",
        .values = "lens mask");
    LIMN_FIELD(
        strength, "fraction of the light that is scattered (lens) or added (mask)", "", 0, 1);
    LIMN_FIELD(
        radius, "lens: standard deviation of the widest kernel / image height", "", 0.001, 1);
    LIMN_FIELD(falloff, "lens: exponent of the fall-off with distance", "", 1, 4);
    LIMN_FIELD(
        firefly, "lens: firefly clamp, luminance limit of isolated pixels; 0 = off", "", 0, 65504);
    LIMN_FIELD(passes, "mask: number of blur passes", "", 1, 16);
}

}  // namespace limn

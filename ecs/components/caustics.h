#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// How caustics are computed.
enum class CausticMethod : std::uint8_t {
    Simulated,  ///< photons refracted by the actual surface; brightness is their density
    Pool,       ///< after the book: rays onto five planes; brightness is the water height at their
                ///< origin
};

/// With a Water: its waves focus the brightest directional light (the first of equals) onto
/// surfaces below, where objects in the water also cast shadows. Without it, light is refracted and
/// absorbed on its path down as by flat water. Optionally, reflected caustics appear on walls and
/// ceilings; for reflectors other than water see MirrorCaustic.
struct Caustics {
    CausticMethod method = CausticMethod::Simulated;
    std::int32_t resolution = 512;
    std::int32_t spacing = 2;
    float strength = 1;
    float reach = 20;
    float window = 40;
    std::int32_t cascades = 1;
    std::int32_t shaft_steps = 0;
    float mirror_reach = 0;
    std::int32_t mirror_resolution = 256;
    std::int32_t wires = 0;
};

LIMN_FIELDS(Caustics) {
    LIMN_FIELD(
        method, .doc = "photons from the actual surface, or five planes lit by its height",
        .values = "simulated pool");
    LIMN_FIELD(resolution, "side length of the map in texels, a power of two", "", 64, 1024);
    LIMN_FIELD(spacing, "distance between rays in texels", "", 1, 8);
    LIMN_FIELD(strength, "1: physical, 0: flat water", "", 0, 4);
    LIMN_FIELD(reach, "depth down to which light is traced", "m", 0.01, 1000);
    LIMN_FIELD(window, "unbounded water: side of the square about the camera", "m", 0.1, 10000);
    LIMN_FIELD(cascades, "unbounded water: number of maps, each window four times wider", "", 1, 3);
    LIMN_FIELD(
        shaft_steps, "ray-march samples per view ray under water, for light shafts; 0: off", "", 0,
        64);
    LIMN_FIELD(mirror_reach, "height up to which reflected light is traced; 0: off", "m", 0, 1000);
    LIMN_FIELD(
        mirror_resolution, "side length of the map of reflected light in texels, a power of two",
        "", 32, 1024);
    LIMN_FIELD(
        wires,
        "to look at the method: every n-th line of the grid of rays is drawn where they land; 0: "
        "none",
        "", 0, 64);
}

}  // namespace limn

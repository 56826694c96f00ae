#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// How the light that waves gather is found.
enum class CausticMethod : std::uint8_t {
    Simulated,  ///< rays bent by the true surface, as bright as they are dense
    Pool,       ///< after the book: onto five planes, as bright as the water is high where they
                ///< come from
};

/// Beside a Water: the first and brightest of the directional lights is gathered and scattered by
/// its waves on what lies below, and what stands in it throws shadows there. Without it light is
/// bent and absorbed on its way down as by flat water. On request its waves throw it up onto walls
/// and ceilings, too; of other mirrors than water, see MirrorCaustic.
struct Caustics {
    CausticMethod method = CausticMethod::Simulated;
    std::int32_t resolution = 512;  ///< texels of a side of the map, a power of two
    std::int32_t spacing = 2;       ///< texels from ray to ray
    float strength = 1;             ///< 1: as it is; 0: as flat water; a straight line between
    float reach = 20;               ///< depth down to which light is followed [m]
    float window = 40;          ///< of water without end: side of the square about the camera [m]
    std::int32_t cascades = 1;  ///< of water without end: maps, each with a window four times as
                                ///< wide as the one before
    std::int32_t shaft_steps = 0;  ///< looks along each ray of sight of a camera in the water, for
                                   ///< shafts of light; 0: none are seen
    float mirror_reach = 0;  ///< height up to which light that the water mirrors is followed [m];
                             ///< 0: none is
    std::int32_t mirror_resolution = 256;  ///< texels of a side of its map, a power of two
};

template <typename Visitor>
void visit_fields(Caustics& caustics, Visitor&& visit) {
    visit(
        "method", caustics.method,
        {.doc = "by the true surface, or onto five planes by the height",
         .values = "simulated pool"});
    visit(
        "resolution", caustics.resolution,
        {.doc = "texels of a side of the map, a power of two", .min = 64, .max = 1024});
    visit("spacing", caustics.spacing, {.doc = "texels from ray to ray", .min = 1, .max = 8});
    visit(
        "strength", caustics.strength,
        {.doc = "1: as it is; 0: as flat water", .min = 0, .max = 4});
    visit(
        "reach", caustics.reach,
        {.doc = "depth down to which light is followed", .unit = "m", .min = 0.01, .max = 1000});
    visit(
        "window", caustics.window,
        {.doc = "of water without end: side of the square about the camera",
         .unit = "m",
         .min = 0.1,
         .max = 10000});
    visit(
        "cascades", caustics.cascades,
        {.doc = "of water without end: maps, each window four times as wide as the one before",
         .min = 1,
         .max = 3});
    visit(
        "shaft_steps", caustics.shaft_steps,
        {.doc = "looks along a ray of sight under water, for shafts of light; 0: none",
         .min = 0,
         .max = 64});
    visit(
        "mirror_reach", caustics.mirror_reach,
        {.doc = "height up to which mirrored light is followed; 0: none is",
         .unit = "m",
         .min = 0,
         .max = 1000});
    visit(
        "mirror_resolution", caustics.mirror_resolution,
        {.doc = "texels of a side of the map of mirrored light, a power of two",
         .min = 32,
         .max = 1024});
}

}  // namespace limn

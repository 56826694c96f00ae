#pragma once

#include "ecs/reflect.h"

namespace limn {

// How many of its wrinkles a face draws, by its height on screen (skin.pipeline, part C). From
// close to far:
//
//     displacement   folds move the skin as well (WrinkleSurface::displacement)
//     strain         slopes where each vertex measures that skin is compressed
//     maps           only WrinkleMaps, whole regions at a time; without them, darkened slopes
//     nothing        nothing is measured, and the skin is drawn without any map of wrinkles
// Techniques: skin.pipeline

/// Heights are in pixels of an image of Rendering::level_rows.
struct WrinkleLadder {
    float displaced_from = 512;
    float strain_from = 256;
    float maps_from = 64;
    float band = 0.15f;
};

LIMN_FIELDS(WrinkleLadder) {
    LIMN_FIELD(displaced_from, "height of the mesh from which its folds displace it", "px", 0, 1e5);
    LIMN_FIELD(
        strain_from, "height from which wrinkles are where the skin is measured", "px", 0, 1e5);
    LIMN_FIELD(maps_from, "height from which there are any wrinkles", "px", 0, 1e5);
    LIMN_FIELD(
        band, "fraction of a height beyond it over which a rung fades in: none pops", "", 0, 1);
}

/// What is drawn of each rung, 0 .. 1.
struct WrinkleRungs {
    float displaced = 1;
    float strain = 1;
    float maps = 1;
};

LIMN_FIELDS(WrinkleRungs) {
    LIMN_FIELD(displaced, "factor of the displacement");
    LIMN_FIELD(strain, "factor of slopes where the skin is measured");
    LIMN_FIELD(maps, "factor of everything that is drawn");
}

}  // namespace limn

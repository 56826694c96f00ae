#pragma once

#include "content/make/patterns/patterns.h"

#include <cstdint>

namespace limn {

// Furrows on the skin of the mesh "head", grown along its folds: what an author bakes for
// skin.pipeline, part A. In each region of the head, the second field runs along the folds and the
// first across them; elsewhere both are the initial fields.

enum class HeadFurrowMap : std::uint8_t {
    Fine,        ///< furrows of both fields everywhere: normals of skin at rest
    Compressed,  ///< coarse furrows along the folds: raised by shortening across them
    Stretched,   ///< coarse furrows across the folds: raised by shortening along them
    Layers,      ///< both kinds of coarse furrows, as the two layers of a wrinkle map
};

struct HeadFurrowsPattern {
    PatternSize image = {.size = 1024};
    HeadFurrowMap map = HeadFurrowMap::Fine;
    float age = 0.3f;
    float scale = 0.5f;
    float coarse = 7;
    float depth = 1;
};

LIMN_FIELDS(HeadFurrowsPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(
        map,
        .doc = "fine: normals of skin at rest; compressed, stretched: wrinkle maps of coarse "
               "furrows along and across the folds; layers: both in one",
        .values = "fine compressed stretched layers");
    LIMN_FIELD(age, "age of the head, as there", "", 0, 1);
    LIMN_FIELD(scale, "scale of fine furrows, in an image of 1024 px", "", 0.1, 4);
    LIMN_FIELD(coarse, "how many times larger coarse furrows are", "", 1, 8);
    LIMN_FIELD(depth, "depth of furrows; 1: as in real skin", "", 0, 4);
}

/// Only its normal map is filled.
[[nodiscard]] PatternMaps make_head_furrows(const HeadFurrowsPattern& pattern);

}  // namespace limn

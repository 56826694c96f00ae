#pragma once

#include "content/make/patterns/patterns.h"

#include <cstdint>

namespace limn {

// The skin of the mesh "head" with furrows that grow where and along which its folds run: what an
// author bakes for skin.pipeline, part A. The second field runs along the folds of each region of
// the head, the first across them; elsewhere both are the initial ones.

enum class HeadFurrowMap : std::uint8_t {
    Fine,        ///< furrows of both fields everywhere: normals of skin at rest
    Compressed,  ///< coarse ones along the folds: raised by shortening across them
    Stretched,   ///< coarse ones across the folds: raised by shortening along them
    Layers,      ///< both coarse ones, as the two layers of a wrinkle map
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
    LIMN_FIELD(age, "of the head, see there", "", 0, 1);
    LIMN_FIELD(scale, "of fine furrows, in an image of 1024 px", "", 0.1, 4);
    LIMN_FIELD(coarse, "how much larger coarse ones are", "", 1, 8);
    LIMN_FIELD(depth, "1: as deep as those of skin", "", 0, 4);
}

/// Only its normals are a map.
[[nodiscard]] PatternMaps make_head_furrows(const HeadFurrowsPattern& pattern);

}  // namespace limn

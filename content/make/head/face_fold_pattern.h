#pragma once

#include "content/make/patterns/patterns.h"

#include <cstdint>

namespace limn {

/// Folds of a face as a wrinkle map for the skin of the mesh "head", and of others by face_chart.h:
/// lines of the forehead, of the glabella and the root of the nose, crow's feet, folds of the lower
/// lid, nasolabial fold, lines around the mouth and a dimpled chin. A wrinkle_surface decides where
/// they show, and how deep.
enum class FaceFoldSet : std::uint8_t {
    All,
    Stretched,   ///< those of surprise: the forehead, and the fold beside the mouth
    Compressed,  ///< those of a sour lemon: all but the forehead
};

struct FaceFoldsPattern {
    PatternSize image;
    FaceFoldSet folds = FaceFoldSet::All;
    float depth = 1;
    float wander = 0.35f;
};

LIMN_FIELDS(FaceFoldsPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(
        folds,
        .doc = "all of them, or those of one of both extremes of wrinkle_maps: surprise stretches "
               "the face below the raised brows, a sour lemon compresses it",
        .values = "all stretched compressed");
    LIMN_FIELD(depth, "depth of all folds; 1: that of a middle-aged face", "", 0, 4);
    LIMN_FIELD(wander, "irregularity of folds, sideways", "mm", 0, 5);
}

[[nodiscard]] PatternMaps make_face_folds(const FaceFoldsPattern& pattern);

}  // namespace limn

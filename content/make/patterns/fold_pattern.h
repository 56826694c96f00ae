#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Folds of skin along u: round crests separated by narrow valleys, which wander and fade out. The
/// normals are a wrinkle map.
struct FoldsPattern {
    PatternSize image;
    int count = 12;
    float depth = 0.16f;
    float wander = 0.25f;
    float breaks = 0.5f;
    float sharpness = 0.7f;
    float steepest = 1;
    Vec3 color = {0.46f, 0.27f, 0.19f};
};

LIMN_FIELDS(FoldsPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(count, "folds along v", "", 1, 256);
    LIMN_FIELD(depth, "from crest to valley / distance between folds", "", 0, 1);
    LIMN_FIELD(wander, "sideways / distance between folds", "", 0, 2);
    LIMN_FIELD(breaks, "how much folds fade out along u", "", 0, 1);
    LIMN_FIELD(sharpness, "0: a sine; 1: creases between round crests", "", 0, 1);
    LIMN_FIELD(
        steepest,
        "limit of x^2 + y^2 of the normals, which are clamped to it; the wrinkle method sphere "
        "needs 0.6",
        "", 0.01, 1);
    LIMN_FIELD(color, .doc = "of the skin", .min = 0, .max = 1, .color = true);
}

[[nodiscard]] PatternMaps make_folds(const FoldsPattern& pattern);

}  // namespace limn

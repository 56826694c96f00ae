#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Strands of hair along v, from roots at v = 0 to tips, with transparent gaps between:
/// for cards of the mesh "head", part "scalp", with the shading model hair.
struct HairPattern {
    PatternSize image;
    int count = 44;
    float width = 1.5f;
    float wander = 0.6f;
    float shortest = 0.5f;
    float variation = 0.35f;
};

LIMN_FIELDS(HairPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(count, "strands along u", "", 1, 256);
    LIMN_FIELD(width, "width of a strand at its root / distance between strands", "", 0, 4);
    LIMN_FIELD(wander, "sideways wander of strands / distance between strands", "", 0, 8);
    LIMN_FIELD(shortest, "length of the shortest strand; the longest is 1", "", 0, 1);
    LIMN_FIELD(variation, "of brightness between strands", "", 0, 1);
}

[[nodiscard]] PatternMaps make_hair(const HairPattern& pattern);

}  // namespace limn

#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// What a drop throws up where it hits, from the side: a wall that opens into jets, which tear into
/// drops that fall back (Edgerton 1954). From the first frame to the last; its foot is at a tenth
/// of the frame's height.
struct CrownPattern {
    PatternSize image;
    int frames = 4;
    int jets = 9;
};

LIMN_FIELDS(CrownPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(jets, "around it", "", 1, 32);
}

[[nodiscard]] PatternMaps make_crown(const CrownPattern& pattern);

}  // namespace limn

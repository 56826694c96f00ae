#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// The crown splash of a drop, from the side: a wall that opens into jets, which break up into
/// drops that fall back (Edgerton 1954). Plays once from the first frame to the last; its foot is
/// at a tenth of the frame's height.
struct CrownPattern {
    PatternSize image;
    int frames = 4;
    int jets = 9;
};

LIMN_FIELDS(CrownPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(jets, "number of jets", "", 1, 32);
}

[[nodiscard]] PatternMaps make_crown(const CrownPattern& pattern);

}  // namespace limn

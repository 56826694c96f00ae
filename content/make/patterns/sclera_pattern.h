#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// Vessels on the white of an eye, as a factor of its color: u from the nose outwards, v down, for
/// the part `eyes` of a head. They wind and branch from both corners towards the iris, which they
/// do not reach.
struct ScleraPattern {
    PatternSize image;
    int vessels = 26;
    float redness = 0.5f;
};

LIMN_FIELDS(ScleraPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(vessels, "number of vessels that come from each corner", "", 0, 200);
    LIMN_FIELD(redness, "how red they are, and the white at the corners", "", 0, 1);
}

[[nodiscard]] PatternMaps make_sclera(const ScleraPattern& pattern);

}  // namespace limn

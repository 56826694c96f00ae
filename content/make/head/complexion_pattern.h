#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// What makes skin uneven, as a factor of the color of the mesh "head", at most 1: blotches where
/// more blood or melanin is, pores, freckles on nose and cheeks, age spots where the sun shines on,
/// fine vessels beside the nose, and the shadow of a beard. Lids and lips have blotches only. On
/// average it adds 0.25 to the blood of the material, and 0.02 to its melanin.
struct ComplexionPattern {
    PatternSize image = {.size = 1024};
    float unevenness = 1;
    float age = 0.3f;
    float freckles = 0;
    float beard = 0;
};

LIMN_FIELDS(ComplexionPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(unevenness, "contrast of blotches and pores; 1: as of real skin", "", 0, 4);
    LIMN_FIELD(age, "0: twenty years, 1: seventy; age spots, blotches, vessels", "", 0, 1);
    LIMN_FIELD(freckles, "how many freckles", "", 0, 1);
    LIMN_FIELD(beard, "how dense the stubble is", "", 0, 1);
}

/// So are the roughness, oily on forehead and nose, and the normals: bumps of some millimeters,
/// creased where it is old.
[[nodiscard]] PatternMaps make_complexion(const ComplexionPattern& pattern);

}  // namespace limn

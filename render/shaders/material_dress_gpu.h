// Block of materials with a dress (ecs/components/dress.h).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// DressedPart. Those before kPersonOther are the texels of the block.
const uint kPersonShirt = 2u;
const uint kPersonOther = 4u;

// ClothPattern.
const int kPatternStripes = 1;
const int kPatternBands = 2;
const int kPatternChecks = 3;
const int kPatternPlaid = 4;
const int kPatternDots = 5;
const int kPatternKnit = 6;
const int kPatternTwill = 7;

struct DressBlock {
    vec4 factors[4];  // w: period of the pattern [m]
    vec4 inks[2];     // of shirt and legs; w: ClothPattern
};

#ifdef __cplusplus
static_assert(sizeof(DressBlock) == 96);
}  // namespace limn::layout
#endif

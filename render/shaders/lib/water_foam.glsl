// Foam on water: a cover that breaks up into lace as it dissolves (foam_pattern.h).

#include "water_gpu.h"

layout(binding = kFoamPatternUnit) uniform sampler2D foam_pattern;

const float kFoamTile = 6.0;  // side of the pattern [m]
const float kFoamEdge = 0.12;
const float kFoamAlbedo = 0.7;   // of thick foam; thin foam is partly transparent (Koepke 1984)
const float kThinFoam = 0.4;
const float kBubbleAlbedo = 0.3;  // of the bubbles below foam, by eye, and their depth [m]
const float kBubbleDepth = 1.5;

// White fraction of a pixel at q where foam covers `cover` of the water; `footprint`: side of the pixel [m]. Fades to
// the cover itself where the pattern is too fine to resolve.
float foam_coverage(float cover, vec2 q, float footprint) {
    float level = log2(max(footprint * float(textureSize(foam_pattern, 0).x) / kFoamTile, 1.0));
    float stays = textureLod(foam_pattern, q / kFoamTile, level).r;
    // For values uniformly distributed in 0 .. 1, the mean white fraction is the cover. Cells smaller than pixels are
    // averaged to gray.
    float edge = min(kFoamEdge, min(cover, 1.0 - cover));
    float blurred = min(0.5 * clamp(0.4 * level - 0.8, 0.0, 1.0), min(stays, 1.0 - stays));
    edge = max(max(edge, blurred), 1e-4);
    return clamp((stays - 1.0 + cover + edge) / (2.0 * edge), 0.0, 1.0);
}

// Adds the bubbles below foam to the light through the surface, `transmitted`; `falling`: irradiance over pi.
vec3 with_bubbles(vec3 transmitted, float cover, vec3 falling, vec3 extinction) {
    return mix(transmitted, kBubbleAlbedo * falling * exp(-2.0 * kBubbleDepth * extinction), cover);
}

// Adds foam on the surface.
vec3 with_foam(vec3 color, float cover, vec2 q, float footprint, vec3 falling) {
    return mix(color, kFoamAlbedo * falling, mix(kThinFoam, 1.0, cover) * foam_coverage(cover, q, footprint));
}

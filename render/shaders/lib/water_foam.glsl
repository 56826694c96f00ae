// Foam on water: a cover that breaks up into lace as it dissolves (foam_pattern.h).
// Techniques: water.whitecaps

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

#ifdef CRESTS
// Whitecaps of waves with straight crests. A point at rest is carried along by its water, and so is its foam: how much
// is left there of each moment of the last seconds follows from the waves' phases then, without any state. Only the
// first waves, which a level lists by hand, leave foam behind; all others, where the mesh resolves them, make it
// ragged.
const int kBreakingLines = 4;
const int kMoments = 8;         // with the present one
const float kMomentStep = 0.3;  // between them, in time constants
const float kFoamRange = 0.2;   // of Jacobians, from no foam to a closed cover
const float kPatchTile = 53.0;  // side of the pattern of breaking crests [m]
const float kPatchiness = 0.5;

float jacobian_of(vec2 by_x, vec2 by_z) {
    return (1.0 + by_x.x) * (1.0 + by_z.y) - by_x.y * by_z.x;
}

// Adds the derivatives of the horizontal offset by `line`, `ago` [s] before the present.
void add_drift(inout vec2 by_x, inout vec2 by_z, int line, vec2 q, float ago) {
    vec4 run = texelFetch(wave_lines, line * int(kWaveLineTexels));
    float phase = dot(run.xy, q) + texelFetch(wave_lines, line * int(kWaveLineTexels) + 1).x;
    float s = sin(phase + sqrt(9.81 * length(run.xy)) * ago);  // in deep water
    by_x -= run.x * s * run.zw;
    by_z -= run.y * s * run.zw;
}

// Cover 0 .. 1 at the point at rest at q, where `bend` is that of all waves.
float crest_foam(WaterRecord water, vec2 q, WaterBend bend) {
    float below = water.foam.x + kPatchiness * (textureLod(foam_pattern, q / kPatchTile, 3.0).r - 0.5);
    below -= water.foam.x > -1.0 ? 0.0 : 1e3;
    float cover = clamp((below - jacobian_of(bend.by_x.xz, bend.by_z.xz)) / kFoamRange, 0.0, 1.0);
    int first = int(water.waves.x);
    int count = min(int(water.waves.y), kBreakingLines);
    float fades = exp(-kMomentStep);
    float left = 1.0;
    for (int i = 0; i < kMoments; ++i) {
        vec2 by_x = vec2(0.0);
        vec2 by_z = vec2(0.0);
        for (int line = 0; line < count; ++line) {
            add_drift(by_x, by_z, first + line, q, float(i) * kMomentStep / water.foam.y);
        }
        cover = max(cover, left * clamp((below - jacobian_of(by_x, by_z)) / kFoamRange, 0.0, 1.0));
        left *= fades;
    }
    return cover;
}
#endif

// Foam on water: what covers it breaks up into lace before it is gone (foam_pattern.h).

layout(binding = 29) uniform sampler2D foam_pattern;

const float kFoamTile = 6.0;  // side of the pattern [m]
const float kFoamEdge = 0.12;
const float kFoamAlbedo = 0.7;   // of thick foam; thin foam lets some of the water through (Koepke 1984)
const float kThinFoam = 0.4;
const float kBubbleAlbedo = 0.3;  // of the bubbles below foam, by eye, and how deep they are [m]
const float kBubbleDepth = 1.5;

// Share of a pixel at q that is white, where foam covers `cover` of the water; `footprint`: side of the pixel [m].
// As far as the pattern is too fine to be seen it is the cover itself.
float foam_share(float cover, vec2 q, float footprint) {
    float level = log2(max(footprint * float(textureSize(foam_pattern, 0).x) / kFoamTile, 1.0));
    float stays = textureLod(foam_pattern, q / kFoamTile, level).r;
    // Where the values are even from 0 to 1, the mean of what is white is the cover. Cells smaller than pixels are
    // taken for a gray of both.
    float edge = min(kFoamEdge, min(cover, 1.0 - cover));
    float blurred = min(0.5 * clamp(0.4 * level - 0.8, 0.0, 1.0), min(stays, 1.0 - stays));
    edge = max(max(edge, blurred), 1e-4);
    return clamp((stays - 1.0 + cover + edge) / (2.0 * edge), 0.0, 1.0);
}

// Water as it is seen through its surface, `seen`, with the bubbles below its foam; `falling`: irradiance over pi.
vec3 with_bubbles(vec3 seen, float cover, vec3 falling, vec3 extinction) {
    return mix(seen, kBubbleAlbedo * falling * exp(-2.0 * kBubbleDepth * extinction), cover);
}

// The surface with foam on it.
vec3 with_foam(vec3 color, float cover, vec2 q, float footprint, vec3 falling) {
    return mix(color, kFoamAlbedo * falling, mix(kThinFoam, 1.0, cover) * foam_share(cover, q, footprint));
}

// The maps to be made, as buffers of the three steps know them (caustics_pass.h).

#include "caustics_gpu.h"

layout(binding = 20) uniform samplerBuffer caustics;  // CausticRecord

CausticRecord caustic_record(uint map) {
    int first = int(map * kCausticTexels);
    return CausticRecord(
        texelFetch(caustics, first),
        texelFetch(caustics, first + 1),
        texelFetch(caustics, first + 2),
        texelFetch(caustics, first + 3),
        texelFetch(caustics, first + 4),
        texelFetch(caustics, first + 5),
        texelFetch(caustics, first + 6));
}

const float kWhole = 524288.0;  // what a texel counts for the light of flat water: sums are whole numbers

// The maps to be made, as buffers of the three steps know them (caustics_pass.h).

#include "caustics_gpu.h"

// A texel a work group of rays: its map, its first ray; then CausticRecord.
layout(binding = 20) uniform samplerBuffer caustics;

uniform int groups;  // of rays, in all maps together

CausticRecord caustic_record(int map) {
    int first = groups + map * int(kCausticTexels);
    return CausticRecord(
        texelFetch(caustics, first),
        texelFetch(caustics, first + 1),
        texelFetch(caustics, first + 2),
        texelFetch(caustics, first + 3),
        texelFetch(caustics, first + 4),
        texelFetch(caustics, first + 5),
        texelFetch(caustics, first + 6),
        texelFetch(caustics, first + 7));
}

// Map and ray of an invocation, the ray as a number of the map's own.
ivec2 caustic_ray() {
    vec4 group = texelFetch(caustics, int(gl_WorkGroupID.x));
    return ivec2(group.x, int(group.y) + int(gl_LocalInvocationID.x));
}

const float kWhole = 524288.0;  // what a texel counts for the light of flat water: sums are whole numbers

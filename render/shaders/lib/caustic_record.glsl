// The caustic maps to render, for the three steps of caustics_pass.h.

#include "caustics_gpu.h"

// One texel per work group of rays: its map, its first ray; then CausticRecord.
layout(binding = kCausticRecordsUnit) uniform samplerBuffer caustics;

uniform int groups;  // work groups of rays in all maps

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
        texelFetch(caustics, first + 7),
        texelFetch(caustics, first + 8));
}

// Map of this invocation, and index of its ray within the map.
ivec2 caustic_ray() {
    vec4 group = texelFetch(caustics, int(gl_WorkGroupID.x));
    return ivec2(group.x, int(group.y) + int(gl_LocalInvocationID.x));
}

const float kFixedPointOne = 524288.0;  // fixed-point value of the light under flat water, as sums are integers

// The sums of caustics_splat.comp as a texture: light that arrives over the light that flat water lets in.
#version 450
#include "lib/caustic_record.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 1) readonly buffer Light {
    uint light[];
};
layout(binding = 0, r32f) writeonly uniform image2DArray maps;

void main() {
    uint map = gl_GlobalInvocationID.z;
    uint side = uint(caustic_record(map).grid.y);
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x < side) {
        float sum = float(light[(map * side + at.y) * side + at.x]) / kWhole;
        imageStore(maps, ivec3(at, map), vec4(sum));
    }
}

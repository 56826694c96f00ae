// Converts the sums of caustics_splat.comp to a texture: light relative to that under flat water.
#version 450
#include "lib/caustic_record.glsl"
#include "caustics_gpu.h"

layout(local_size_x = 64) in;

layout(std430, binding = kCausticLightBinding) readonly buffer Light {
    uint light[];
};
layout(binding = kCausticMapsImage, r32f) writeonly uniform image2D maps;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int width = imageSize(maps).x;
    if (at.x < width) {
        imageStore(maps, at, vec4(float(light[at.y * width + at.x]) / kFixedPointOne));
    }
}

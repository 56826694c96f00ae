// The second half of the ocean's transform, along x: one work group per row of a cascade. Writes the textures of
// OceanFields.
#version 450
#include "lib/fft_line.glsl"
#include "ocean_gpu.h"

layout(std430, binding = kOceanLinesBinding) readonly buffer Lines {
    Quad lines[];
};
layout(binding = kOceanDisplacementImage, rgba32f) writeonly uniform image2DArray displacement;
layout(binding = kOceanDerivativesImage, rgba32f) writeonly uniform image2DArray derivatives;

void main() {
    uint cascade = gl_WorkGroupID.y;
    uint z = gl_WorkGroupID.x;
    for (uint n = gl_LocalInvocationID.x; n < SIZE; n += kLineGroup) {
        store_line(n, lines[(cascade * SIZE + z) * SIZE + n]);
    }
    transform_line();
    for (uint x = gl_LocalInvocationID.x; x < SIZE; x += kLineGroup) {
        // height, shift_x, shift_xx, slope_x; shift_zz, slope_z, shift_xz, shift_z
        Quad field = load_line(x);
        ivec3 at = ivec3(x, z, cascade);
        imageStore(displacement, at, vec4(field.ab.y, field.ab.x, field.cd.w, field.cd.z));
        imageStore(derivatives, at, vec4(field.ab.w, field.cd.y, field.ab.z, field.cd.x));
    }
}

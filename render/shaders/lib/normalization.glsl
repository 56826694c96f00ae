// Unit vectors, computed or read from a cube map. Definitions:
//   NORMALIZATION_CUBE         read, stored in floats (env.normalise-cube)
//   NORMALIZATION_CUBE_BYTES   the same, stored in bytes: 0 .. 1 for -1 .. 1
// Techniques: env.normalise-cube

#if defined(NORMALIZATION_CUBE) || defined(NORMALIZATION_CUBE_BYTES)
#include "normalization_gpu.h"

layout(binding = kNormalizationUnit) uniform samplerCube normalization_cube;

// Zero stays a vector of some length: the direction that the cube has for it.
vec3 unit_vector(vec3 v) {
    vec3 texel = textureLod(normalization_cube, v, 0.0).xyz;
#ifdef NORMALIZATION_CUBE_BYTES
    texel = texel * 2.0 - 1.0;
#endif
    return texel;
}
#else
vec3 unit_vector(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-20));
}
#endif

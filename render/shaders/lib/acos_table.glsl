// Angles of directions from a texture (render/material/acos_table.h), and the same by arithmetic.
// Techniques: engine.opt-lut

#include "acos_gpu.h"

layout(binding = kAcosUnit) uniform sampler2D acos_table;

// acos(x / sqrt(1 - y^2)) and acos(y) for x, y in -1 .. 1 [rad].
vec2 angles_from_table(float x, float y) {
    vec2 size = vec2(textureSize(acos_table, 0));
    return textureLod(acos_table, ((vec2(x, y) * 0.5 + 0.5) * (size - 1.0) + 0.5) / size, 0.0).xy;
}
vec2 angles_by_arithmetic(float x, float y) {
    return vec2(acos(clamp(x * inversesqrt(max(1.0 - y * y, 1e-12)), -1.0, 1.0)), acos(clamp(y, -1.0, 1.0)));
}

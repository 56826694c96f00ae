// One axis of a step between two levels of the pyramid. Down: smooths, applies the tent and smooths again; up: the
// transpose of the first two. Definition UP.
#version 450
#include "lib/pyramid.glsl"

layout(binding = 0) uniform sampler2D source;

uniform ivec2 axis;  // (1, 0) or (0, 1)
uniform int sizes;   // texels of the target along it
uniform float gain;

layout(location = 0) out vec4 stepped;

void main() {
    ivec2 target = ivec2(gl_FragCoord.xy);
    int at = target.x * axis.x + target.y * axis.y;
    ivec2 source_size = textureSize(source, 0);
    int count = source_size.x * axis.x + source_size.y * axis.y;
    ivec2 across = target * (1 - axis);
    vec3 sum = vec3(0.0);
#ifdef UP
    float ratio = float(sizes) / float(count);
    int begin = int(ceil((float(at) - 1.0) / ratio - 1.5));
    for (int i = begin; i < begin + 5; ++i) {
        float share = ratio * smooth_share(float(at), (float(i) + 0.5) * ratio, ratio);
        sum += share * texelFetch(source, across + axis * mirrored(i, count), 0).rgb;
    }
#else
    float ratio = float(count) / float(sizes);
    float middle = (float(at) + 0.5) * ratio;
    int begin = int(floor(middle - 2.0 * ratio)) - 1;
    for (int i = begin; i < begin + 11; ++i) {
        float share = 0.5 * smooth_share(float(i), middle, ratio)
                      + 0.25 * smooth_share(float(i), middle - ratio, ratio)
                      + 0.25 * smooth_share(float(i), middle + ratio, ratio);
        sum += share * texelFetch(source, across + axis * mirrored(i, count), 0).rgb;
    }
#endif
    stepped = vec4(gain * sum, 0.0);
}

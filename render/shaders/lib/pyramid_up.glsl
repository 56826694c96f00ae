// A picture read at twice its size, the transpose of the step that made it (lib/pyramid.glsl): each pixel is the mean
// of what bilinear interpolation gives all over it. Definition ANY_SIZE: the sizes are not exactly 2 : 1.

#include "lib/pyramid.glsl"

#ifdef ANY_SIZE
uniform ivec2 size;  // of the target
#endif

vec4 enlarged(sampler2D small) {
#ifdef ANY_SIZE
    ivec2 small_size = textureSize(small, 0);
    vec2 ratio = vec2(size) / vec2(small_size);
    vec2 from = floor(gl_FragCoord.xy);
    ivec2 begin = ivec2(floor(from / ratio - 0.5));
    vec4 mean = vec4(0.0);
    for (int y = 0; y < 3; ++y) {
        float share_y = ratio.y * tent_share(from.y, from.y + 1.0, (float(begin.y + y) + 0.5) * ratio.y, ratio.y);
        for (int x = 0; x < 3; ++x) {
            float share_x = ratio.x * tent_share(from.x, from.x + 1.0, (float(begin.x + x) + 0.5) * ratio.x, ratio.x);
            mean += share_x * share_y * texelFetch(small, clamp(begin + ivec2(x, y), ivec2(0), small_size - 1), 0);
        }
    }
    return mean;
#else
    return texture(small, 0.5 * gl_FragCoord.xy / vec2(textureSize(small, 0)));
#endif
}

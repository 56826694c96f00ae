// Half the picture, sorted by where its pixels stand: far behind the focus, far before it, and all but the latter.
// Colors come with their share of the texel, radii too, so that neighbors mix as what they are.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D scene_depth;

layout(location = 0) out vec4 far_light;
layout(location = 1) out vec4 near_light;
layout(location = 2) out vec2 radii;  // [px] of far and near circles
layout(location = 3) out vec4 behind_near;

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(focus.size.xy) - 1;
    far_light = vec4(0.0);
    near_light = vec4(0.0);
    vec2 sum = vec2(0.0);
    vec2 weights = vec2(1e-20);
    behind_near = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = min(first + ivec2(i & 1, i >> 1), last);
        vec4 light = finite_light(texelFetch(scene_radiance, pixel, 0));
        float diameter = circle(texelFetch(scene_depth, pixel, 0).r);
        float is_far = 0.25 * far_share(diameter);
        float is_near = 0.25 * near_share(diameter);
        far_light += is_far * light;
        near_light += is_near * light;
        behind_near += (0.25 - is_near) * light;
        // Of what shines most, lest a lamp gets the circle of the sky around it.
        vec2 shines = vec2(is_far, is_near) * (luminance_of(light.rgb) + 1e-6);
        sum += 0.5 * abs(diameter) * shines;
        weights += shines;
    }
    radii = sum / weights * vec2(far_light.a, near_light.a);
}

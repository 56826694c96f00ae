// Half the picture, sorted by where its pixels stand: far behind the focus, far before it, and all but the latter.
// Colors come with their share of the texel, radii too, so that neighbors mix as what they are.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D scene_depth;

layout(location = 0) out vec4 far_light;
layout(location = 1) out vec4 near_light;
layout(location = 2) out vec4 radii;  // [px] of far and near circles, by radius_weight; z: of far ones, by their share
layout(location = 3) out vec4 behind_near;

// Under a tent over 4 x 4 pixels: wherever in its texel a light is, its middle and its width stay what they were.

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy) - 1;
    ivec2 last = ivec2(focus.size.xy) - 1;
    far_light = vec4(0.0);
    near_light = vec4(0.0);
    vec2 sum = vec2(0.0);
    float far_radius = 0.0;
    behind_near = vec4(0.0);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            ivec2 pixel = clamp(first + ivec2(x, y), ivec2(0), last);
            float tent = (x == 1 || x == 2 ? 0.375 : 0.125) * (y == 1 || y == 2 ? 0.375 : 0.125);
            vec4 light = tent * finite_light(texelFetch(scene_radiance, pixel, 0));
            float diameter = circle(texelFetch(scene_depth, pixel, 0).r);
            float is_near = near_share(diameter);
            vec2 shares = vec2(far_share(diameter), is_near);
            far_light += shares.x * light;
            near_light += shares.y * light;
            behind_near += is_near > 0.0 ? vec4(0.0) : light;
            sum += 0.5 * abs(diameter) * radius_weight(light) * shares;
            far_radius += 0.5 * abs(diameter) * shares.x * light.a;
        }
    }
    radii = vec4(sum, far_radius, 0.0);
}

// The square about each sprite of a lens flare, from FlareSprite records (lens_flare_pass.h).
#version 450
#include "disk_visibility_gpu.h"
#include "lens_flare_gpu.h"

layout(binding = kLensSpritesUnit) uniform samplerBuffer sprites;
layout(binding = kVisibilityUnit) uniform sampler2D visibility;  // of each light

uniform vec2 tangent;  // of half the field of view

layout(location = 0) out vec2 point;  // tangent of the angle to the view axis
layout(location = 1) flat out vec4 radiance_softness;
layout(location = 2) flat out vec4 rims[4];

const vec2 kCorners[6] =
    vec2[](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0));

void main() {
    int first = 6 * (gl_VertexID / 6);
    vec4 circle = texelFetch(sprites, first);
    float visible = texelFetch(visibility, ivec2(int(circle.w), 0), 0).r;
    radiance_softness = texelFetch(sprites, first + 1) * vec4(vec3(visible), 1.0);
    for (int i = 0; i < 4; ++i) {
        rims[i] = texelFetch(sprites, first + 2 + i);
    }
    point = circle.xy + circle.z * kCorners[gl_VertexID % 6];
    gl_Position = visible > 0.0 ? vec4(point / tangent, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}

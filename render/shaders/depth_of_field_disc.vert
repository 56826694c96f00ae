// A point sprite for the disc of each highlight removed by depth_of_field_base.frag, first far and then near ones.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusFarWideUnit) uniform sampler2D far_wide;
layout(binding = kFocusNearWideUnit) uniform sampler2D near_wide;
layout(binding = kFocusFarBaseUnit) uniform sampler2D far_base;
layout(binding = kFocusNearBaseUnit) uniform sampler2D near_base;
layout(binding = kFocusPackedUnit) uniform sampler2D packed_pixels;
layout(binding = kFocusTilesUnit) uniform sampler2D focus_tiles;

uniform ivec2 texels;  // at quarter resolution

flat out vec3 light;    // of the disc
flat out float radius;  // [px], negative in front of the focus
flat out vec2 center;   // [px]

// Weight of a pixel in this column or row of a texel, by the tent of depth_of_field_split.frag.
float tent(int i) {
    return i == 0 || i == 5 ? 1.0 : i == 1 || i == 4 ? 3.0 : 4.0;
}

// Centroid of a texel's light among its 6 x 6 pixels, and radius of its circle [px].
vec3 centroid_of(ivec2 texel, float side, int pixels) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < pixels; ++i) {
        ivec2 offset = ivec2(i % 6, i / 6);
        ivec2 pixel = clamp(4 * texel - 1 + offset, ivec2(0), last);
        vec4 pixel_light = texelFetch(packed_pixels, pixel, 0);
        float texel_radius = pixel_light.a == kUnknown ? 0.0 : side * pixel_light.a;
        float weight = tent(offset.x) * tent(offset.y) * coarse_weight(texel_radius) * luminance_of(pixel_light.rgb);
        sum += weight * vec4(vec2(pixel) + 0.5, texel_radius, 1.0);
    }
    return sum.xyz / max(sum.w, 1e-20);
}

void main() {
    int count = texels.x * texels.y;
    bool is_near = gl_VertexID >= count;
    int index = is_near ? gl_VertexID - count : gl_VertexID;
    ivec2 texel = ivec2(index % texels.x, index / texels.x);
    ivec2 last = textureSize(focus_tiles, 0) - 1;
    vec4 tile = texelFetch(focus_tiles, min(4 * texel / kFocusTile, last), 0);
    vec2 uv = 2.0 * (vec2(texel) + 0.5) / focus.size.zw;
    vec4 total = vec4(0.0);
    vec3 excess = vec3(0.0);
    for (int i = 0; i < (is_near && tile.y > 0.0 ? 1 : 0); ++i) {  // a loop is skipped, a branch might be flattened
        total = textureLod(near_wide, uv, 0.0);
        excess = total.rgb - texelFetch(near_base, texel, 0).rgb;
    }
    for (int i = 0; i < (!is_near && tile.w > 0.0 ? 1 : 0); ++i) {
        total = textureLod(far_wide, uv, 0.0);
        excess = total.rgb - texelFetch(far_base, texel, 0).rgb;
    }
    bool is_highlight = max(excess.r, max(excess.g, excess.b)) > 1e-5 * max(total.r, max(total.g, total.b));
    float side = is_near ? -1.0 : 1.0;
    vec3 disc = centroid_of(texel, side, is_highlight ? 36 : 0);
    light = excess * 16.0;
    center = disc.xy;
    radius = side * disc.z;
    gl_Position = is_highlight ? vec4(center / focus.size.xy * 2.0 - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
    gl_PointSize = 2.0 * disc.z + 3.0;
}

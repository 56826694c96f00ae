// A layer of half the resolution over the scene: between the four nearest texels where all are about as far as the
// pixel, else the one whose distance is most alike (render/particle_layer.h).
#version 450
#include "lib/view.glsl"

layout(binding = 0) uniform sampler2D layer;
layout(binding = 1) uniform sampler2D layer_depth;
layout(binding = 4) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

const float kAlike = 0.1;  // difference of distances up to which texels are of one surface, as a share

void main() {
    float here = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec2 size = vec2(textureSize(layer, 0));
    vec2 place = 0.5 * gl_FragCoord.xy;  // [texels]
    vec2 corner = clamp(floor(place - 0.5), vec2(0.0), size - 2.0);
    vec4 four = textureGather(layer_depth, (corner + 1.0) / size);  // upper left, upper right, lower right, lower left

    // Depths are near / distance, so that their differences are shares of distances, too.
    vec4 apart = abs(four - here);
    float nearest = min(min(apart.x, apart.y), min(apart.z, apart.w));
    vec2 chosen = apart.w == nearest   ? vec2(0.5)
                  : apart.z == nearest ? vec2(1.5, 0.5)
                  : apart.x == nearest ? vec2(0.5, 1.5)
                                       : vec2(1.5);
    bool alike = all(lessThanEqual(apart, vec4(kAlike * here)));
    radiance = textureLod(layer, (alike ? place : corner + chosen) / size, 0.0);
}

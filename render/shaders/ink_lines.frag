// Lines of ink along the edges of ink_edges.frag: as dark as the nearest edge is near.
// Techniques: tex.ink-lines
#version 450
#include "fullscreen_gpu.h"
#include "ink_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kInkEdgesUnit) uniform sampler2D ink_edges;

uniform vec4 ink;          // color; w: opacity
uniform float half_width;  // of lines [px]

layout(location = 0) out vec4 radiance;

const float kFar = 1e4;

// Squared distance to the nearest edge within a square of pixels. An edge is the side that two pixels share.
float edge_distance2(ivec2 pixel, int reach) {
    ivec2 last = textureSize(ink_edges, 0) - 1;
    float nearest = kFar;
    for (int y = -reach - 1; y <= reach; ++y) {
        for (int x = -reach - 1; x <= reach; ++x) {
            vec2 edge = texelFetch(ink_edges, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).rg;
            vec2 beyond = max(abs(vec2(x, y)) - 0.5, 0.0);  // how far the sides extend past the pixel's center
            float right = (float(x) + 0.5) * (float(x) + 0.5) + beyond.y * beyond.y;
            float lower = (float(y) + 0.5) * (float(y) + 0.5) + beyond.x * beyond.x;
            nearest = min(nearest, min(edge.x > 0.5 ? right : kFar, edge.y > 0.5 ? lower : kFar));
        }
    }
    return nearest;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float covered = 0.0;
    float distance2 = edge_distance2(pixel, int(half_width + 0.5));
    // Thinner than a pixel: fainter, not broken.
    covered = clamp(half_width + 0.5 - sqrt(distance2), 0.0, min(2.0 * half_width, 1.0));
    vec4 scene = texelFetch(scene_radiance, pixel, 0);
    radiance = vec4(mix(scene.rgb, ink.rgb, ink.a * covered), scene.a);
}

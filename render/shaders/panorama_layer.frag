// One layer of very distant surroundings, blended over the sky. Defined: PANORAMA_FACES for a cube of six images.
// Techniques: engine.panorama
#version 450
#include "lib/panorama.glsl"
#include "lib/radiance.glsl"
#include "lib/view.glsl"
#include "panorama_layer_gpu.h"

#ifdef PANORAMA_FACES
layout(binding = kPanoramaLayerUnit) uniform samplerCube faces;  // mirrored: front is +z
#else
layout(binding = kPanoramaLayerUnit) uniform sampler2D image;  // its first row is the top one
#endif

uniform mat3 layer_from_world;  // a rotation
uniform int mapping;            // PanoramaMapping
uniform float half_angle;
uniform float repeat;
uniform vec4 color;             // a: opacity

layout(location = 0) out vec4 radiance;

#ifndef PANORAMA_FACES
const int kMaxTaps = 8;

// Texels of a strip are much wider on screen than they are high. One lookup would blur by the larger number of texels
// per pixel in both directions, so several follow the longer side of the pixel's footprint.
vec4 filtered(vec2 uv, vec2 dx, vec2 dy) {
    vec2 size = vec2(textureSize(image, 0));
    // The axes of the ellipse that a circle of a pixel's width becomes in the texture: of J J^T.
    vec2 s = dx * size;
    vec2 t = dy * size;
    float a = s.x * s.x + t.x * t.x;
    float b = s.x * s.y + t.x * t.y;
    float c = s.y * s.y + t.y * t.y;
    float root = length(vec2(0.5 * (a - c), b));
    float angle = root > 0.0 ? 0.5 * atan(b, 0.5 * (a - c)) : 0.0;
    vec2 lengths = sqrt(max(0.5 * (a + c) + vec2(root, -root), 1e-12));
    vec2 along = vec2(cos(angle), sin(angle)) * lengths.x / size;
    vec2 across = vec2(-sin(angle), cos(angle)) * lengths.y / size;
    float ratio = lengths.x / lengths.y;
    int taps = int(clamp(ceil(ratio), 1.0, float(kMaxTaps)));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        vec2 offset = ((float(i) + 0.5) / float(taps) - 0.5) * along;
        sum += textureGrad(image, uv + offset, across, along / float(taps));
    }
    return sum / float(taps);
}
#endif

void main() {
    vec3 d = layer_from_world * normalize(view_ray(gl_FragCoord.xy));
#ifdef PANORAMA_FACES
    vec4 texel = texture(faces, vec3(d.xy, -d.z));
#else
    vec2 uv = panorama_uv(mapping, d, half_angle);
    uv.y = 1.0 - uv.y;
    // The longitude jumps behind the viewer, which must not choose the smallest mip level.
    vec2 dx = dFdx(uv);
    vec2 dy = dFdy(uv);
    vec2 scale = vec2(1.0);
    if (mapping != kAngular) {
        dx.x -= round(dx.x);
        dy.x -= round(dy.x);
        scale.x = repeat;
    }
    bool above = mapping == kCylindrical && d.y > length(d.xz) * tan(half_angle);  // the strip, where nothing is
    vec4 texel = above ? vec4(0.0) : filtered(scale * uv, scale * dx, scale * dy);
#endif
    radiance = vec4(storable(color.rgb * texel.rgb), color.a * texel.a);
}

// The visible fraction of each disk in the image, one texel per disk (disk_visibility.h).
// Techniques: engine.lens-flare
#version 450
#include "disk_visibility_gpu.h"

layout(binding = kDiskDepthUnit) uniform sampler2D scene_depth;
layout(binding = kDiskSourcesUnit) uniform samplerBuffer sources;  // DiskSource

layout(location = 0) out float visible;

const int kSamples = 64;
const float kGoldenAngle = 2.39996323;

void main() {
    vec4 source = texelFetch(sources, int(gl_FragCoord.x));
    ivec2 size = textureSize(scene_depth, 0);
    int count = 0;
    for (int i = 0; i < kSamples; ++i) {
        float radius = source.w * sqrt((float(i) + 0.5) / float(kSamples));
        float angle = kGoldenAngle * float(i);
        ivec2 pixel = ivec2(floor(source.xy * vec2(size) + radius * vec2(cos(angle), sin(angle))));
        bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
        count += inside && texelFetch(scene_depth, pixel, 0).r <= source.z ? 1 : 0;
    }
    visible = float(count) / float(kSamples);
}

// The layer of stretched objects: each pixel is the mean of the previous frame, sampled backward along the motion, and
// of this one, sampled forward. The listing has opposite signs, which shows two half objects side by side.
#version 450
#include "lib/motion.glsl"
#include "lib/view.glsl"
#include "motion_modes_gpu.h"

layout(binding = kStretchRadianceUnit) uniform sampler2D radiance;                     // of this frame
layout(binding = kPreviousRadianceUnit) uniform sampler2D previous_radiance;  // of the previous frame
layout(binding = kStretchDepthUnit) uniform sampler2D depth_map;              // of this frame

uniform int samples;     // >= 2
uniform float exposure;  // fraction of the motion
uniform float longest;   // [px]

noperspective layout(location = 0) in vec2 motion;
layout(location = 0) out vec4 blurred;

const float kBehind = 1.02;  // ratio of distances from which the layer is occluded

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 per_pixel = view.size.zw;
    float layer_distance = 1.0 / gl_FragCoord.w;
    float depth = texelFetch(depth_map, pixel, 0).r;
    blurred = texelFetch(radiance, pixel, 0);
    if (depth > 0.0 && view_distance(depth) * kBehind < layer_distance) {
        return;  // the layer is occluded
    }
    vec2 v = bounded_motion(motion * exposure, longest);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < samples; ++i) {
        float t = float(i) / float(samples - 1);
        sum += textureLod(previous_radiance, (gl_FragCoord.xy - t * v) * per_pixel, 0.0).rgb;
        sum += textureLod(radiance, (gl_FragCoord.xy + t * v) * per_pixel, 0.0).rgb;
    }
    blurred.rgb = sum / float(2 * samples);
}

// One face of a probe's cube map, without negative, infinite and NaN radiance, which would corrupt every mean.
#version 450
#include "lib/tone.glsl"
#include "environment_gpu.h"

layout(binding = kProbeFaceUnit) uniform sampler2D scene_radiance;

layout(location = 0) out vec4 radiance;

const float kMaxRadiance = 65504.0;  // the largest half

void main() {
    radiance = vec4(sanitize_light(texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0).rgb, kMaxRadiance), 1.0);
}

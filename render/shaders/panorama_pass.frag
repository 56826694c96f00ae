// Converts a panorama to one face of a cube map, with four samples per texel.
// Techniques: env.panorama
#version 450
#include "lib/cube_map.glsl"
#include "lib/panorama.glsl"
#include "lib/tone.glsl"
#include "environment_gpu.h"

layout(binding = kPanoramaUnit) uniform sampler2D panorama;  // its first row is the top one

uniform int face;
uniform float size;       // side of the face [px]
uniform int mapping;      // PanoramaMapping
uniform float half_angle;
uniform vec2 turn;        // cosine and sine of its rotation about the vertical axis
uniform float level;      // mip level whose texels are about as large as the face's
uniform float intensity;

layout(location = 0) out vec4 radiance;

const float kMaxRadiance = 65504.0;  // the largest half

void main() {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 corner = 0.5 * vec2(i & 1, i >> 1) - 0.25;
        vec3 d = cube_direction(face, (gl_FragCoord.xy + corner) / size);
        d.xz = vec2(turn.x * d.x - turn.y * d.z, turn.y * d.x + turn.x * d.z);
        vec2 uv = panorama_uv(mapping, d, half_angle);
        sum += sanitize_light(intensity * textureLod(panorama, vec2(uv.x, 1.0 - uv.y), level).rgb, kMaxRadiance);
    }
    radiance = vec4(0.25 * sum, 1.0);
}

// Mixes the image with the color of each point that dazzles, as far as it is in sight (dazzle_pass.h).
// Techniques: engine.obfuscating-point
#version 450

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D visibility;  // of each point
layout(binding = 2) uniform samplerBuffer points;  // DazzlePoint

uniform int count;

layout(location = 0) out vec4 radiance;

void main() {
    radiance = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    for (int i = 0; i < count; ++i) {
        vec4 point = texelFetch(points, i);
        radiance.rgb = mix(radiance.rgb, point.rgb, point.w * texelFetch(visibility, ivec2(i, 0), 0).r);
    }
}

// One face of a probe's cube map, without negative, infinite and NaN radiance, which would spoil every mean.
#version 450

layout(binding = 5) uniform sampler2D scene_radiance;

layout(location = 0) out vec4 radiance;

const float kMaxRadiance = 65504.0;  // the largest half

void main() {
    vec3 color = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0).rgb;
    radiance = vec4(min(max(color, 0.0), kMaxRadiance), 1.0);
}

// Adds one sample picture to a sum that blending keeps.
#version 450

layout(binding = 0) uniform sampler2D scene_radiance;

uniform float weight;

layout(location = 0) out vec4 sum;

void main() {
    sum = weight * texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
}

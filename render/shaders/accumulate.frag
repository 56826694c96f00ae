// Adds one sample image to a sum, by blending.
#version 450

layout(binding = 0) uniform sampler2D scene_radiance;

uniform float weight;

layout(location = 0) out vec4 sum;

void main() {
    sum = weight * texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
}

// Interpolates per-vertex light (light.gouraud). Alpha-masked holes need no test: the depth prepass has left them out.
// Techniques: light.gouraud
#version 450
#define LIT_AT_VERTICES
#include "lib/material.glsl"
#include "lib/radiance.glsl"

layout(location = 0) INTERPOLATED in vec3 diffuse;
layout(location = 1) INTERPOLATED in vec3 specular;

layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(storable(diffuse * color_over_light() + specular + surface_emission()), 1.0);
}

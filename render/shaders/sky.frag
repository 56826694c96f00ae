// What is seen where no surface is. Definition SKY_KIND of lib/sky.glsl.
#version 450
#include "lib/sky.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(sky_background(normalize(view_ray(gl_FragCoord.xy))), 1.0);
}

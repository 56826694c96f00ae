// The background. Definition SKY_KIND of lib/sky.glsl.
#version 450
#include "lib/radiance.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"

uniform bool for_light;  // for lighting instead of display: no sun, but the studio's lamps

layout(location = 0) out vec4 radiance;

void main() {
    vec3 direction = normalize(view_ray(gl_FragCoord.xy));
    radiance = vec4(storable(for_light ? sky_radiance(direction) : sky_background(direction)), 1.0);
}

// Adds subsurface light, which exits around the point where it entered, by blending.
// Techniques: skin.diffusion
#version 450
#include "lib/diffused_light.glsl"
#include "lib/radiance.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    vec4 here = texelFetch(scattered, ivec2(gl_FragCoord.xy), 0);
    if (here.a == 0.0) {
        discard;
    }
    radiance = vec4(storable(diffused_light(gl_FragCoord.xy, here)), 0.0);
}

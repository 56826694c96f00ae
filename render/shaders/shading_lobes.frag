// The lobe that lights each pixel, as a depth: its number / 16, 0 where there is no surface. Full-screen triangles at
// this depth then draw only the pixels of a lobe.
// Techniques: deferred.light-pass
#version 450
#include "lib/stored_surface.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint lobe = lobe_number(texelFetch(gbuffer, pixel, 0).z >> 25 & 15u);
    gl_FragDepth = texelFetch(scene_depth, pixel, 0).r > 0.0 ? float(lobe) / 16.0 : 0.0;
}

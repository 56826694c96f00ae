// Alpha-blended surfaces, forward shaded from back to front. Opacity scales diffuse but not specular light: nearly
// clear glass still reflects the lamps. Premultiplied.
#version 450
#define UNMASKED  // shadow masks are of the opaque surfaces behind
#include "lib/lighting.glsl"
#include "lib/material.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    vec4 color = surface_color();
    float opacity = clamp(color.a, 0.0, 1.0);
    SurfaceSample s = surface_sample(color.rgb);
    float distance = view_distance(gl_FragCoord.z);
    vec3 position_ws = world_position(gl_FragCoord.xy, gl_FragCoord.z);
    Reflected light = reflect_all(s, position_ws, gl_FragCoord.xy, cell_list(gl_FragCoord.xy, distance));

    // The share that is reflected does not transmit the background.
    Reflector r = make_reflector(s, to_viewer(position_ws));
    float mirror = dot(r.mirror, vec3(1.0 / 3.0));
    radiance = vec4(
        storable(opacity * (light.diffuse + s.emission) + light.specular), opacity + (1.0 - opacity) * mirror);
}

// Alpha-blended surfaces, forward shaded from back to front. Opacity scales diffuse but not specular light: nearly
// clear glass still reflects the lamps. Premultiplied. Definition TRANSMISSION: for clear media, which replace the
// image behind them by the refracted one.
#version 450
#define UNMASKED  // shadow masks are for the opaque surfaces behind
#include "lib/lighting.glsl"
#include "lib/material.glsl"
#include "lib/height_fog.glsl"
#ifdef TRANSMISSION
#include "lib/transmission.glsl"
#endif

layout(location = 0) out vec4 radiance;

void main() {
    vec4 color = surface_color();
    float opacity = clamp(color.a, 0.0, 1.0);
    SurfaceSample s = surface_sample(color.rgb);
    float distance = view_distance(surface_depth);
    vec3 position_ws = world_position(gl_FragCoord.xy, surface_depth);
    Reflected light = reflect_all(s, position_ws, gl_FragCoord.xy, cell_list(gl_FragCoord.xy, distance));

    // The reflected fraction does not transmit the background.
    Reflector r = make_reflector(s, to_viewer(position_ws));
    float mirror = reflected_fraction(r);
#ifdef TRANSMISSION
    ClearMedium medium = clear_medium(s.material);
    float clear = medium.transmission * (1.0 - s.metalness);
    vec3 behind = transmitted_radiance(medium, position_ws, s.normal_ws, r.to_camera, s.roughness);
    light.diffuse *= 1.0 - clear;
    vec3 through = opacity * clear * (1.0 - mirror) * s.albedo * behind;  // with the fog in front of it
    float clear_coverage = opacity * clear * (1.0 - mirror);
#else
    const vec3 through = vec3(0.0);
    const float clear_coverage = 0.0;
#endif
    float coverage = opacity + (1.0 - opacity) * mirror;
    vec4 fog = fog_before(position_ws);
    vec3 own = (opacity * (light.diffuse + visible_emission(s, position_ws)) + light.specular) * (1.0 - fog.a);
    radiance = vec4(storable(own + fog.rgb * (coverage - clear_coverage) + through), coverage);
    cut_surface(color.a);
}

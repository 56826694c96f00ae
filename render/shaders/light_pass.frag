// Deferred shading: one pass over the G-buffer, each pixel with the lights of its cluster cell. Definition SCATTERED:
// diffuse light of Subsurface goes to a separate target.
// Techniques: deferred.light-pass, light.multi
#version 450
#include "lib/lighting.glsl"
#include "lib/stored_surface.glsl"

layout(location = 0) out vec4 radiance;
#ifdef SCATTERED
layout(location = 1) out vec4 scattered;  // subsurface light without albedo; alpha 1 on such surfaces
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(scene_depth, pixel, 0).r;
    SurfaceSample s = stored_surface(pixel);
    vec3 position_ws = world_position(gl_FragCoord.xy, depth);
    Reflected light =
        reflect_all(s, position_ws, gl_FragCoord.xy, cell_list(gl_FragCoord.xy, view_distance(depth)));
#ifdef SCATTERED
    bool spreads = s.model == kModelSubsurface;
    scattered = spreads ? vec4(storable(light.diffuse / max(s.albedo, vec3(1e-4))), 1.0) : vec4(0.0);
    light.diffuse = spreads ? vec3(0.0) : light.diffuse;
#endif
    radiance = vec4(storable(visible_emission(s, position_ws) + light.diffuse + light.specular), 1.0);
}

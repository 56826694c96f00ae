// Visibility buffer of water surfaces, shaded per pixel by water.frag: triangles are small, and a GPU shades more
// pixels than each covers. Definition VELOCITY.
#version 450
#include "lib/water_visibility.glsl"
#include "lib/velocity.glsl"
#include "lib/view.glsl"

layout(location = 0) in vec2 rest;
layout(location = 1) flat in int body;
layout(location = 3) in vec4 wave_by_x;
layout(location = 4) in vec3 wave_by_z;
#ifdef VELOCITY
layout(location = 2) in vec3 previous_clip;
layout(location = 2) out vec2 velocity;
#endif
layout(location = 0) out uvec4 position;
layout(location = 1) out uvec4 bend;

void main() {
    vec2 across = dFdx(rest);
    vec2 along = dFdy(rest);
    // For elongated footprints less blur than needed, so that grazing views stay crisp.
    float footprint = sqrt(sqrt(dot(across, across) * dot(along, along)));
    uvec4 texels[2] = pack_visible_water(VisibleWater(
        body, gl_FrontFacing, rest, gl_FragCoord.z, footprint, wave_by_x.xyz, wave_by_z, wave_by_x.w));
    position = texels[0];
    bend = texels[1];
#ifdef VELOCITY
    vec2 now = 2.0 * gl_FragCoord.xy * view.size.zw - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    velocity = velocity_from(now, previous_clip, view.size.xy);
#endif
}

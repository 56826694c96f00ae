// The disc of a highlight at full resolution, occluded by nearer surfaces.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusNearBlurredUnit) uniform sampler2D near_blurred;
layout(binding = kFocusDepthUnit) uniform sampler2D scene_depth;

flat in vec3 light;
flat in float radius;
flat in vec2 middle;

layout(location = 0) out vec4 color;

// Share of the highlight that passes the surface visible here. The ray through the point of the aperture that lights
// this pixel crosses a nearer surface at the image of that point in the surface's own circle: the depth there decides.
float unoccluded_share(float own) {
    float nearer = clamp(own / radius, 0.0, 1.0);
    vec2 there = mix(gl_FragCoord.xy, middle, nearer);
    float surface_radius = 0.5 * circle(texelFetch(scene_depth, ivec2(there), 0).r);
    return clamp(8.0 * surface_radius / radius - 6.0, 0.0, 1.0);  // by eye: surfaces at about the same distance hide nothing
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy - middle;
    float visible = 1.0;
    if (radius > 0.0) {
        float own = 0.5 * circle(texelFetch(scene_depth, here, 0).r);
        float covered = texture(near_blurred, gl_FragCoord.xy * 0.5 / focus.size.zw).a;
        visible = own > kFineRadius ? (1.0 - covered) * unoccluded_share(own) : 0.0;
    } else {
        place = -place;
    }
    float wide = max(abs(radius), 1.0);
    float inside = clamp(wide - aperture_radius(place) + 0.5, 0.0, 1.0);
    float area = focus.aperture.z * (wide * wide + 1.0 / 12.0);
    color = vec4(light * (visible * inside / area), 0.0);
}

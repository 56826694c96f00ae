// The disc of a highlight at full resolution, occluded by nearer surfaces.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusNearBlurredUnit) uniform sampler2D near_blurred;
layout(binding = kFocusDepthUnit) uniform sampler2D scene_depth;

flat in vec3 light;
flat in float radius;
flat in vec2 center;

layout(location = 0) out vec4 color;

// Fraction of the highlight not occluded by the surface in this pixel. The ray through the point of the aperture that
// lights the pixel crosses a nearer surface at the image of that point in the surface's own circle: compares the depth
// there.
float unoccluded_fraction(float own) {
    float nearer = clamp(own / radius, 0.0, 1.0);
    vec2 position = mix(gl_FragCoord.xy, center, nearer);
    float surface_radius = 0.5 * circle(texelFetch(scene_depth, ivec2(position), 0).r);
    // By eye: surfaces at about the same distance do not occlude.
    return clamp(8.0 * surface_radius / radius - 6.0, 0.0, 1.0);
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 offset = gl_FragCoord.xy - center;
    float visible = 1.0;
    if (radius > 0.0) {
        float own = 0.5 * circle(texelFetch(scene_depth, here, 0).r);
        float covered = texture(near_blurred, gl_FragCoord.xy * 0.5 / focus.size.zw).a;
        visible = own > kFineRadius ? (1.0 - covered) * unoccluded_fraction(own) : 0.0;
    } else {
        offset = -offset;
    }
    float wide = max(abs(radius), 1.0);
    float inside = clamp(wide - aperture_radius(offset) + 0.5, 0.0, 1.0);
    float area = focus.aperture.z * (wide * wide + 1.0 / 12.0);
    color = vec4(light * (visible * inside / area), 0.0);
}

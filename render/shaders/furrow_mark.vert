// A line with round caps, or a dot, as a quad that faces the camera, from FurrowMark records of three texels
// (furrow_pass.h).
// Techniques: wrinkle.furrow.view-modes
#version 450
#include "furrow_gpu.h"

layout(binding = kFurrowMarksUnit) uniform samplerBuffer marks;

layout(location = 0) out vec4 color;
layout(location = 1) noperspective out vec2 line_px;  // along the line from its beginning, and across
layout(location = 2) flat out vec2 length_radius_px;
layout(location = 3) flat out float opacity;

uniform mat4 clip_from_mesh;
uniform vec2 size;     // of the image [px]
uniform float pixels;  // factor of radii

const vec2 kCorners[6] = vec2[](
    vec2(0.0, -1.0), vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(0.0, -1.0), vec2(1.0, 1.0), vec2(1.0, -1.0));
const float kNear = 1e-4;      // [m]
const float kOfSpacing = 0.2;  // maximum radius relative to the spacing of marks; by eye
const float kMinRadius = 0.5;  // [px]: thinner marks become transparent instead
const float kLift = 1.006;     // factor of depth, toward the camera: marks lie on faces

void main() {
    int mark = gl_VertexID / 6;
    vec2 corner = kCorners[gl_VertexID % 6];
    vec4 from_radius = texelFetch(marks, 3 * mark);
    vec4 from = clip_from_mesh * vec4(from_radius.xyz, 1.0);
    vec4 to_spacing = texelFetch(marks, 3 * mark + 1);
    vec4 to = clip_from_mesh * vec4(to_spacing.xyz, 1.0);
    color = texelFetch(marks, 3 * mark + 2);
    float radius = from_radius.w * pixels;
    float thinned = 1.0;
    if (to_spacing.w > 0.0) {
        // On a dense mesh marks become smaller than the gaps between them, and faces stay visible.
        float up = length(vec3(clip_from_mesh[0].y, clip_from_mesh[1].y, clip_from_mesh[2].y));
        float spacing_px = to_spacing.w * 0.5 * size.y * up / max(from.w, kNear);
        float fitting = min(radius, kOfSpacing * spacing_px);
        radius = max(fitting, min(radius, kMinRadius));
        thinned = fitting / radius;
    }

    bool behind = from.w < kNear && to.w < kNear;
    if (to.w < kNear && !behind) {
        to = mix(from, to, (from.w - kNear) / (from.w - to.w));
    } else if (from.w < kNear && !behind) {
        from = mix(to, from, (to.w - kNear) / (to.w - from.w));
    }
    vec2 from_px = 0.5 * size * from.xy / from.w;
    vec2 to_px = 0.5 * size * to.xy / to.w;
    float length_px = distance(from_px, to_px);
    vec2 along = length_px > 1e-3 ? (to_px - from_px) / length_px : vec2(1.0, 0.0);
    opacity = thinned * clamp(max(thinned, length_px), 0.0, 1.0);  // a dot fades in both directions
    float extent = radius + 1.0;

    line_px = vec2(corner.x * length_px + (2.0 * corner.x - 1.0) * extent, corner.y * extent);
    length_radius_px = vec2(length_px, radius);
    vec4 end = corner.x > 0.5 ? to : from;
    vec2 at_px = from_px + line_px.x * along + line_px.y * vec2(-along.y, along.x);
    gl_Position =
        behind ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(at_px / (0.5 * size) * end.w, kLift * end.z, end.w);
}

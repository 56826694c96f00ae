// What the camera saw in the previous frame, as an obstacle for particles: at each pixel a plane, through the pixel and
// those beside it. Only the places below a few points of the way are looked at, so that what is narrower than their
// distance in the image may be missed. Included by particle_collide.glsl.
// Techniques: particle.depth-collision

#include "lib/view.glsl"  // of the previous frame

layout(binding = 1) uniform sampler2D seen_depth;
uniform float thickness;  // of what was seen [m]; 0: particles do not meet it

const int kSeenSamples = 12;     // of the way of a step
const float kMaybeNear = 0.05;   // share of the distance within which a surface may be that of the pixel

struct SeenPlane {
    vec3 normal;   // toward the camera; 0: nothing there
    float offset;  // dot(normal, place) on it
};

vec3 seen_position(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), textureSize(seen_depth, 0) - 1);
    return world_position(vec2(inside) + 0.5, max(texelFetch(seen_depth, inside, 0).r, 1e-20));
}

// To the neighbor along `axis`, or from the one on the other side, whichever is closer: of one surface.
vec3 seen_slope(ivec2 pixel, ivec2 axis, vec3 middle) {
    vec3 after = seen_position(pixel + axis) - middle;
    vec3 before = middle - seen_position(pixel - axis);
    float ahead = dot(after, after);
    float behind = dot(before, before);
    return ahead > 0.0 && (ahead < behind || behind == 0.0) ? after : before;
}

SeenPlane seen_plane(vec3 place, float reach) {
    const SeenPlane kNothing = SeenPlane(vec3(0.0), 0.0);
    vec4 clip = view.clip_from_world * vec4(place, 1.0);
    vec2 at = (clip.xy / max(clip.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
    if (clip.w < view.camera_ws.w || any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, view.size.xy))) {
        return kNothing;
    }
    ivec2 pixel = ivec2(at);
    float depth = texelFetch(seen_depth, pixel, 0).r;
    float distance_ = view_distance(max(depth, 1e-20));
    if (depth <= 0.0 || abs(clip.w - distance_) > kMaybeNear * distance_ + reach) {
        return kNothing;
    }
    vec3 middle = seen_position(pixel);
    vec3 normal = cross(seen_slope(pixel, ivec2(1, 0), middle), seen_slope(pixel, ivec2(0, 1), middle));
    float size = length(normal);
    if (!(size > 0.0 && size < 1e20)) {
        return kNothing;
    }
    normal *= (dot(normal, view.camera_ws.xyz - middle) < 0.0 ? -1.0 : 1.0) / size;
    return SeenPlane(normal, dot(normal, middle));
}

// How far `place` is behind the plane, with its radius; negative: before it.
float behind(SeenPlane plane, vec3 place, float radius) {
    return plane.offset + radius - dot(plane.normal, place);
}

// As find_exit(): of who is in what was seen, but not behind it.
vec4 find_seen_exit(vec3 place, float radius) {
    SeenPlane plane = seen_plane(place, 4.0 * radius + thickness);
    float depth = behind(plane, place, radius);
    return plane.normal == vec3(0.0) || depth > thickness ? vec4(0.0) : vec4(plane.normal, depth);
}

Touch touch_seen(vec3 from, vec3 delta, float radius) {
    float pace = length(delta) / float(kSeenSamples);
    for (int i = 1; i <= kSeenSamples; ++i) {
        float at = float(i) / float(kSeenSamples);
        vec3 place = from + at * delta;
        SeenPlane plane = seen_plane(place, 4.0 * radius + thickness + pace);
        float depth = behind(plane, place, radius);
        float before = -behind(plane, from, radius);
        if (plane.normal == vec3(0.0) || depth <= 0.0 || depth > thickness + pace || before < 0.0) {
            continue;
        }
        float share = before / (before + depth) * at;
        // Once more where they meet, in case the surface is curved.
        SeenPlane there = seen_plane(from + share * delta, 4.0 * radius + thickness + pace);
        float change = dot(there.normal, delta);
        before = -behind(there, from, radius);
        return before >= 0.0 && before + change < 0.0 ? Touch(before / -change, there.normal) : Touch(share, plane.normal);
    }
    return Touch(2.0, vec3(0.0));
}

// The depth of the previous frame as an obstacle for particles: at each pixel, a plane through it and its neighbors.
// Only the pixels at a few points along the path are tested, so that anything narrower in the image than their spacing
// may be missed. Included by particle_collide.glsl.
// Techniques: particle.depth-collision

#include "lib/view.glsl"  // of the previous frame

layout(binding = kPreviousDepthUnit) uniform sampler2D previous_depth;
uniform float thickness;  // assumed behind the depth [m]; 0: particles do not collide with it

const int kDepthSamples = 12;   // along the path of a step
const float kMaxGap = 0.05;     // between a position and the pixel's surface, to be tested: fraction of its distance

struct DepthPlane {
    vec3 normal;   // toward the camera; 0: no plane
    float offset;  // dot(normal, position) on it
};

vec3 depth_position(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), textureSize(previous_depth, 0) - 1);
    return world_position(vec2(inside) + 0.5, max(texelFetch(previous_depth, inside, 0).r, 1e-20));
}

// The difference to the neighbor along `axis`, or from the opposite one, whichever is closer and so likely on the same
// surface.
vec3 depth_slope(ivec2 pixel, ivec2 axis, vec3 center) {
    vec3 after = depth_position(pixel + axis) - center;
    vec3 before = center - depth_position(pixel - axis);
    float ahead = dot(after, after);
    float behind = dot(before, before);
    return ahead > 0.0 && (ahead < behind || behind == 0.0) ? after : before;
}

DepthPlane depth_plane(vec3 position, float tolerance) {
    const DepthPlane kNoPlane = DepthPlane(vec3(0.0), 0.0);
    vec4 clip = view.clip_from_world * vec4(position, 1.0);
    vec2 at = (clip.xy / max(clip.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
    if (clip.w < view.camera_ws.w || any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, view.size.xy))) {
        return kNoPlane;
    }
    ivec2 pixel = ivec2(at);
    float depth = texelFetch(previous_depth, pixel, 0).r;
    float distance_ = view_distance(max(depth, 1e-20));
    if (depth <= 0.0 || abs(clip.w - distance_) > kMaxGap * distance_ + tolerance) {
        return kNoPlane;
    }
    vec3 center = depth_position(pixel);
    vec3 normal = cross(depth_slope(pixel, ivec2(1, 0), center), depth_slope(pixel, ivec2(0, 1), center));
    float size = length(normal);
    if (!(size > 0.0 && size < 1e20)) {
        return kNoPlane;
    }
    normal *= (dot(normal, view.camera_ws.xyz - center) < 0.0 ? -1.0 : 1.0) / size;
    return DepthPlane(normal, dot(normal, center));
}

// Penetration of the plane by a particle of this radius; negative: distance in front of it.
float behind(DepthPlane plane, vec3 position, float radius) {
    return plane.offset + radius - dot(plane.normal, position);
}

// As find_exit(), for positions within the thickness behind the depth.
vec4 find_depth_exit(vec3 position, float radius) {
    DepthPlane plane = depth_plane(position, 4.0 * radius + thickness);
    float depth = behind(plane, position, radius);
    return plane.normal == vec3(0.0) || depth > thickness ? vec4(0.0) : vec4(plane.normal, depth);
}

Touch touch_depth(vec3 from, vec3 delta, float radius) {
    float spacing = length(delta) / float(kDepthSamples);
    for (int i = 1; i <= kDepthSamples; ++i) {
        float at = float(i) / float(kDepthSamples);
        vec3 position = from + at * delta;
        DepthPlane plane = depth_plane(position, 4.0 * radius + thickness + spacing);
        float depth = behind(plane, position, radius);
        float before = -behind(plane, from, radius);
        if (plane.normal == vec3(0.0) || depth <= 0.0 || depth > thickness + spacing || before < 0.0) {
            continue;
        }
        float fraction = before / (before + depth) * at;
        // Once more with the plane at the contact, in case the surface is curved.
        DepthPlane there = depth_plane(from + fraction * delta, 4.0 * radius + thickness + spacing);
        float change = dot(there.normal, delta);
        before = -behind(there, from, radius);
        return before >= 0.0 && before + change < 0.0 ? Touch(before / -change, there.normal, 0.0)
                                                : Touch(fraction, plane.normal, 0.0);
    }
    return kNoTouch;
}

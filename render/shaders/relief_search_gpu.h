// Relief below a mesh: rays through a height field. Shared by shaders and C++, which reads the map by a function.
//
// A ray enters at x = 0 on the mesh and ends at x = 1. Depths are fractions of the depth of the relief, 0 on the mesh.
// A texel of the map has its depth in w; in z the depth of the back surface, or the ratio of its widest empty cone: its
// radius in tiles to its height in depths of the relief.
// Techniques: relief.double-depth, relief.early-out, relief.inverse-map, relief.ray-curved, relief.ray-quadric,
//     relief.ray-range, relief.ray-service, relief.search, relief.self-shadow, relief.tangent-shadow, relief.thin-features

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"

#include <algorithm>
#include <cmath>
namespace limn::layout {
using std::max;
using std::min;
using std::sqrt;
#define LIMN_SHARED inline
#define LIMN_SEARCH template <typename Map> inline
#define LIMN_MAP , const Map& map
#define LIMN_SAME_MAP , map
#define RELIEF_TEXEL(at) map(at)
#else
#define LIMN_SHARED
#define LIMN_SEARCH
#define LIMN_MAP
#define LIMN_SAME_MAP
#endif

struct ReliefRay {
    vec2 uv;      // at x = 0
    vec2 travel;  // of uv from x = 0 to x = 1
    float slope;  // depth = slope x - bend x^2
    float bend;   // > 0: the mesh is convex, and the ray may leave the relief again
};

const float kReliefMiss = 2.0f;  // in place of x
const float kMinReliefCosine = 0.05f;  // between a ray and the inward normal: limits the search at grazing angles

LIMN_SHARED vec2 relief_uv_at(ReliefRay ray, float x) {
    return ray.uv + ray.travel * x;
}

LIMN_SHARED float relief_depth_at(ReliefRay ray, float x) {
    return (ray.slope - ray.bend * x) * x;
}

// x: length [m] of a ray within a relief of `depth` [m]; y: 1 where it ends on the bottom, which it always hits, 0 where
// it leaves through the mesh. `down`: cosine to the inward normal, > 0. `fall`: A vx^2 + B vy^2 [1/m], how the quadric of
// the mesh falls away along the ray. The root is stable for a plane, too.
LIMN_SHARED vec2 relief_range(float down, float fall, float depth) {
    float root = down * down - 4.0f * fall * depth;
    return root >= 0.0f ? vec2(2.0f * depth / (down + sqrt(root)), 1.0f) : vec2(down / fall, 0.0f);
}

// How far the ray is above the surface at x; 0 or less: inside. `is_closed`: the relief ends at its back surface.
LIMN_SEARCH float relief_clearance(ReliefRay ray, float x, bool is_closed LIMN_MAP) {
    vec4 texel = RELIEF_TEXEL(relief_uv_at(ray, x));
    float depth = relief_depth_at(ray, x);
    return is_closed ? max(texel.w - depth, depth - texel.z) : texel.w - depth;
}

// The first x at which one of `steps` samples is inside, then the midpoint of smaller and smaller intervals; or
// kReliefMiss. The result is at or behind the surface, by at most 2^-refinements / steps.
LIMN_SEARCH float relief_search(ReliefRay ray, int steps, int refinements, bool is_closed LIMN_MAP) {
    float outside = 0.0f;
    float inside = kReliefMiss;
    for (int i = 1; i <= steps; ++i) {
        float x = float(i) / float(steps);
        if (relief_clearance(ray, x, is_closed LIMN_SAME_MAP) <= 0.0f) {
            inside = x;
            break;
        }
        outside = x;
    }
    for (int i = 0; inside <= 1.0f && i < refinements; ++i) {
        float x = 0.5f * (outside + inside);
        if (relief_clearance(ray, x, is_closed LIMN_SAME_MAP) <= 0.0f) {
            inside = x;
        } else {
            outside = x;
        }
    }
    return inside;
}

// Parallax occlusion mapping (Tatarchuk 2006): where the surface, linear between the samples before and behind it, is.
LIMN_SEARCH float relief_search_linear(ReliefRay ray, int steps LIMN_MAP) {
    float above = relief_clearance(ray, 0.0f, false LIMN_SAME_MAP);
    for (int i = 1; i <= steps; ++i) {
        float x = float(i) / float(steps);
        float below = -relief_clearance(ray, x, false LIMN_SAME_MAP);
        if (below >= 0.0f) {
            return x - below / (max(above + below, 1e-6f) * float(steps));
        }
        above = -below;
    }
    return kReliefMiss;
}

// Relaxed cone stepping (Policarpo and Oliveira 2007): a ray that stays within the cone of a texel enters the surface
// once at most, so it may step to the cone's border; the last step is bisected.
LIMN_SEARCH float relief_search_cones(ReliefRay ray, int steps, int refinements LIMN_MAP) {
    float run = sqrt(ray.travel.x * ray.travel.x + ray.travel.y * ray.travel.y);
    float outside = 0.0f;
    float inside = 0.0f;
    for (int i = 0; i < steps; ++i) {
        vec4 texel = RELIEF_TEXEL(relief_uv_at(ray, inside));
        float above = texel.w - inside;
        if (above <= 0.0f) {
            break;
        }
        outside = inside;
        inside = min(inside + max(texel.z, 1.0f / 512.0f) * above / (run + max(texel.z, 1.0f / 512.0f)), 1.0f);
    }
    for (int i = 0; i < refinements; ++i) {
        float x = 0.5f * (outside + inside);
        if (RELIEF_TEXEL(relief_uv_at(ray, x)).w <= x) {
            inside = x;
        } else {
            outside = x;
        }
    }
    return inside;
}

// The ray to a light from a point `depth` below the mesh, reversed: it enters at x = 0 and reaches the point at x = 1.
// `up` and `fall`: as down and fall of relief_range(), of the direction to the light; y: its length [m].
LIMN_SHARED ReliefRay relief_light_ray(vec2 uv, vec2 travel_to_light, float up, float fall, float length, float relief) {
    ReliefRay ray;
    ray.uv = uv + travel_to_light;
    ray.travel = -travel_to_light;
    ray.bend = fall * length * length / relief;
    ray.slope = up * length / relief + 2.0f * ray.bend;
    return ray;
}

// Length [m] of the ray that leaves through the mesh from a point `depth` [m] below it.
LIMN_SHARED float relief_way_out(float up, float fall, float depth) {
    return 2.0f * depth / (up + sqrt(max(up * up + 4.0f * fall * depth, 0.0f)));
}

// How far in front of the point an occluder must be, and how deep the ray must be inside it for a full shadow, in depths
// of the relief: more than the error of the search.
const float kReliefShadowThreshold = 0.02f;

// The fraction of light that reaches the end of `ray`, from relief_light_ray(), at `depth`.
LIMN_SEARCH float relief_visibility(ReliefRay ray, float depth, int steps, bool is_closed LIMN_MAP) {
    float inside = 0.0f;
    for (int i = 0; i < steps && inside < kReliefShadowThreshold; ++i) {
        float x = (float(i) + 0.5f) / float(steps);
        float before = depth - kReliefShadowThreshold - relief_depth_at(ray, x);
        inside = max(inside, min(before, -relief_clearance(ray, x, is_closed LIMN_SAME_MAP)));
    }
    float t = min(inside / kReliefShadowThreshold, 1.0f);
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

#undef LIMN_SHARED
#undef LIMN_SEARCH
#undef LIMN_MAP
#undef LIMN_SAME_MAP

#ifdef __cplusplus
#undef RELIEF_TEXEL
}  // namespace limn::layout
#endif

// Extrusion of shadow volumes (shadow.vol-extrude, shadow.extrusion-distance), shared by the vertex shader and its
// tests, and its input. A light is homogeneous: its position and 1, or the direction toward it and 0.
// Techniques: shadow.extrusion-distance, shadow.vol-extrude

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"

#include <algorithm>
namespace limn::layout {
using std::max;
#define LIMN_SHARED inline
#else
#define LIMN_SHARED
#endif

// One caster of one light, as instance-rate attributes.
struct VolumeInstance {
    vec4 row[3];  // world_from_mesh
    vec4 light;   // in mesh space
    vec4 relief;  // x: its depth [m]
};

// One light.
struct VolumeBlock {
    vec4 light;      // world, homogeneous
    vec4 extrusion;  // kExtrude*, distance [m], bias of the near cap [m], range of the light [m]
};

const float kExtrudeInfinite = 0.0;  // to infinity
const float kExtrudeConstant = 1.0;  // by the distance: the far cap has the shape of the caster
const float kExtrudeRadius = 2.0;    // to that distance from the light: the far cap cuts into the light's sphere
const float kExtrudePlane = 3.0;     // until the whole cap is that far away: prisms only, shared sides would split

// From the light to `p`, not unit.
LIMN_SHARED vec3 away_from_light(vec3 p, vec4 light) {
    vec3 away = p * light.w - vec3(light.x, light.y, light.z);
    return dot(away, away) > 1e-20f ? away : vec3(0.0f, -1.0f, 0.0f);  // a corner at the light itself
}

LIMN_SHARED vec3 shift_from_light(vec3 p, vec4 light, float distance) {
    vec3 away = away_from_light(p, light);
    return p + away * (distance / length(away));
}

// Homogeneous. `height` is the distance of the light from the corner's triangle's plane [m].
LIMN_SHARED vec4 extrude_corner(vec3 p, vec4 light, vec4 extrusion, float height) {
    vec3 away = away_from_light(p, light);
    if (extrusion.x == kExtrudeConstant) {
        return vec4(shift_from_light(p, light, extrusion.y), 1.0f);
    }
    if (extrusion.x == kExtrudeRadius && light.w > 0.0f) {
        return vec4(shift_from_light(p, light, max(extrusion.y - length(away), 0.0f)), 1.0f);
    }
    if (extrusion.x == kExtrudePlane && light.w > 0.0f && height * 1e4f > extrusion.y) {
        return vec4(p + away * (max(extrusion.y / height, 1.0f) - 1.0f), 1.0f);
    }
    return vec4(away, 0.0f);
}

// How far the near cap moves away from the light, besides its bias, so that relief `depth` below the caster's mesh is not
// in its own volume (shadow.relief-stencil). `cosine`: between the direction to the light and the normal of the mesh.
LIMN_SHARED float relief_push(float depth, float cosine) {
    return depth / max(cosine, 0.1f);
}

// Of volumes whose corners are shared by faces of all directions: light at more than 75 degrees darkens the relief.
const float kSharedPushCosine = 0.25f;

#undef LIMN_SHARED

// Bindings.
const uint kShadowVolumeBinding = 2u;

#ifdef __cplusplus
static_assert(sizeof(VolumeInstance) == 80);
static_assert(sizeof(VolumeBlock) == 32);
}  // namespace limn::layout
#endif

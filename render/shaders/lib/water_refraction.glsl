// Refraction in water, by one of several methods (ecs/components/water_look.h). Include after lib/water_tracing.glsl
// and lib/water_light.glsl. Definitions:
//   LOOKS      some body of water is not rendered by default
//   FLOOR_MAP  some has a map of its floor
//   NO_TRACED_REFRACTION     none has screen-space traced refraction from above
// Techniques: water.reflection-refraction-maps, water.refraction-map

#include "water_gpu.h"

const int kTracedRefraction = 0;
const int kShiftedRefraction = 1;
const int kFloorRefraction = 2;
const float kShift = 0.02;  // fraction of the image, for a horizontal normal

#ifdef FLOOR_MAP
layout(binding = kFloorMapUnit) uniform sampler2D floor_map;  // repeats
uniform float floor_tile;                                     // side of a copy [m]

// The floor map where a refracted ray hits it, lit by downwelling light.
RayHit floor_refraction(WaterRecord water, vec3 position, vec3 bent) {
    float path = (water.absorption.w + position.y - water.origin.y) / max(-bent.y, 0.02);
    vec3 hit = world_to_water(water, position + path * bent - water.origin.xyz);
    // The mip level of flat water, regardless of waves that focus rays.
    float texels = float(textureSize(floor_map, 0).x) / floor_tile;
    float pixel = distance(position, view.camera_ws.xyz) * 2.0 * length(view.ray_up.xyz) * view.size.w;
    vec3 color = textureLod(floor_map, hit.xz / floor_tile, log2(max(pixel * texels, 1.0))).rgb;
    vec3 light = downwelling_light(water) * exp(-water_extinction(water) * (kDownwellingPath * water.absorption.w));
    return RayHit(color * light, path);
}
#endif

#ifdef LOOKS
// The image, offset by the tilt of the normal; never surfaces in front of the water or above it (Vlachos et al. 2004).
RayHit shifted_refraction(WaterRecord water, vec3 position, vec3 normal) {
    float here = dot(position - view.camera_ws.xyz, view.ray_forward.xyz);
    vec2 lean = vec2(dot(normal.xz, view.ray_right.xz) / length(view.ray_right.xyz), dot(normal.xz, view.ray_forward.xz));
    vec2 to = clamp_to_screen(gl_FragCoord.xy + kShift * water.ocean.w * lean * view.size.xy);
    float there = distance_at(to);
    bool outside = there > 0.0 && (there <= here || height_of(to, there) > water.origin.y);
    to = outside ? gl_FragCoord.xy : to;
    there = distance_at(to);
    float path = there > 0.0 ? (there - here) * length(view_ray(gl_FragCoord.xy)) : kInfiniteDistance;
    return RayHit(radiance_at(to), max(path, 0.0));
}
#endif

RayHit refracted_light(WaterRecord water, vec3 position, vec3 normal, vec3 bent, float max_distance, bool above) {
#ifdef LOOKS
    int how = above ? int(water.scattering.w) >> 4 & 3 : kTracedRefraction;
    RayHit through = shifted_refraction(water, position, normal);
#if defined(FROM_BELOW) || !defined(NO_TRACED_REFRACTION)
    RayHit traced = trace_refraction(position, bent, max_distance, above);
    if (how == kTracedRefraction) {
        through = traced;
    }
#endif
#ifdef FLOOR_MAP
    if (how == kFloorRefraction) {
        through = floor_refraction(water, position, bent);
    }
#endif
    return through;
#else
    return trace_refraction(position, bent, max_distance, above);
#endif
}

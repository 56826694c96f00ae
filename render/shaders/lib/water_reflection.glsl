// Alternative Fresnel terms and reflections of water (ecs/components/water_look.h). Include after lib/view.glsl,
// lib/optics.glsl and lib/water_surface.glsl. Definitions:
//   LOOKS     some body of water is not rendered by default
//   PLANAR    some has a planar reflection
//   REFLECTION_MAP  some has an authored map of reflections
//   NO_SCREEN_REFLECTION  none has screen-space reflections
// Techniques: water.fresnel-approx, water.reflection-refraction-maps

#include "water_gpu.h"

const int kSchlick = 1;
const int kByAngle = 2;
const int kScreenReflection = 0;
const int kPlanarReflection = 2;
const int kMapReflection = 3;

// Reflectance of a water surface, from above or below.
float water_reflectance(WaterRecord water, bool above, float cosine) {
    float reflectance = fresnel(cosine, above ? water.shape.w : 1.0 / water.shape.w);
#ifdef LOOKS
    int how = int(water.scattering.w) & 3;
    reflectance = above && how == kSchlick ? fresnel_schlick(cosine, water.shape.w) : reflectance;
    reflectance = above && how == kByAngle ? fresnel_tso_barsky(cosine) : reflectance;
#endif
    return reflectance;
}

int reflection_of(WaterRecord water) {
#ifdef LOOKS
    return int(water.scattering.w) >> 2 & 3;
#else
    return kScreenReflection;
#endif
}

#ifdef REFLECTION_MAP
layout(binding = kReflectionImageUnit) uniform sampler2D reflection_image;  // repeats
uniform vec2 reflection_plane;  // height above the water, side of a tile [m]

// The authored map where a mirrored ray meets its plane (Ts'o and Barsky 1987), lit by `falling`: irradiance over pi.
vec3 authored_reflection(WaterRecord water, vec3 position, vec3 away, vec3 falling) {
    float path = (reflection_plane.x + water.origin.y - position.y) / max(away.y, 0.02);
    vec3 hit = world_to_water(water, position + path * away - water.origin.xyz);
    float texels = float(textureSize(reflection_image, 0).x) / reflection_plane.y;
    float eye = distance(position, view.camera_ws.xyz);
    float pixel = (eye + path) * 2.0 * length(view.ray_up.xyz) * view.size.w / max(away.y, 0.02);
    return falling * textureLod(reflection_image, hit.xz / reflection_plane.y, log2(max(pixel * texels, 1.0))).rgb;
}
#endif

#ifdef PLANAR
// The scene from a camera mirrored in the surface at rest, upside down; w: distance along its axis [m], 0 where empty.
// Its mip levels are blurred.
layout(binding = kWaterReflectionUnit) uniform sampler2D reflection_map;

const int kPlanarSteps = 3;
const float kFarAway = 1e4;  // [m]

// Reflection at `position` toward `away`. In flat water the mirrored scene appears at the same pixel; waves shift it,
// more at larger distances, which are found by fixed-point iteration on the map. `alpha`: roughness of the unresolved
// normals.
vec3 planar_reflection(WaterRecord water, vec3 position, vec3 away, float alpha) {
    // The mirrored ray continues below the surface.
    vec3 start = vec3(position.x, 2.0 * water.origin.y - position.y, position.z);
    vec3 onward = vec3(away.x, -max(away.y, 0.0), away.z);
    vec3 from = (view.clip_from_world * vec4(start, 1.0)).xyw;
    vec3 along = (view.clip_from_world * vec4(onward, 0.0)).xyw;
    vec2 straight = gl_FragCoord.xy * view.size.zw;
    vec2 uv = straight;
    float path = kFarAway;
    for (int i = 0; i < kPlanarSteps; ++i) {
        float mirrored = textureLod(reflection_map, vec2(uv.x, 1.0 - uv.y), 0.0).w;
        path = mirrored > 0.0 ? clamp((mirrored - from.z) / max(along.z, 1e-3), 0.0, kFarAway) : kFarAway;
        vec3 clip = from + path * along;
        uv = 0.5 + 0.5 * clip.xy / max(clip.z, 1e-6);
    }
    uv = mix(straight, uv, water.ocean.w);
    float pixel = 2.0 * length(view.ray_up.xyz) / float(textureSize(reflection_map, 0).y);
    float blur = 2.0 * alpha * path / (path + distance(position, view.camera_ws.xyz));
    return textureLod(reflection_map, vec2(uv.x, 1.0 - uv.y), log2(max(blur / pixel, 1.0))).rgb;
}
#endif

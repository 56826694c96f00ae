// Absorption and in-scattering between the scene and a camera under water. At the surface, only below the water line on
// the lens. With caustics, the sun forms light shafts.
#version 450
#define UNMASKED
#include "lib/noise.glsl"
#include "lib/lighting.glsl"
#include "lib/optics.glsl"
#include "lib/water_surface.glsl"
#include "lib/water_light.glsl"
#include "fullscreen_gpu.h"
#include "water_gpu.h"
#ifdef UNDER_WATER
#include "lib/water_shafts.glsl"
#endif

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kWaterVeilDepthUnit) uniform sampler2D scene_depth;

uniform int body;         // index of the water around the camera
uniform bool at_surface;  // its waves may rise to the camera

layout(location = 0) out vec4 radiance;

const int kSearchSteps = 3;
const float kInfiniteDistance = 1e4;  // [m]

bool is_under(WaterRecord water, vec3 lens) {
    vec3 p = world_to_water(water, lens - water.origin.xyz);
    if (!at_surface) {
        return true;
    }
    vec2 q = p.xz;
    vec3 offset = vec3(0.0);
    for (int i = 0; i < kSearchSteps; ++i) {
        offset = water_offset(water, q, 0.0, false);
        q = p.xz - offset.xz;
    }
    return p.y < offset.y;
}

// Distance over which a ray from the camera stays between the sides of the water [m].
float distance_to_side(WaterRecord water, vec3 direction) {
    vec3 p = world_to_water(water, view.camera_ws.xyz - water.origin.xyz);
    vec3 d = world_to_water(water, direction);
    vec2 paths = (water.shape.yz - sign(d.xz) * p.xz) / max(abs(d.xz), vec2(1e-6));
    paths = mix(vec2(kInfiniteDistance), paths, greaterThan(water.shape.yz, vec2(0.0)));
    return max(min(paths.x, paths.y), 0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 scene = texelFetch(scene_radiance, pixel, 0).rgb;
    float depth = texelFetch(scene_depth, pixel, 0).r;
    WaterRecord water = water_record(body);
    vec3 ray = view_ray(gl_FragCoord.xy);
    vec3 lens = view.camera_ws.xyz + ray * view.camera_ws.w;
    float path = depth > 0.0 ? view_distance(depth) * length(ray) : kInfiniteDistance;
    path = min(path, distance_to_side(water, normalize(ray)));
    vec3 transmittance = exp(-water_extinction(water) * path);
    float below = max(water.origin.y - view.camera_ws.y, 0.0);
#ifdef UNDER_WATER
    Underwater around = underwater_at(lens);
    vec3 to_sun = texelFetch(lights, max(int(around.maps.z), 0) * int(kLightTexels)).xyz;
    vec3 bent = bent_to_light(around, to_sun);
    float shafts = shafts_along(around, bent, normalize(ray), path, water_extinction(water), gl_FragCoord.xy);
    vec3 downwelling = downwelling_light(water, int(around.maps.z), shafts);
#else
    vec3 downwelling = downwelling_light(water);
#endif
    vec3 scattered = scattered_light(water, downwelling, below, normalize(ray));
    vec3 veiled = scene * transmittance + scattered * (1.0 - transmittance);
    radiance = vec4(storable(is_under(water, lens) ? veiled : scene), 1.0);
}

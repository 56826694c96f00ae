// Traces light from the points of a grid on the water: refracted by the surface and down to the ground, or
// reflected and up to the surfaces above (lib/caustic_landing.glsl). One invocation per ray. Definitions: OCEAN, and
// those of lib/shadow.glsl.
// Techniques: caustic.projected-vertices, caustic.refraction-pool
#version 450
#define UNMASKED  // shadow masks are in screen space
#include "lib/caustic_landing.glsl"
#include "lib/caustic_record.glsl"
#include "lib/optics.glsl"
#include "lib/view.glsl"
#include "caustics_gpu.h"
const float kPi = 3.14159265358979;
#include "lib/water_surface.glsl"
#include "light_gpu.h"
#ifdef SHADOWS
#include "lib/shadow.glsl"
#endif

layout(local_size_x = 64) in;

layout(std430, binding = kCausticRaysBinding) writeonly buffer Rays {
    vec4 rays[];  // texel of the map, light, height above rest [m]
};

const int kSteps = 5;
const float kMinSlope = 0.02;  // of light reflected upward [m/m]; that of the lowest sun

#ifdef SHADOWS
// Distance below (or above) a point of the map to the first surface: 0 .. 1 of the traced distance.
float ground_at(CausticRecord record, vec2 uv) {
    vec4 rect = texelFetch(shadow_views, int(record.world.w) * int(kShadowViewTexels) + 7);
    vec2 texel = clamp(mix(rect.xy, rect.zw, uv), rect.xy + 1.0, rect.zw - 1.0);
    vec2 corner = floor(texel - 0.5);
    vec2 fraction = texel - 0.5 - corner;
    vec4 depths = 1.0 - textureGather(shadow_atlas, (corner + 1.0) / vec2(textureSize(shadow_atlas, 0)));
    return mix(mix(depths.w, depths.z, fraction.x), mix(depths.x, depths.y, fraction.x), fraction.y);
}
#endif

void main() {
    ivec2 ray_of_map = caustic_ray();
    CausticRecord record = caustic_record(ray_of_map.x);
    int cells = int(record.grid.x);
    ivec2 at = ivec2(ray_of_map.y % (cells + 1), ray_of_map.y / (cells + 1));
    if (at.y > cells) {
        return;
    }
    WaterRecord water = water_record(int(record.to_sun.w));
    bool mirrored = record.grid.w == kCausticsMirrored;
    vec2 q = record.window.xy + record.window.zw * (vec2(at) / float(cells));
    vec2 cell = record.window.zw / float(cells);

    // Beyond its rectangle the water continues as at the rim, so that light landing at a wall has neighbors on both
    // sides.
    bvec2 walled = greaterThan(water.shape.yz, vec2(0.0));
    vec2 bounds = mix(vec2(1e9), water.shape.yz - 0.5 * cell, walled);
    vec2 inner = clamp(q, -bounds, bounds);
    WaterMotion motion = water_motion(water, inner, cell.x);
    vec3 offset = motion.offset;
    vec3 area = cross(vec3(0.0, 0.0, 1.0) + motion.bend.by_z, vec3(1.0, 0.0, 0.0) + motion.bend.by_x);
    vec3 normal = normalize(area);
    vec3 to_sun = record.to_sun.xyz;
    float facing = dot(normal, to_sun);
    float reflectance = fresnel(facing, water.shape.w);
    float light = max(dot(area, to_sun), 0.0) * (mirrored ? reflectance : 1.0 - reflectance) / record.bent.w;

    vec3 ray = mirrored ? reflect_ray(normal, to_sun) : -refract_ray(normal, to_sun, 1.0 / water.shape.w);
    vec2 slant = ray.xz / max(ray.y, kMinSlope) * (mirrored ? 1.0 : -1.0);

    // Below the water, rays at the edge of the map are undisturbed; above it, there is no light from outside the
    // water, and none that waves reflect downward.
    vec2 edge = min(q - record.window.xy, record.window.xy + record.window.zw - q);
    float within = clamp(min(edge.x, edge.y) / record.grid.z, 0.0, 1.0);
    float free = mirrored ? record.target.w : within;
    if (mirrored) {
        bool outside = any(greaterThan(mix(vec2(-1.0), abs(q) - water.shape.yz, walled), vec2(0.0)));
        light *= outside || ray.y < kMinSlope ? 0.0 : all(walled) ? 1.0 : within;
    }
    vec2 bent = record.bent.xy;
    vec2 entry = q + free * (offset.xz + (mirrored ? -slant : slant) * offset.y);
    float path = record.bent.z;
#ifdef SHADOWS
    vec3 entry_ws = water.origin.xyz + water_to_world(water, vec3(inner.x, 0.0, inner.y) + vec3(0.0, offset.y, 0.0));
    light *= light_visibility(record.shadows, entry_ws, vec3(0.0, 1.0, 0.0), record.world.xyz, vec2(at));
    if (record.world.w >= 0.0 && record.grid.w != kCausticsPool) {
        for (int i = 0; i < kSteps; ++i) {
            vec2 landing = undisturbed_entry(entry, free * (slant - bent), path);
            path = record.bent.z * ground_at(record, (landing - record.window.xy) / record.window.zw);
        }
    }
#endif
    if (record.grid.w == kCausticsPool) {
        vec3 from = vec3(inner.x, offset.y, inner.y);
        vec3 hit = land_in_pool(from, vec3(slant.x, -1.0, slant.y), record.pool.xy, record.bent.z);
        path = -hit.y;
        entry = q - inner + hit.xz - slant * path;
        light = light > 0.0 ? pool_light(offset.y, record.pool.z, record.pool.w) : 0.0;
    }
    vec2 landing = undisturbed_entry(entry, free * (slant - bent), path);
    rays[int(record.target.z) + ray_of_map.y] =
        vec4((landing - record.window.xy) / record.window.zw * record.grid.y, light, offset.y);
}

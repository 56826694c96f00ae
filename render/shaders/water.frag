// Shading of a water surface, from above or from below, in the pixels that show it (water_surface.frag): reflection and
// refraction by the Fresnel equations; light is absorbed and scattered in the water (Beer-Lambert). Definitions
// ATTRIBUTES: also writes the G-buffer; FROM_BELOW: the camera may see the surface from below (a software OpenGL executes
// both sides of every if); and those of lib/water_detail.glsl, lib/water_reflection.glsl and lib/water_refraction.glsl.
#version 450
#define UNMASKED  // shadow masks are of the surfaces behind
#define ON_WATER
#include "lib/lighting.glsl"
#include "lib/optics.glsl"
#include "lib/water_visibility.glsl"
#include "lib/water_surface.glsl"
#include "lib/water_light.glsl"
#include "lib/water_detail.glsl"
#include "water_gpu.h"
#if defined(OCEAN) || defined(CRESTS)
#define FOAM
#include "lib/water_foam.glsl"
#endif
#include "lib/water_reflection.glsl"
#include "lib/water_tracing.glsl"
#include "lib/water_refraction.glsl"

layout(binding = kVisibleWaterUnit) uniform usampler2DArray visible_water;  // water_surface.frag

#ifdef ATTRIBUTES
layout(location = 1) out uvec4 surface;
#endif
layout(location = 0) out vec4 radiance;

const float kSmooth = 1e-5;                // minimum slope variance, for ripples that are not modeled
const float kSurfaceTransmittance = 0.54;  // transmittance of the surface for upwelling radiance (Mobley 1999)

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    VisibleWater visible = unpack_visible_water(
        texelFetch(visible_water, ivec3(pixel, 0), 0), texelFetch(visible_water, ivec3(pixel, 1), 0));
    WaterRecord water = water_record(visible.body);
    vec3 position = world_position(gl_FragCoord.xy, visible.depth);
    vec3 to_camera = normalize(view.camera_ws.xyz - position);
    WaterBend bend = field_bend(water, visible.rest, visible.footprint);
    bend.by_x += visible.by_x;
    bend.by_z += visible.by_z;
    bend.variance += visible.variance;
#ifdef CRESTS
    bend.foam = min(bend.foam + crest_foam(water, visible.rest, bend), 1.0);
#endif
    add_detail(bend, visible.body, visible.rest, visible.footprint);
    vec3 up = water_to_world(water, water_normal(bend));
    float roughness = sqrt(sqrt(kSmooth + bend.variance));  // a normal distribution's alpha is the root of this
#ifdef FROM_BELOW
    bool above = visible.above;
#else
    const bool above = true;
#endif
    vec3 normal = above ? up : -up;
    // Waves that face away from the camera count as grazing.
    float facing = dot(normal, to_camera);
    normal = facing < 0.02 ? normalize(normal + (0.02 - facing) * to_camera) : normal;
    float cosine = max(dot(normal, to_camera), 1e-3);
    float index = above ? water.shape.w : 1.0 / water.shape.w;
    float reflectance = water_reflectance(water, above, cosine);

    // Light on the water, to be scattered in it or reflected as glints.
    SurfaceSample s;
    s.normal_ws = normal;
    s.albedo = vec3(0.0);
    s.emission = vec3(0.0);
    s.occlusion = 1.0;
    s.roughness = roughness;
    s.metalness = 0.0;
    s.material = 0u;
    s.model = kModelPbr;
    set_plain(s);
    Reflector r = make_reflector(s, to_camera);
    float normal_incidence = (water.shape.w - 1.0) / (water.shape.w + 1.0);
    r.specular_0 = vec3(normal_incidence * normal_incidence);
    r.specular_90 = vec3(1.0);
    LightSum sum = no_light();
    if (above) {
        add_directional(sum, r, position, gl_FragCoord.xy);
        add_listed(sum, r, cell_list(gl_FragCoord.xy, view_distance(visible.depth)), position, gl_FragCoord.xy);
    }
    vec3 glints = r.specular_0 * (sum.specular - sum.fresnel) + r.specular_90 * sum.fresnel;
    vec3 falling = sum.diffuse / kPi + irradiance_toward(surroundings[0], vec3(0.0, 1.0, 0.0));

    vec3 extinction = water_extinction(water);
    vec3 glow = falling * (kUpwelling * kSurfaceTransmittance) * water.scattering.rgb / max(extinction, vec3(1e-6));

    vec3 bent = reflectance < 1.0 ? refract(-to_camera, normal, 1.0 / index) : -normal;
    float depth = water.absorption.w + position.y - water.origin.y;  // height above the bottom [m]
    float max_distance = above && water.absorption.w > 0.0 ? 1.05 * depth / max(-bent.y, 0.05) : kInfiniteDistance;
    RayHit through = refracted_light(water, position, normal, bent, max_distance, above);
    vec3 transmittance = exp(-extinction * through.path);
    vec3 refracted = through.color * transmittance + glow * (1.0 - transmittance);
    vec3 away = reflect(-to_camera, normal);
    // Where a ray goes down, it meets the water again, which glows and reflects as if it were flat.
    float again = above && away.y < 0.0 ? water_reflectance(water, above, -away.y) : 1.0;
    vec3 leaving = above ? vec3(away.x, abs(away.y), away.z) : away;
    vec3 around = environment_light(position, normal, leaving, roughness).mirrored;
    Side side = Side(water.origin.y - 0.02, 1.0);
#ifdef FROM_BELOW
    vec3 scattered = scattered_light(water, 0.0, away);
    if (!above) {
        vec3 sky = environment_light(position, normal, bent, roughness).mirrored;
        refracted = through.path < kInfiniteDistance ? through.color : sky;
        vec3 ground = mix(scattered, bottom_light(water), exp(-extinction * distance_to_bottom(water, away)));
        around = water.absorption.w > 0.0 ? ground : scattered;
        side = Side(water.origin.y + 0.02, -1.0);
    }
#endif
    RayHit hit = RayHit(around, kInfiniteDistance);
#if defined(FROM_BELOW) || !defined(NO_SCREEN_REFLECTION)
    hit = trace_reflection(position, leaving, around, side, fwidth(float(visible.body)) == 0.0);
#endif
#ifdef LOOKS
    bool traced = !above || reflection_of(water) == kScreenReflection;
    vec3 mirror = traced ? hit.color : around;
#else
    vec3 mirror = hit.color;
#endif
    mirror = mix(glow, mirror, again);
#ifdef REFLECTION_MAP
    mirror = reflection_of(water) == kMapReflection ? authored_reflection(water, position, away, falling) : mirror;
#endif
#ifdef PLANAR
    if (reflection_of(water) == kPlanarReflection) {
        mirror = planar_reflection(water, position, away, roughness * roughness);
    }
#endif
#ifdef FROM_BELOW
    if (!above) {
        mirror = hit.path < kInfiniteDistance ? mix(scattered, hit.color, exp(-extinction * hit.path)) : around;
    }
#endif
#ifdef FOAM
    refracted = above ? with_bubbles(refracted, bend.foam, falling, extinction) : refracted;
#endif
    vec3 color = mix(refracted, mirror, reflectance) + glints;
#ifdef FOAM
    color = above ? with_foam(color, bend.foam, visible.rest, visible.footprint, falling) : color;
#endif
    radiance = vec4(storable(color), 1.0);
#ifdef ATTRIBUTES
    surface = pack_surface(s);
#endif
}

// The surface of water, seen from above or from below: what it mirrors and what is seen through it, by the Fresnel
// equations; light is lost and scattered on its way through the water (Beer-Lambert). Definitions VELOCITY; ATTRIBUTES:
// of the G-buffer, too; FROM_BELOW: the camera may see the surface from below (a software OpenGL runs both sides of
// every if); and those of lib/water_detail.glsl, lib/water_reflection.glsl and lib/water_refraction.glsl.
#version 450
#define UNMASKED  // the masks of shadow volumes are of the surfaces behind
#define ON_WATER
#include "lib/lighting.glsl"
#include "lib/optics.glsl"
#include "lib/velocity.glsl"
#include "lib/water_surface.glsl"
#include "lib/water_light.glsl"
#include "lib/water_detail.glsl"
#ifdef OCEAN
#include "lib/water_foam.glsl"
#endif
#include "lib/water_reflection.glsl"
#include "lib/water_tracing.glsl"
#include "lib/water_refraction.glsl"

layout(location = 0) in vec2 rest;
layout(location = 1) flat in int body;
layout(location = 3) in vec4 wave_by_x;
layout(location = 4) in vec3 wave_by_z;
#ifdef VELOCITY
layout(location = 2) in vec3 clip_before;
layout(location = 1) out vec2 velocity;
#endif
#ifdef ATTRIBUTES
#ifdef VELOCITY
layout(location = 2) out uvec4 surface;
#else
layout(location = 1) out uvec4 surface;
#endif
#endif
layout(location = 0) out vec4 radiance;

const float kSmooth = 1e-5;  // variance of the slopes of ripples that nothing else has
const float kThrough = 0.54;    // of upwelling radiance the surface lets out (Mobley 1999)

void main() {
    WaterRecord water = water_record(body);
    vec3 position = world_position(gl_FragCoord.xy, gl_FragCoord.z);
    vec3 to_camera = normalize(view.camera_ws.xyz - position);
    vec2 across = dFdx(rest);
    vec2 along = dFdy(rest);
    // Where a pixel is longer than wide, blurred along less than it takes: grazing views stay crisp.
    float footprint = sqrt(sqrt(dot(across, across) * dot(along, along)));
    WaterBend bend = field_bend(water, rest, footprint);
    bend.by_x += wave_by_x.xyz;
    bend.by_z += wave_by_z;
    bend.variance += wave_by_x.w;
    add_detail(bend, body, rest, footprint);
    vec3 up = water_to_world(water, water_normal(bend));
    float roughness = sqrt(sqrt(kSmooth + bend.variance));  // a normal distribution's alpha is the root of this
#ifdef FROM_BELOW
    bool above = gl_FrontFacing;
#else
    const bool above = true;
#endif
    vec3 normal = above ? up : -up;
    // Waves that turn away from the camera are seen edge on.
    float facing = dot(normal, to_camera);
    normal = facing < 0.02 ? normalize(normal + (0.02 - facing) * to_camera) : normal;
    float cosine = max(dot(normal, to_camera), 1e-3);
    float index = above ? water.shape.w : 1.0 / water.shape.w;
    float share = water_share(water, above, cosine);

    // Light that falls on the water, to be scattered in it or mirrored as glints.
    SurfaceSample s = SurfaceSample(normal, vec3(0.0), vec3(0.0), 1.0, roughness, 0.0, 0u, kModelPbr);
    Reflector r = make_reflector(s, to_camera);
    float head_on = (water.shape.w - 1.0) / (water.shape.w + 1.0);
    r.specular_0 = vec3(head_on * head_on);
    r.specular_90 = vec3(1.0);
    LightSum sum = LightSum(vec3(0.0), vec3(0.0), vec3(0.0));
    if (above) {
        add_directional(sum, r, position, gl_FragCoord.xy);
        add_listed(sum, r, cell_list(gl_FragCoord.xy, view_distance(gl_FragCoord.z)), position, gl_FragCoord.xy);
    }
    vec3 glints = r.specular_0 * (sum.specular - sum.fresnel) + r.specular_90 * sum.fresnel;
    vec3 falling = sum.diffuse / kPi + irradiance_toward(surroundings[0], vec3(0.0, 1.0, 0.0));

    vec3 extinction = water_extinction(water);
    vec3 glow = falling * (kUpwelling * kThrough) * water.scattering.rgb / max(extinction, vec3(1e-6));

    vec3 bent = share < 1.0 ? refract(-to_camera, normal, 1.0 / index) : -normal;
    float depth = water.absorption.w + position.y - water.origin.y;
    float most = above && water.absorption.w > 0.0 ? 1.05 * depth / max(-bent.y, 0.05) : kEndless;
    Seen through = look_through(water, position, normal, bent, most, above);
    vec3 left = exp(-extinction * through.way);
    vec3 seen = through.color * left + glow * (1.0 - left);
    vec3 away = reflect(-to_camera, normal);
    vec3 around = light_from_around(position, normal, away, roughness).mirrored;
    Side side = Side(water.origin.y - 0.02, 1.0);
#ifdef FROM_BELOW
    vec3 scattered = scattered_light(water, 0.0, away);
    if (!above) {
        vec3 sky = light_from_around(position, normal, bent, roughness).mirrored;
        seen = through.way < kEndless ? through.color : sky;
        vec3 ground = mix(scattered, ground_light(water), exp(-extinction * way_to_ground(water, away)));
        around = water.absorption.w > 0.0 ? ground : scattered;
        side = Side(water.origin.y + 0.02, -1.0);
    }
#endif
    Seen found = Seen(around, kEndless);
#if defined(FROM_BELOW) || !defined(UNTRACED)
    found = mirrored(position, away, around, side);
#endif
#ifdef LOOKS
    bool traced = !above || reflection_of(water) == kPictureReflection;
    vec3 mirror = traced ? found.color : around;
#else
    vec3 mirror = found.color;
#endif
#ifdef PLANAR
    if (reflection_of(water) == kPlanarReflection) {
        mirror = planar_reflection(water, position, away, roughness * roughness);
    }
#endif
#ifdef FROM_BELOW
    if (!above) {
        mirror = found.way < kEndless ? mix(scattered, found.color, exp(-extinction * found.way)) : around;
    }
#endif
#ifdef OCEAN
    seen = above ? with_bubbles(seen, bend.foam, falling, extinction) : seen;
#endif
    vec3 color = mix(seen, mirror, share) + glints;
#ifdef OCEAN
    color = above ? with_foam(color, bend.foam, rest, footprint, falling) : color;
#endif
    radiance = vec4(color, 1.0);
#ifdef ATTRIBUTES
    surface = pack_surface(s);
#endif
#ifdef VELOCITY
    vec2 now = 2.0 * gl_FragCoord.xy * view.size.zw - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    velocity = velocity_from(now, clip_before);
#endif
}

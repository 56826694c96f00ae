// The surface of water, seen from above or from below: what it mirrors and what is seen through it, by the Fresnel
// equations; light is lost and scattered on its way through the water (Beer-Lambert). Definitions VELOCITY and those of
// lib/water_detail.glsl and lib/water_reflection.glsl.
#version 450
#define UNMASKED  // the masks of shadow volumes are of the surfaces behind
#define ON_WATER
#include "lib/lighting.glsl"
#include "lib/optics.glsl"
#include "lib/velocity.glsl"
#include "lib/water_surface.glsl"
#include "lib/water_light.glsl"
#include "lib/water_detail.glsl"
#include "lib/water_reflection.glsl"

layout(binding = 5) uniform sampler2D scene_behind;  // water_behind.frag

layout(location = 0) in vec2 rest;
layout(location = 1) flat in int body;
layout(location = 3) in vec4 wave_by_x;
layout(location = 4) in vec3 wave_by_z;
#ifdef VELOCITY
layout(location = 2) in vec3 clip_before;
layout(location = 1) out vec2 velocity;
#endif
layout(location = 0) out vec4 radiance;

const int kMirrorSteps = 10;
const int kBendSteps = 8;
const int kBendHalvings = 4;
const float kSmooth = 1e-5;  // variance of the slopes of ripples that nothing else has
const float kFoamAlbedo = 0.8;
const float kEndless = 1e4;     // way through water [m]
const float kThrough = 0.54;    // of upwelling radiance the surface lets out (Mobley 1999)

// A ray in the picture: at way t it is at clip x, y, w = from + t along.
struct PictureRay {
    vec3 from;
    vec3 along;
};
PictureRay picture_ray(vec3 from, vec3 along) {
    return PictureRay(
        (view.clip_from_world * vec4(from, 1.0)).xyw, (view.clip_from_world * vec4(along, 0.0)).xyw);
}

// Where its point at `way` is in the picture: uv, and its distance along the view axis.
vec3 picture_of(PictureRay ray, float way) {
    vec3 clip = ray.from + way * ray.along;
    return vec3(0.5 + 0.5 * clip.xy / max(clip.z, 1e-6), clip.z);
}
bool in_picture(vec3 p) {
    return p.z > view.camera_ws.w && all(equal(p.xy, clamp(p.xy, 0.0, 1.0)));
}
vec4 behind_at(vec2 uv) {
    return texelFetch(scene_behind, ivec2(uv * view.size.xy), 0);
}
vec3 scene_point(vec2 uv, float distance) {
    return view.camera_ws.xyz + view_ray(uv * view.size.xy) * distance;
}

// The side of the water at rest on which a ray is that leaves its surface.
struct Side {
    float level;  // height of the water at rest, a little toward the other side: waves
    float up;     // 1: above, -1: below
};

// Whether the picture shows something at `at` (uv, distance) that is nearer than it, and on the same side of the
// water at rest as the ray.
bool is_hidden(vec3 at, Side side) {
    float seen = behind_at(at.xy).w;
    return seen > 0.0 && seen < at.z && side.up * (scene_point(at.xy, seen).y - side.level) > 0.0;
}

// What is seen along a ray that leaves the surface: the picture itself where it shows it, with the way to it [m], else
// `around`, after an endless way.
vec4 mirrored(vec3 position, vec3 direction, vec3 around, Side side) {
    PictureRay ray = picture_ray(position, direction);
    float way = 0.02 * distance(position, view.camera_ws.xyz) + 0.05;
    float last = 0.0;
    for (int i = 0; i < kMirrorSteps; ++i) {
        vec3 at = picture_of(ray, way);
        if (!in_picture(at)) {
            // Under water there is no sky to see instead: what is at the edge of the picture goes on.
            vec2 edge = clamp(at.xy, vec2(0.001), vec2(0.999));
            vec4 found = behind_at(edge);
            bool goes_on = side.up < 0.0 && found.w > 0.0 && scene_point(edge, found.w).y < side.level;
            return goes_on && at.z > view.camera_ws.w ? vec4(found.rgb, way) : vec4(around, kEndless);
        }
        if (is_hidden(at, side)) {
            // Between the last step and this one it went behind something: where?
            float low = last;
            float high = way;
            for (int j = 0; j < 4; ++j) {
                float middle = 0.5 * (low + high);
                bool hidden = is_hidden(picture_of(ray, middle), side);
                low = hidden ? low : middle;
                high = hidden ? middle : high;
            }
            vec3 hit = picture_of(ray, high);
            vec4 found = behind_at(hit.xy);
            // Far behind what hides it, it meets something that the picture does not show.
            float gap = hit.z - found.w;
            vec2 edge = min(hit.xy, 1.0 - hit.xy);
            float trust = clamp(min(edge.x, edge.y) * 12.0, 0.0, 1.0)
                          * clamp(2.0 - gap / (0.5 * (way - last) + 0.05), 0.0, 1.0);
            return vec4(mix(around, found.rgb, trust), trust > 0.5 ? high : kEndless);
        }
        last = way;
        way *= 1.7;
    }
    return vec4(around, kEndless);
}

struct Through {
    vec3 color;
    float way;  // through the water [m]
};

// What a bent ray meets, as far as the picture shows it: steps to where it has gone behind something, then between
// the last two. What stands before the water is not in it. `most`: way after which there is something for certain [m].
Through seen_through(vec3 position, vec3 direction, vec2 uv, float most) {
    PictureRay ray = picture_ray(position, direction);
    float here = ray.from.z;
    vec4 straight = behind_at(uv);
    float way = straight.w > 0.0 ? (straight.w - here) * length(view_ray(gl_FragCoord.xy)) : kEndless;
    // Rays that leave the picture are bent less, so that its edge is not drawn out: from half way to it on.
    vec2 shift = picture_of(ray, min(way, most)).xy - uv;
    vec2 room = mix(1.0 - uv, uv, lessThan(shift, vec2(0.0)));
    vec2 shares = room / max(2.0 * abs(shift), vec2(1e-6));
    direction = normalize(mix(normalize(position - view.camera_ws.xyz), direction, min(min(shares.x, shares.y), 1.0)));
    ray = picture_ray(position, direction);
    float reach = min(most, min(3.0 * way + 0.5, kEndless));
    float low = 0.0;
    float high = reach;
    vec3 shown = straight.rgb;  // of the way so far, where what stands before the water does not cover it
    for (int i = 1; i <= kBendSteps; ++i) {
        float share = float(i) / float(kBendSteps);
        float there = reach * share * share;
        vec3 at = picture_of(ray, there);
        vec4 scene = behind_at(clamp(at.xy, vec2(0.001), vec2(0.999)));
        shown = scene.w > here ? scene.rgb : shown;
        high = there;
        if (scene.w > here && scene.w < at.z) {
            break;
        }
        low = there;
    }
    for (int j = 0; j < kBendHalvings; ++j) {
        float middle = 0.5 * (low + high);
        vec3 at = picture_of(ray, middle);
        float seen = behind_at(clamp(at.xy, vec2(0.001), vec2(0.999))).w;
        bool hidden = seen > here && seen < at.z;
        low = hidden ? low : middle;
        high = hidden ? middle : high;
    }
    vec4 found = behind_at(clamp(picture_of(ray, high).xy, vec2(0.001), vec2(0.999)));
    shown = found.w > here ? found.rgb : shown;
    bool endless = straight.w <= 0.0 && high >= reach;
    return Through(shown, endless ? kEndless : high);
}

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
    bool above = gl_FrontFacing;
    vec3 normal = above ? up : -up;
    // Waves that turn away from the camera are seen edge on.
    float facing = dot(normal, to_camera);
    normal = facing < 0.02 ? normalize(normal + (0.02 - facing) * to_camera) : normal;
    float cosine = max(dot(normal, to_camera), 1e-3);
    float index = above ? water.shape.w : 1.0 / water.shape.w;
    float share = water_share(water, above, cosine);
    vec2 uv = gl_FragCoord.xy * view.size.zw;

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

    vec3 seen = vec3(0.0);
    if (share < 1.0) {
        vec3 bent = refract(-to_camera, normal, 1.0 / index);
        float depth = water.absorption.w + position.y - water.origin.y;
        float most = above && water.absorption.w > 0.0 ? 1.05 * depth / max(-bent.y, 0.05) : kEndless;
        Through through = seen_through(position, bent, uv, most);
        if (above) {
            vec3 left = exp(-extinction * through.way);
            seen = through.color * left + glow * (1.0 - left);
        } else {
            vec3 sky = light_from_around(position, normal, bent, roughness).mirrored;
            seen = through.way < kEndless ? through.color : sky;
        }
    }
    vec3 away = reflect(-to_camera, normal);
    vec3 mirror;
    if (above) {
        mirror = light_from_around(position, normal, away, roughness).mirrored;
#ifndef UNTRACED
        if (reflection_of(water) == kPictureReflection) {
            mirror = mirrored(position, away, mirror, Side(water.origin.y - 0.02, 1.0)).rgb;
        }
#endif
#ifdef PLANAR
        if (reflection_of(water) == kPlanarReflection) {
            mirror = planar_reflection(water, position, away, roughness * roughness);
        }
#endif
    } else {
        vec3 scattered = scattered_light(water, 0.0, away);
        vec3 around = scattered;
        if (water.absorption.w > 0.0) {
            around = mix(scattered, ground_light(water), exp(-extinction * way_to_ground(water, away)));
        }
        vec4 found = mirrored(position, away, around, Side(water.origin.y + 0.02, -1.0));
        mirror = found.w < kEndless ? mix(scattered, found.rgb, exp(-extinction * found.w)) : around;
    }
    vec3 color = mix(seen, mirror, share) + glints;
    radiance = vec4(mix(color, kFoamAlbedo * falling, above ? smoothstep(0.3, 0.9, bend.foam) : 0.0), 1.0);
#ifdef VELOCITY
    vec2 now = 2.0 * uv - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    velocity = velocity_from(now, clip_before);
#endif
}

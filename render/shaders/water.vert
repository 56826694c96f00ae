// A body of water as displaced patches of its rest surface (water_patches.h). Definition VELOCITY.
#version 450
#include "lib/view.glsl"
#include "water_gpu.h"
const float kPi = 3.14159265358979;
#include "lib/water_surface.glsl"

layout(binding = kWaterPatchesUnit) uniform samplerBuffer patches;  // WaterPatch

uniform int first_patch;

layout(location = 0) out vec2 rest;           // x and z at rest, in water space
layout(location = 1) flat out int body;
layout(location = 3) out vec4 wave_by_x;  // derivative of analytic waves; w: variance of unresolved slopes
layout(location = 4) out vec3 wave_by_z;
#ifdef VELOCITY
layout(location = 2) out vec3 previous_clip;    // previous clip x, y, w
#endif

const int kCorners = kWaterGrid + 1;  // along a side of a patch

vec3 surface_ws(WaterRecord water, vec2 q, vec3 offset) {
    return water.origin.xyz + water_to_world(water, vec3(q.x, 0.0, q.y) + offset);
}

void main() {
    int patch_index = first_patch + gl_InstanceID;
    vec4 square = texelFetch(patches, 2 * patch_index);
    vec4 morph = texelFetch(patches, 2 * patch_index + 1);
    vec2 grid = vec2(gl_VertexID % kCorners, gl_VertexID / kCorners);
    body = int(square.w);
    WaterRecord water = water_record(body);
    water.waves.y = morph.z;  // only lines that its vertices resolve

    vec2 half_size = water.shape.yz;
    vec2 bounds = mix(vec2(1e9), half_size, greaterThan(half_size, vec2(0.0)));
    float cell = square.z / float(kWaterGrid);
    vec2 q = square.xy + grid * cell;
    vec3 eye = world_to_water(water, view.camera_ws.xyz - water.origin.xyz);
    float away = distance(eye, vec3(q.x, 0.0, q.y));
    float slid = clamp((away - morph.x) / (morph.y - morph.x), 0.0, 1.0);
    q -= fract(grid * 0.5) * 2.0 * cell * slid;
    q = clamp(q, -bounds, bounds);

    rest = q;
    float spacing = cell * (1.0 + slid);
    WaterMotion waves = wave_motion(water, q, spacing, false);
    wave_by_x = vec4(waves.bend.by_x, waves.bend.variance + morph.w);
    wave_by_z = waves.bend.by_z;
    vec3 offset = waves.offset + field_offset(water, q, spacing, false);
    gl_Position = view.clip_from_world * vec4(surface_ws(water, q, offset), 1.0);
#ifdef VELOCITY
    vec3 previous_offset = water_offset(water, q, spacing, true);
    previous_clip = (view.previous_clip_from_world * vec4(surface_ws(water, q, previous_offset), 1.0)).xyw;
#endif
}

// Relief below the mesh: the surface hooks that find the point of it that is visible. Definitions:
//   RELIEF_MAP       the texture unit of the map
//   RELIEF_PARALLAX  one lookup shifts the maps, and nothing else
//   RELIEF_LINEAR    linear search and one secant step
//   RELIEF_CONES     cone stepping
//   RELIEF_CLOSED    the relief has a back surface; texels without a surface are holes
//   RELIEF_CURVED    the ray bends with the mesh's quadric and may leave the relief: a hole
//   RELIEF_BOX       the relief is in a box (lib/relief_box.glsl)
//   RELIEF_BUMP      normals from differences of depth, and nothing else
//   RELIEF_RAYS      with KEY_SHADOWS: a second ray finds whether the key lights are visible
//   RELIEF_BOTTOM    with SHADOW_CASTER: the depth of the bottom, so that no shadow falls on the relief itself
//   RELIEF_DISPLACED the mesh is the relief: normals of the map, and nothing else
//   RELIEF_ODD       one lookup in an omni-directional displacement map
//   OBJECT_NORMALS   without relief: the normal map holds normals in mesh space
// Techniques: bump.height-field, bump.object-space-map, relief.cap, relief.composite, relief.depth-correct, relief.double-depth, relief.filter,
//     relief.parallax, relief.permutations, relief.planar, relief.self-shadow, relief.silhouette, relief.tangent,
//     relief.tangent-shadow, shadow.relief-cast, shadow.relief-matrix, shadow.relief-receive, shadow.relief-self

#include "lib/key_lights.glsl"
#include "lib/view.glsl"

#if defined(OBJECT_NORMALS) && defined(NORMAL_MAP) && !defined(LIT_AT_VERTICES)
#define MESH_SPACE_NORMALS
layout(location = 12) flat in mat3 world_from_normal;
#endif

#if defined(RELIEF_MAP) && !defined(LIT_AT_VERTICES)
#define RELIEF
#define FINE_NORMALS
layout(location = 10) in vec4 relief_position;
#ifdef RELIEF_CURVED
layout(location = 11) in vec2 relief_curvature;
#endif

// Shadow maps have this relief, found in their own mip level.
#if defined(OFF_MESH) && !defined(RELIEF_BOTTOM) && !defined(RELIEF_BOX)
#define RELIEF_CAST
#endif

float relief_lod = 0.0;  // of undisplaced texture coordinates: those found by the search are not smooth
#define RELIEF_TEXEL(at) textureLod(material_maps[RELIEF_MAP], vec3(at, map_layer(map_layers, kReliefSlot)), relief_lod)
#ifdef RELIEF_BOX
float relief_start = 0.0;  // depth at which the ray enters the box, from which others count
#undef RELIEF_TEXEL
#define RELIEF_TEXEL(at) (textureLod(material_maps[RELIEF_MAP], vec3(at, map_layer(map_layers, kReliefSlot)), relief_lod) - vec4(0.0, 0.0, relief_start, relief_start))
#endif
#include "relief_gpu.h"
#include "relief_search_gpu.h"
#ifdef RELIEF_ODD
#include "lib/odd_map.glsl"
vec3 odd_normal = vec3(0.0, 0.0, 1.0);  // in tangent space
#endif

// Unit, away from the eye, of any projection.
vec3 ray_through(vec3 position_ws, vec4 clip) {
    mat4 rows = transpose(view.clip_from_world);
    vec2 ndc = clip.xy / clip.w;
    vec3 ray = cross(rows[0].xyz - ndc.x * rows[3].xyz, rows[1].xyz - ndc.y * rows[3].xyz);
    // Depth is reversed: it falls along the ray.
    float gain = dot(rows[2].xyz, ray) * clip.w - clip.z * dot(rows[3].xyz, ray);
    return normalize(gain > 0.0 ? -ray : ray);
}

// What moves by a step along the surface, from its derivatives over the image.
struct ReliefFrame {
    vec3 normal;  // unit, toward the eye
    vec3 dual_x;  // dot(step, dual_x) is the step in pixels along x
    vec3 dual_y;
};

ReliefFrame relief_frame(vec3 normal) {
    vec3 dx = dFdx(relief_position.xyz);
    vec3 dy = dFdy(relief_position.xyz);
    vec3 dual_x = cross(dy, normal);
    vec3 dual_y = cross(normal, dx);
    float area = dot(dx, dual_x);
    float scale = abs(area) > 1e-30 ? 1.0 / area : 0.0;
    return ReliefFrame(normal, dual_x * scale, dual_y * scale);
}

// Change of texture coordinates along a step.
vec4 relief_travel(ReliefFrame frame, vec3 step_ws) {
    return dot(step_ws, frame.dual_x) * dFdx(uv) + dot(step_ws, frame.dual_y) * dFdy(uv);
}

#if defined(RELIEF_CLOSED)
const bool kReliefIsClosed = true;
#else
const bool kReliefIsClosed = false;
#endif

// Depth of the relief in the world [m], > 0.
float relief_meters(vec4 search) {
    return max(search.x * relief_position.w, 1e-6);
}

// The visible point that the search found.
float relief_found = 0.0;  // its depth, of that of the relief; 0: on the mesh
vec4 relief_found_uv;

// How the mesh's quadric falls away along a direction [1/m].
float relief_fall(vec3 direction_ws, vec3 normal) {
#ifdef RELIEF_CURVED
    vec3 bitangent = cross(normal, tangent_ws.xyz) * tangent_ws.w;
    vec2 along = vec2(dot(direction_ws, tangent_ws.xyz), dot(direction_ws, bitangent));
    return dot(relief_curvature, along * along);
#else
    return 0.0;
#endif
}

const float kLevelBlend = 0.3;  // of the distance between two mip levels

void find_relief_lod() {
    vec2 size = vec2(textureSize(material_maps[RELIEF_MAP], 0).xy);
    vec2 dx = map_gradient(kReliefSlot, dFdx(uv)) * size;
    vec2 dy = map_gradient(kReliefSlot, dFdy(uv)) * size;
    float level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12));
#ifdef RELIEF_CAST
    level -= 1.0;  // nearer to what the shadow map has, or the difference would shadow itself
#endif
    // Mostly whole, where each step of a search filters one level and not two; between them a narrow blend.
    float whole = floor(level);
    relief_lod = max(whole + clamp((level - whole - 0.5) / kLevelBlend + 0.5, 0.0, 1.0), 0.0);
}
#ifdef RELIEF_BOX
#include "lib/relief_box.glsl"
#endif
#endif

#ifdef RELIEF
// Fewer for rays head on, which pass less of the map.
int relief_steps(float most, float cosine) {
    return int(most * mix(1.0, 0.35, cosine) + 0.5);
}

// Of `steps`, no more than two per texel of the level, whose surface is smooth between.
int relief_steps_of_texels(int steps, ReliefRay ray) {
    vec2 texels = ray.travel * vec2(textureSize(material_maps[RELIEF_MAP], 0).xy) * exp2(-relief_lod);
    return min(steps, int(2.0 * length(texels) + 3.5));
}
#endif

#if defined(RELIEF_BOTTOM) && defined(SHADOW_CASTER)
#define RELIEF_ONLY_HOLES
// The outline of a relief without holes is that of its mesh: it needs no search.
#if !defined(RELIEF_CLOSED) && !defined(RELIEF_CURVED)
#define RELIEF_SKIPPED
#endif
#endif

void relief_uv(inout vec4 uv) {
#if defined(RELIEF) && defined(RELIEF_BOX) && defined(RELIEF_SLICES)
    vec3 fragment_ws = relief_position.xyz + view.camera_ws.xyz;
    find_in_box(uv, ray_through(fragment_ws, view.clip_from_world * vec4(fragment_ws, 1.0)));
#elif defined(RELIEF) && !defined(RELIEF_BUMP) && !defined(RELIEF_DISPLACED)
    vec4 search = block_texel(material_and_flags.x, kReliefBlock, 0);
    float depth = relief_meters(search);
    vec3 position_ws = relief_position.xyz + view.camera_ws.xyz;
    vec4 clip = view.clip_from_world * vec4(position_ws, 1.0);
    vec3 ray_ws = ray_through(position_ws, clip);
#ifdef RELIEF_BOX
    find_in_box(uv, ray_ws, clip, search);
#else
    vec3 normal = normalize(normal_ws);
    float down = -dot(ray_ws, normal);
    ReliefFrame frame = relief_frame(normal);
    find_relief_lod();
    bool is_back = down <= 0.0;
#if defined(RELIEF_CLOSED) || defined(RELIEF_CURVED)
    // A back face has a hole where the ray into it, the other way, finds nothing.
    ray_ws = is_back ? -ray_ws : ray_ws;
    down = abs(down);
#else
    if (is_back) {
        return;
    }
#endif
#ifdef RELIEF_PARALLAX
    float shift = depth * (RELIEF_TEXEL(map_coordinates(kReliefSlot, uv)).w - 0.5);  // not divided by the cosine: bounded
    uv += relief_travel(frame, shift * (ray_ws + down * normal));
#else
    float limited = max(down, kMinReliefCosine);
    vec2 range = vec2(depth / limited, 1.0);
    float fall = 0.0;
#ifdef RELIEF_CURVED
    fall = relief_fall(ray_ws, normal);
    range = relief_range(limited, fall, depth);
#endif
    vec4 travel = relief_travel(frame, range.x * (ray_ws + down * normal));
    ReliefRay ray = ReliefRay(
        map_coordinates(kReliefSlot, uv), map_gradient(kReliefSlot, travel), limited * range.x / depth,
        fall * range.x * range.x / depth);
    int steps = relief_steps(search.y, down);
    int refinements = int(search.z);
#ifndef RELIEF_CONES
    int fewer = max(relief_steps_of_texels(steps, ray), 1);
    refinements += int(ceil(log2(float(max(steps, 1)) / float(fewer))));  // as exact as with all
    steps = min(steps, fewer);
#endif
#ifdef RELIEF_ONLY_HOLES
    refinements = 0;
#ifdef RELIEF_CURVED
    steps = range.y > 0.0 ? 0 : steps;  // it hits the bottom at the latest
#endif
#endif
#if defined(RELIEF_SKIPPED)
    float x = 1.0;
#elif defined(RELIEF_ODD)
    vec3 bitangent = cross(normal, tangent_ws.xyz) * tangent_ws.w;
    vec3 to_viewer = vec3(-dot(ray_ws, tangent_ws.xyz), -dot(ray_ws, bitangent), down);
    vec4 seen = odd_lookup(map_coordinates(kReliefSlot, uv), to_viewer, relief_lod - log2(float(kOddDirections)));
    odd_normal = search.x > 0.0 ? seen.xyz : odd_normal;
    float x = seen.w;
#elif defined(RELIEF_CONES)
    float x = relief_search_cones(ray, steps, refinements);
#elif defined(RELIEF_LINEAR)
    float x = relief_search_linear(ray, steps);
#elif defined(RELIEF_CLOSED)
    float x = relief_search(ray, steps, refinements, true);
#else
    float x = relief_search(ray, steps, refinements, false);
#endif
#if defined(RELIEF_CLOSED)
    surface_hole = x > 1.0;
#elif defined(RELIEF_CURVED)
    surface_hole = x > 1.0 && range.y == 0.0;
#endif
    if (is_back) {
        return;
    }
#ifdef RELIEF_ONLY_HOLES
    x = 1.0;
#endif
    x = min(x, 1.0);
    uv += travel * x;
    relief_found = relief_depth_at(ray, x);
    relief_found_uv = uv;
    surface_offset = ray_ws * (range.x * x);
    vec4 moved = clip + view.clip_from_world * vec4(surface_offset, 0.0);
    surface_depth = min(gl_FragCoord.z, moved.z / moved.w);
#endif
#endif
#endif
}

void relief_normal(inout vec3 normal) {
#ifdef MESH_SPACE_NORMALS
    // In the frame of the mesh, whatever its tangents are.
    vec3 normal_wanted = normalize(world_from_normal * (MAP_TEXEL(NORMAL_MAP, kNormalSlot).xyz * 2.0 - 1.0));
    normal = inverse(mat3(tangent_ws.xyz, cross(normal_ws, tangent_ws.xyz) * tangent_ws.w, normal_ws)) * normal_wanted;
#endif
#ifdef RELIEF
#ifdef RELIEF_BUMP
    // Slopes of the height over a texel, in meters of the mesh to either side (Blinn 1978).
    find_relief_lod();
    vec4 search = block_texel(material_and_flags.x, kReliefBlock, 0);
    vec2 at = map_coordinates(kReliefSlot, map_uv);
    ReliefFrame frame = relief_frame(normalize(normal_ws));
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    vec2 texel = exp2(relief_lod) / vec2(textureSize(material_maps[RELIEF_MAP], 0).xy);
    vec2 slope_uv = vec2(
        RELIEF_TEXEL(at + vec2(texel.x, 0.0)).w - RELIEF_TEXEL(at - vec2(texel.x, 0.0)).w,
        RELIEF_TEXEL(at + vec2(0.0, texel.y)).w - RELIEF_TEXEL(at - vec2(0.0, texel.y)).w) / (2.0 * texel);
    slope_uv *= search.x * relief_position.w;
    // A step along the tangent changes uv by relief_travel(), so the depth by its product with the slope.
    vec2 slope = vec2(
        dot(slope_uv, map_gradient(kReliefSlot, relief_travel(frame, tangent_ws.xyz))),
        dot(slope_uv, map_gradient(kReliefSlot, relief_travel(frame, bitangent))));
    normal.xy += normal.z * slope * material_texel(1).w;
#elif defined(RELIEF_ODD)
    float up = max(odd_normal.z, 0.05);
    normal = vec3(normal.xy * up + normal.z * material_texel(1).w * odd_normal.xy, normal.z * up);
#else
    vec2 n = MAP_TEXEL(RELIEF_MAP, kReliefSlot).xy * 2.0 - 1.0;
    float z = sqrt(max(1.0 - dot(n, n), 0.01));
    normal.xy += normal.z * material_texel(1).w * n / z;  // slopes of heights add up
#ifdef RELIEF_BOX
    normal = dot(box_normal_ts, box_normal_ts) > 0.0 ? normalize(box_normal_ts) : normal;
#endif
#endif
#endif
}

#if defined(RELIEF) && defined(RELIEF_RAYS) && defined(KEY_SHADOWS) && !defined(RELIEF_BUMP) && !defined(RELIEF_DISPLACED) && !defined(RELIEF_ODD)
#define RELIEF_LIGHT_RAYS
#endif

#ifdef RELIEF_LIGHT_RAYS
// The fraction of the light from a direction that the relief lets through to the point that the search found.
float relief_light(ReliefFrame frame, vec4 search, vec3 to_light) {
    float relief = relief_meters(search);
    float up = dot(to_light, frame.normal);
    float limited = max(up, kMinReliefCosine);
    float fall = relief_fall(to_light, frame.normal);
    float length = relief_way_out(limited, fall, relief_found * relief);
    vec4 travel = relief_travel(frame, length * (to_light - up * frame.normal));
    ReliefRay ray = relief_light_ray(
        map_coordinates(kReliefSlot, relief_found_uv), map_gradient(kReliefSlot, travel), limited, fall, length, relief);
    int most = relief_steps_of_texels(relief_steps(search.y, limited), ray);
    float steps = 0.5 * float(most) * relief_found;  // an edge may be late
    bool lit = up > 0.0 && relief_found > kReliefShadowThreshold;
    float visible = relief_visibility(ray, relief_found, lit ? int(steps) + 2 : 0, kReliefIsClosed);
    return up >= 0.0 ? visible : 0.0;
}
#endif

void relief_sample(inout SurfaceSample s, vec3 smooth_normal) {
#ifdef RELIEF_LIGHT_RAYS
    vec4 search = block_texel(material_and_flags.x, kReliefBlock, 0);
    ReliefFrame frame = relief_frame(normalize(normal_ws));
    vec3 position_ws = relief_position.xyz + view.camera_ws.xyz + surface_offset;
    ivec2 keys = key_lights();
    s.key_visibility.x = relief_light(frame, search, to_key_light(keys.x, position_ws));
    s.key_visibility.y = relief_light(frame, search, to_key_light(keys.y, position_ws));
#endif
}

// The surface hooks of wrinkles, called by lib/material.glsl. Definitions:
//   WRINKLE_MAP    the texture unit of the map of wrinkles
//   WRINKLE_BLEND  lighting of full wrinkles and of smooth skin is blended
//   WRINKLE_FADE   light at grazing angles to smooth skin fades
//   WRINKLE_SHADE  lit slopes are darkened
//   WRINKLE_BOUNCE  light bounces within isometric folds (lib/fold_light.glsl)
//   WRINKLE_VIEW   instead of the color, the skin's strain in its tangent frame; wrinkle_strength is (tt, bb, tb), and
//                  w 1 where that frame is known
//   WRINKLE_MODEL  the wrinkle map is a model of the strain: wrinkle_strength is (tt, bb, tb), and w the weight of its slopes
//   WRINKLE_LAYERS  the wrinkle map has two layers: wrinkle_strength is of the slopes and then the shade of both. No more,
//                  as the map has four channels and the strength four numbers; WrinkleMaps add two maps to the normals.
//   WRINKLE_INDEPENDENT  the second one covers the first
//   WRINKLE_PHOTO  light from above the map is painted on
//   WRINKLE_COLUMNS  each column of the image has a method of its own (WrinkleColumns): wrinkle_strength is that of isometric
//                  folds, and that of all others
//   WRINKLE_FLAT   strengths are those of one vertex of each triangle
// Techniques: face.wrinkle-model, face.wrinkle-options, wrinkle.comparison,
//     wrinkle.compression.alpha-directional, wrinkle.compression.alpha-shading,
//     wrinkle.compression.bump-blend, wrinkle.compression.interp-bump, wrinkle.compression.map,
//     wrinkle.compression.normal-fit, wrinkle.compression.overlap, wrinkle.compression.tangent-frame

#include "lib/view.glsl"
#include "lib/wrinkle.glsl"
#include "lib/wrinkle_model.glsl"
#include "wrinkle_columns_gpu.h"

#if defined(WRINKLE_MAP) && !defined(LIT_AT_VERTICES)
#define WRINKLES
#define FINE_NORMALS
#endif

#if defined(WRINKLES) || (defined(WRINKLE_VIEW) && !defined(LIT_AT_VERTICES))
#ifdef WRINKLE_FLAT
flat
#endif
layout(location = 8) in vec4 wrinkle_strength;  // x, y: of slopes, unchanged and lifted; z, w: of shade
#endif

#ifdef WRINKLES
#ifdef WRINKLE_MODEL
vec4 model_tile(vec3 at, int tile, int tiles, float half_texel) {
    at.y = (float(tile) + clamp(at.y, half_texel, 1.0 - half_texel)) / float(tiles);
    return texture(material_maps[WRINKLE_MAP], at);
}

// The slope of wrinkles at this strain.
vec2 wrinkle_slope_here() {
    vec3 at = map_texcoord(kWrinkleSlot);
    vec2 size = vec2(textureSize(material_maps[WRINKLE_MAP], 0).xy);
    int tiles = int(size.y / size.x + 0.5);
    float half_texel = 0.5 / size.x;
    vec4 range = model_tile(at, 0, tiles, half_texel);
    vec4 range_tb = model_tile(at, 1, tiles, half_texel);
    vec3 x = model_strain(wrinkle_strength.xyz, range, range_tb);
    vec2 slope = vec2(0.0);
    for (int tile = 2; tile < tiles; ++tile) {
        vec4 coefficients = model_tile(at, tile, tiles, half_texel);
        slope += coefficients.xy * model_term(x, 2 * tile - 4) + coefficients.zw * model_term(x, 2 * tile - 3);
    }
    return slope;
}
#elif defined(WRINKLE_LAYERS)
vec4 wrinkle_slopes_here() {
    return wrinkle_slopes(texture(material_maps[WRINKLE_MAP], map_texcoord(kWrinkleSlot)));
}

vec2 wrinkle_slope_here() {
    vec4 slopes = wrinkle_slopes_here();
#ifdef WRINKLE_INDEPENDENT
    return covered_slope(slopes, clamp(wrinkle_strength.xy, 0.0, 1.0));
#else
    return wrinkle_strength.x * slopes.xy + wrinkle_strength.y * slopes.zw;
#endif
}
#else
vec2 wrinkle_slope_here() {
    return wrinkle_slope(texture(material_maps[WRINKLE_MAP], map_texcoord(kWrinkleSlot)).xyz);
}
#endif

#ifdef WRINKLE_COLUMNS
UNIFORM_BLOCK(kWrinkleColumnsBinding, Columns, WrinkleColumns, columns, column_blocks);

// The method of this pixel's column.
uint column_method() {
    float x = (gl_FragCoord.x * view.size.z - columns.left) / (columns.right - columns.left);
    int column = clamp(int(floor(x * float(columns.count))), 0, int(columns.count) - 1);
    return columns.methods >> (4 * column) & 15u;
}

// Its strengths, in the layout of wrinkle_strength for images with a single method.
vec4 column_strength(uint method) {
    bool steep = method == kWrinkleBump || method == kWrinkleIsometric || method == kWrinkleBlend;
    return (method == kWrinkleIsometric ? wrinkle_strength.x : wrinkle_strength.y) * vec4(
        steep ? 1.0 : 0.0,
        method == kWrinkleSphere ? 1.0 : 0.0,
        method == kWrinkleAlpha || method == kWrinklePhoto ? 1.0 : 0.0,
        method == kWrinkleDirectional ? 1.0 : 0.0);
}
#endif

// Factor of the color of darkened slopes.
float shaded_slope(vec2 slope, vec4 strength) {
    return 1.0 - clamp(strength.z * wrinkle_shade(slope, false) + strength.w * wrinkle_shade(slope, true), 0.0, 1.0);
}

// Factor of the color of slopes in painted light.
float painted_slope(vec2 slope, float strength) {
    return mix(1.0, painted_light(slope), clamp(strength, 0.0, 1.0));
}
#endif

#if defined(WRINKLE_VIEW) && !defined(LIT_AT_VERTICES)
const float kCrossCell = 22.0;  // [px]

// Projects a direction on the surface to the screen [px]; a unit vector parallel to the screen has half the size of a
// cell.
vec2 screen_direction(vec3 direction_ws) {
    vec4 moved = view.clip_from_world * vec4(direction_ws, 0.0);
    vec2 ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0;
    vec2 projected = (moved.xy - ndc * moved.w) * view.size.xy;
    float scale = view.size.x * length(vec3(view.clip_from_world[0].x, view.clip_from_world[1].x, view.clip_from_world[2].x));
    return projected * (0.5 * kCrossCell / scale);
}

vec3 strain_view() {
    vec4 principal = principal_strain(wrinkle_strength.xyz);
    vec3 color = strain_color(principal);
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    vec2 cover = strain_cross(
        mod(gl_FragCoord.xy, kCrossCell) - 0.5 * kCrossCell, principal,
        screen_direction(principal.z * tangent_ws.xyz + principal.w * bitangent),
        screen_direction(-principal.w * tangent_ws.xyz + principal.z * bitangent));
    cover *= wrinkle_strength.w;
    vec2 stretched = step(vec2(0.0), principal.xy);
    color = mix(color, mix(vec3(0.12, 0.0, 0.0), vec3(0.0, 0.0, 0.15), stretched.x), cover.x);
    return mix(color, mix(vec3(0.12, 0.0, 0.0), vec3(0.0, 0.0, 0.15), stretched.y), cover.y);
}
#endif

#ifdef WRINKLES
// How much slopes darken the light of a pixel (wrinkle.compression.alpha-shading).
float slope_shade() {
#if defined(WRINKLE_MODEL) || defined(WRINKLE_PHOTO)
    return 1.0;
#elif defined(WRINKLE_LAYERS)
    vec4 slopes = wrinkle_slopes_here();
    return (1.0 - clamp(wrinkle_strength.z * wrinkle_shade(slopes.xy, false), 0.0, 1.0))
        * (1.0 - clamp(wrinkle_strength.w * wrinkle_shade(slopes.zw, false), 0.0, 1.0));
#elif defined(WRINKLE_COLUMNS)
    uint method = column_method();
    return method == kWrinklePhoto ? 1.0 : shaded_slope(wrinkle_slope_here(), column_strength(method));
#else
    return shaded_slope(wrinkle_slope_here(), wrinkle_strength);
#endif
}
#endif

void wrinkle_color(inout vec4 color) {
#if defined(WRINKLES) && defined(WRINKLE_COLUMNS)
    uint method = column_method();
    if (method == kWrinklePhoto) {
        color.rgb *= painted_slope(wrinkle_slope_here(), column_strength(method).z);
    }
#elif defined(WRINKLES) && defined(WRINKLE_PHOTO)
    color.rgb *= painted_slope(wrinkle_slope_here(), wrinkle_strength.z);
#endif
}

void wrinkle_normal(inout vec3 normal) {
#ifdef WRINKLES
    vec2 slope = wrinkle_slope_here();
#ifdef WRINKLE_MODEL
    slope *= wrinkle_strength.w;
#elif defined(WRINKLE_LAYERS)
#elif defined(WRINKLE_COLUMNS)
    uint method = column_method();
    vec4 strength = column_strength(method);
    vec2 raised = strength.x * slope + lifted_slope(slope, strength.y);
    slope = method == kWrinkleBlend ? slope : raised;
#elif !defined(WRINKLE_BLEND)
    slope = wrinkle_strength.x * slope + lifted_slope(slope, wrinkle_strength.y);
#endif
    normal.xy -= normal.z * slope;  // slopes of both heights add up
#endif
}

void wrinkle_sample(inout SurfaceSample s, vec3 smooth_normal) {
#if defined(WRINKLE_VIEW) && !defined(LIT_AT_VERTICES)
    s.albedo = strain_view();
#endif
#if defined(WRINKLES) && defined(SMOOTH_NORMALS)
    s.smooth_normal_ws = smooth_normal;
    bool stores = s.model != kModelUnlit && s.model != kModelHair;  // in the texel of the emission
#ifdef WRINKLE_BLEND
#ifdef WRINKLE_COLUMNS
    bool blends = column_method() == kWrinkleBlend;
    float raised = wrinkle_strength.y;
#else
    const bool blends = true;
    float raised = wrinkle_strength.x;
#endif
    if (blends) {
        s.raised = clamp(raised, 0.0, 1.0);
        s.smooth_is_stored = stores && s.raised > 0.0;
        s.normal_ws = s.raised > 0.0 ? s.normal_ws : smooth_normal;  // bit-identical to skin without wrinkles
    }
#endif
#ifdef WRINKLE_BOUNCE
#ifdef WRINKLE_COLUMNS
    bool folds = column_method() == kWrinkleIsometric;
#else
    const bool folds = true;
#endif
    s.bounces = folds && stores && s.emission == vec3(0.0) && s.normal_ws != smooth_normal;
    s.smooth_is_stored = s.smooth_is_stored || s.bounces;
#endif
#ifdef WRINKLE_FADE
    s.fades = true;
    s.smooth_is_stored = stores;
#endif
#ifdef WRINKLE_SHADE
    // The word of the emission has room for it unless skin emits or needs its smooth normal: then its color is darkened.
    float shade = slope_shade();
    bool needs_smooth = s.smooth_is_stored && s.raised < 1.0 || s.bounces || s.bump_shadow > 0u || (s.fades && s.normal_ws != smooth_normal);
    if (stores && !needs_smooth && s.emission == vec3(0.0)) {
        s.shade = shade;
        s.raised = 1.0;
        s.smooth_is_stored = s.smooth_is_stored || shade < 1.0;
    } else {
        s.albedo *= shade;
    }
#endif
#endif
}

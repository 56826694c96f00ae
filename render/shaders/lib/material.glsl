// The surface of a material at a point: factors times textures. Which textures exist is fixed at compile time,
// since a software OpenGL executes both sides of every branch:
//   BASE_COLOR_MAP METAL_ROUGH_MAP NORMAL_MAP OCCLUSION_MAP EMISSION_MAP WRINKLE_MAP DETAIL_MAP THICKNESS_MAP  each is the texture unit of the map
//   OCCLUSION_SHARED  occlusion is the red channel of the metal-rough map
//   VERTEX_COLOR   the mesh has colors
//   UV_MAP         all maps share a uv set and transform; otherwise they use the first set untransformed
//   UV_MAPS        each has its own
//   SRGB_BASE_COLOR  the texture is sRGB, filtered encoded and decoded here, because a software
//                  OpenGL is slow at decoding every texel; its mip levels were made in linear light
//   DOUBLE_SIDED   normals of back faces are flipped toward the viewer
//   LIT_AT_VERTICES  no normals, only colors
//   STRANDS        of hair, which lies along v
//   WRINKLE_BLEND  light of wrinkles in full and of smooth skin is blended
//   WRINKLE_FADE   light that grazes smooth skin fades
//   WRINKLE_BOUNCE  light bounces within isometric folds (lib/fold_light.glsl)
//   WRINKLE_VIEW   in place of the color, the skin's strain in its tangent frame; wrinkle_strength is (tt, bb, tb), and w
//                  1 where that frame is known. After lib/view.glsl
//   WRINKLE_MODEL  the wrinkle map is a model of the strain: wrinkle_strength is (tt, bb, tb), and w the share of its slopes
//   WRINKLE_LAYERS  the wrinkle map has two layers: wrinkle_strength is of the slopes and then the shade of both
//   WRINKLE_INDEPENDENT  the second one covers the first
//   WRINKLE_PHOTO  light from above the map is painted on
//   WRINKLE_COLUMNS  each column of the image has a method of its own (ViewBlock): wrinkle_strength is that of isometric
//                  folds, and that of all others. After lib/view.glsl
//   WRINKLE_FLAT   strengths are those of one vertex of each triangle

#include "lib/gbuffer.glsl"
#include "lib/interpolation.glsl"
#include "lib/material_maps.glsl"
#include "lib/wrinkle.glsl"
#include "lib/wrinkle_model.glsl"

#if defined(WRINKLE_MAP) && !defined(LIT_AT_VERTICES)
#define WRINKLES
#endif

#ifndef LIT_AT_VERTICES
layout(location = 0) INTERPOLATED in vec3 normal_ws;
layout(location = 1) INTERPOLATED in vec4 tangent_ws;
#endif
#if defined(WRINKLES) || (defined(WRINKLE_VIEW) && !defined(LIT_AT_VERTICES))
#ifdef WRINKLE_FLAT
flat
#endif
layout(location = 8) in vec4 wrinkle_strength;  // x, y: of slopes, as they are and lifted; z, w: of shade
#endif
layout(location = 2) INTERPOLATED in vec4 uv;
layout(location = 3) INTERPOLATED in vec4 vertex_color;
layout(location = 4) flat in uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat in vec4 map_layers;
#endif

vec4 material_texel(int i) {
    return material_texel(material_and_flags.x, i);
}

#ifdef MAP_LAYERS
// Where a map is read: texture coordinates and layer.
vec3 map_place(uint slot) {
    float layer = map_layer(map_layers, slot);
#if defined(UV_MAPS) || defined(UV_MAP)
#ifdef UV_MAP
    slot = 0u;  // all are the same
#endif
    vec4 rows = block_texel(material_and_flags.x, kUvBlock, 2 * int(slot));
    vec4 offset = block_texel(material_and_flags.x, kUvBlock, 2 * int(slot) + 1);
    vec2 set = offset.z > 0.5 ? uv.zw : uv.xy;
    return vec3(vec2(dot(rows.xy, set), dot(rows.zw, set)) + offset.xy, layer);
#else
    return vec3(uv.xy, layer);
#endif
}
#endif

// sRGB to linear, to within 0.002, without pow().
vec3 srgb_decode(vec3 c) {
    return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}

// Texel of the base color map; white without one.
vec4 base_color_texel() {
    vec4 texel = vec4(1.0);
#ifdef BASE_COLOR_MAP
    texel = texture(material_maps[BASE_COLOR_MAP], map_place(kBaseColorSlot));
#ifdef SRGB_BASE_COLOR
    texel.rgb = srgb_decode(texel.rgb);
#endif
#endif
    return texel;
}

#ifdef WRINKLES
#ifdef WRINKLE_MODEL
vec4 model_tile(vec3 place, int tile, int tiles, float half_texel) {
    place.y = (float(tile) + clamp(place.y, half_texel, 1.0 - half_texel)) / float(tiles);
    return texture(material_maps[WRINKLE_MAP], place);
}

// The slope of wrinkles of skin strained like this.
vec2 wrinkle_slope_here() {
    vec3 place = map_place(kWrinkleSlot);
    vec2 size = vec2(textureSize(material_maps[WRINKLE_MAP], 0).xy);
    int tiles = int(size.y / size.x + 0.5);
    float half_texel = 0.5 / size.x;
    vec4 range = model_tile(place, 0, tiles, half_texel);
    vec4 range_tb = model_tile(place, 1, tiles, half_texel);
    vec3 x = model_strain(wrinkle_strength.xyz, range, range_tb);
    vec2 slope = vec2(0.0);
    for (int tile = 2; tile < tiles; ++tile) {
        vec4 coefficients = model_tile(place, tile, tiles, half_texel);
        slope += coefficients.xy * model_term(x, 2 * tile - 4) + coefficients.zw * model_term(x, 2 * tile - 3);
    }
    return slope;
}
#elif defined(WRINKLE_LAYERS)
vec4 wrinkle_slopes_here() {
    return wrinkle_slopes(texture(material_maps[WRINKLE_MAP], map_place(kWrinkleSlot)));
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
    return wrinkle_slope(texture(material_maps[WRINKLE_MAP], map_place(kWrinkleSlot)).xyz);
}
#endif
#endif

#if defined(WRINKLES) && defined(WRINKLE_COLUMNS)
// The method of this pixel's column.
uint column_method() {
    vec2 borders = uintBitsToFloat(view.wrinkle_columns.zw);
    float place = (gl_FragCoord.x * view.size.z - borders.x) / (borders.y - borders.x);
    int column = clamp(int(floor(place * float(view.wrinkle_columns.x))), 0, int(view.wrinkle_columns.x) - 1);
    return view.wrinkle_columns.y >> (4 * column) & 15u;
}

// Its strengths, as wrinkle_strength has them where all of the image has one method.
vec4 column_strength(uint method) {
    bool steep = method == kWrinkleBump || method == kWrinkleIsometric || method == kWrinkleBlend;
    return (method == kWrinkleIsometric ? wrinkle_strength.x : wrinkle_strength.y) * vec4(
        steep ? 1.0 : 0.0,
        method == kWrinkleSphere ? 1.0 : 0.0,
        method == kWrinkleAlpha || method == kWrinklePhoto ? 1.0 : 0.0,
        method == kWrinkleDirectional ? 1.0 : 0.0);
}
#endif

#ifdef WRINKLES
// What is left of the color of slopes that are darkened.
float shaded_slope(vec2 slope, vec4 strength) {
    return 1.0 - clamp(strength.z * wrinkle_shade(slope, false) + strength.w * wrinkle_shade(slope, true), 0.0, 1.0);
}

// The same of slopes in painted light.
float painted_slope(vec2 slope, float strength) {
    return mix(1.0, painted_light(slope), clamp(strength, 0.0, 1.0));
}
#endif

vec4 surface_color() {
    vec4 color = material_texel(0) * base_color_texel();
#if defined(WRINKLES) && defined(WRINKLE_LAYERS) && !defined(WRINKLE_MODEL)
    vec4 slopes = wrinkle_slopes_here();
    color.rgb *= 1.0 - clamp(wrinkle_strength.z * wrinkle_shade(slopes.xy, false), 0.0, 1.0);
    color.rgb *= 1.0 - clamp(wrinkle_strength.w * wrinkle_shade(slopes.zw, false), 0.0, 1.0);
#elif defined(WRINKLES) && defined(WRINKLE_COLUMNS)
    uint method = column_method();
    vec4 strength = column_strength(method);
    vec2 slope = wrinkle_slope_here();
    color.rgb *= method == kWrinklePhoto ? painted_slope(slope, strength.z) : shaded_slope(slope, strength);
#elif defined(WRINKLES) && defined(WRINKLE_PHOTO)
    color.rgb *= painted_slope(wrinkle_slope_here(), wrinkle_strength.z);
#elif defined(WRINKLES) && !defined(WRINKLE_MODEL)
    color.rgb *= shaded_slope(wrinkle_slope_here(), wrinkle_strength);
#endif
#ifdef VERTEX_COLOR
    color *= max(vertex_color, 0.0);
#endif
    return color;
}

vec3 surface_emission() {
    vec3 emission = material_texel(1).rgb;
#ifdef EMISSION_MAP
    emission *= texture(material_maps[EMISSION_MAP], map_place(kEmissionSlot)).rgb;
#endif
    return emission;
}

#ifndef LIT_AT_VERTICES
// The normal of the skin, and without its wrinkles.
vec3 surface_normal(float strength, out vec3 smooth_normal) {
    vec3 n = normal_ws;
    smooth_normal = n;
#if defined(NORMAL_MAP) || defined(WRINKLES) || defined(DETAIL_MAP)
    vec3 n_ts = vec3(0.0, 0.0, 1.0);
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
#ifdef NORMAL_MAP
    n_ts = texture(material_maps[NORMAL_MAP], map_place(kNormalSlot)).xyz * 2.0 - 1.0;
    n_ts.xy *= strength;
#endif
#ifdef DETAIL_MAP
    vec3 detail = texture(material_maps[DETAIL_MAP], map_place(kDetailSlot)).xyz * 2.0 - 1.0;
    n_ts.xy += n_ts.z * detail.xy / max(detail.z, 0.1);  // slopes of both heights add up
#endif
#ifdef WRINKLES
    smooth_normal = n_ts.x * tangent_ws.xyz + n_ts.y * bitangent + n_ts.z * normal_ws;
    vec2 slope = wrinkle_slope_here();
#ifdef WRINKLE_MODEL
    slope *= wrinkle_strength.w;
#elif defined(WRINKLE_LAYERS)
#elif defined(WRINKLE_COLUMNS)
    uint method = column_method();
    vec4 strength_here = column_strength(method);
    vec2 raised = strength_here.x * slope + lifted_slope(slope, strength_here.y);
    slope = method == kWrinkleBlend ? slope : raised;
#elif !defined(WRINKLE_BLEND)
    slope = wrinkle_strength.x * slope + lifted_slope(slope, wrinkle_strength.y);
#endif
    n_ts.xy -= n_ts.z * slope;  // slopes of both heights add up
#endif
    n = n_ts.x * tangent_ws.xyz + n_ts.y * bitangent + n_ts.z * normal_ws;
#endif
    n *= inversesqrt(max(dot(n, n), 1e-20));
    smooth_normal *= inversesqrt(max(dot(smooth_normal, smooth_normal), 1e-20));
#ifdef DOUBLE_SIDED
    // gl_FrontFacing is by winding on screen, which a mirrored instance flips.
    if (gl_FrontFacing == ((material_and_flags.y & 1u) != 0u)) {
        n = -n;
        smooth_normal = -smooth_normal;
    }
#endif
    return n;
}

#ifdef STRANDS
// From root to tip, along v: against the bitangent, in the surface that `normal` is of.
vec3 strand_direction(vec3 normal) {
    vec3 along = -tangent_ws.w * cross(normal_ws, tangent_ws.xyz);
    along -= normal * dot(normal, along);
    float length2 = dot(along, along);
    return length2 > 1e-8 ? along * inversesqrt(length2) : vec3(0.0);
}
#endif

// Widens the specular lobe by the variation of a normal map within a pixel, against sparkling. Not for the curvature
// of meshes, since roughness blurs their reflections too.
// Tokuyoshi and Kaplanyan, "Improved Geometric Specular Antialiasing", 2019.
float widen_roughness(float roughness, vec3 normal) {
#if defined(NORMAL_MAP) || defined(WRINKLES)
    vec3 dx = dFdx(normal);
    vec3 dy = dFdy(normal);
    float variance = 0.159 * (dot(dx, dx) + dot(dy, dy));
    float alpha = roughness * roughness;
    roughness = sqrt(sqrt(clamp(alpha * alpha + min(2.0 * variance, 0.18), 0.0, 1.0)));
#endif
    return roughness;
}

#ifdef WRINKLE_VIEW
const float kCrossCell = 22.0;  // [px]

// A direction on the surface, as seen [px]; a unit vector that faces the viewer has half the size of a cell.
vec2 seen_direction(vec3 direction_ws) {
    vec4 moved = view.clip_from_world * vec4(direction_ws, 0.0);
    vec2 ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0;
    vec2 seen = (moved.xy - ndc * moved.w) * view.size.xy;
    float scale = view.size.x * length(vec3(view.clip_from_world[0].x, view.clip_from_world[1].x, view.clip_from_world[2].x));
    return seen * (0.5 * kCrossCell / scale);
}

vec3 strain_view() {
    vec4 principal = principal_strain(wrinkle_strength.xyz);
    vec3 color = strain_color(principal);
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    vec2 cover = strain_cross(
        mod(gl_FragCoord.xy, kCrossCell) - 0.5 * kCrossCell, principal,
        seen_direction(principal.z * tangent_ws.xyz + principal.w * bitangent),
        seen_direction(-principal.w * tangent_ws.xyz + principal.z * bitangent));
    cover *= wrinkle_strength.w;
    vec2 stretched = step(vec2(0.0), principal.xy);
    color = mix(color, mix(vec3(0.12, 0.0, 0.0), vec3(0.0, 0.0, 0.15), stretched.x), cover.x);
    return mix(color, mix(vec3(0.12, 0.0, 0.0), vec3(0.0, 0.0, 0.15), stretched.y), cover.y);
}
#endif

SurfaceSample surface_sample(vec3 albedo) {
#ifdef WRINKLE_VIEW
    albedo = strain_view();
#endif
    vec4 factors = material_texel(2);
    SurfaceSample s;
    vec3 smooth_normal;
    s.normal_ws = surface_normal(material_texel(1).w, smooth_normal);
    s.albedo = albedo;
    s.emission = surface_emission();
    s.metalness = factors.x;
    s.roughness = factors.y;
    s.occlusion = 1.0;
    s.material = material_and_flags.x;
    s.model = material_and_flags.y >> 8;
#ifdef METAL_ROUGH_MAP
    vec3 texel = texture(material_maps[METAL_ROUGH_MAP], map_place(kMetalRoughSlot)).rgb;
    s.roughness *= texel.g;
    s.metalness *= texel.b;
#ifdef OCCLUSION_SHARED
    s.occlusion = 1.0 + factors.z * (texel.r - 1.0);
#endif
#endif
#ifdef OCCLUSION_MAP
    s.occlusion = 1.0 + factors.z * (texture(material_maps[OCCLUSION_MAP], map_place(kOcclusionSlot)).r - 1.0);
#endif
    // Highlights of strands follow their direction, not the normal.
    s.roughness = s.model == kModelHair ? s.roughness : widen_roughness(s.roughness, s.normal_ws);
    set_plain(s);
#ifdef STRANDS
    s.strand_ws = strand_direction(s.normal_ws);
#endif
#if defined(WRINKLES) && defined(SMOOTH_NORMALS)
    s.smooth_normal_ws = smooth_normal;
    bool stores = s.model != kModelUnlit && s.model != kModelHair;  // in place of the emission
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
        s.normal_ws = s.raised > 0.0 ? s.normal_ws : smooth_normal;  // to the bit that of skin that has no wrinkles
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
#endif
    split_unlit(s);
    return s;
}
#endif

// The surface of a material at a point: factors times textures. Which textures exist is fixed at compile time,
// since a software OpenGL executes both sides of every branch:
//   BASE_COLOR_MAP METAL_ROUGH_MAP NORMAL_MAP OCCLUSION_MAP EMISSION_MAP WRINKLE_MAP DETAIL_MAP THICKNESS_MAP RELIEF_MAP
//   CLEARCOAT_MAP CLEARCOAT_ROUGHNESS_MAP CLEARCOAT_NORMAL_MAP SHEEN_MAP SHEEN_ROUGHNESS_MAP SPECULAR_WEIGHT_MAP
//   SPECULAR_TINT_MAP ANISOTROPY_MAP IRIDESCENCE_MAP IRIDESCENCE_THICKNESS_MAP
//   NORMAL_SPREAD_MAP TRANSMISSION_MAP LIGHT_MAP  each is the texture unit of the map
//   OCCLUSION_SHARED  occlusion is the red channel of the metal-rough map
//   VERTEX_COLOR   the mesh has colors
//   UV_MAP, UV_MAPS  of lib/material_maps.glsl
//   SRGB_BASE_COLOR  the texture is sRGB, filtered encoded and decoded here, because a software
//                  OpenGL is slow at decoding every texel; its mip levels were made in linear light
//   DRESSED        with VERTEX_COLOR: its alpha says which part of a person it is (lib/dress.glsl)
//   DOUBLE_SIDED   normals of back faces are flipped toward the viewer
//   SHIFTED_UV     hooks shift the texture coordinates, whose derivatives are then those from before
//   OFF_MESH       hooks find the visible point off the mesh, or a hole
//   LIT_AT_VERTICES  no normals, only colors; hooks do nothing
//   STRANDS        of hair, which lies along v, or along a direction of the material and of ANISOTROPY_MAP
//   LAYERED_SURFACE  with layers (lib/surface_layers.glsl); ANISOTROPIC: one of them stretches highlights
//   LEAN_NORMALS   with ANISOTROPIC: highlights stretch as the bumps that the normal map's texels average
//   BUMP_GATE BUMP_SMOOTH BUMP_RAMP  bumps are not lit from behind the mesh: Material::bump_shadow
//   HATCHED        Toon surfaces store the strokes of hatching_pass.h
//   FINE_NORMALS   normals vary within a pixel; defined here or in the file of a hook
// Additions of single effects are called by hook_*() (render/material/surface_hooks.h).
// Techniques: bump.mipmap, bump.normal-encoding, bump.normal-map, bump.per-fragment, bump.self-shadow,
//     bump.self-shadow-smooth, bump.tangent-space, env.control-map,
//     light.phong-pixel, shade.anisotropy-map, shade.derivatives, skin.detail, tex.colour-map,
//     tex.control-map
// Source of skin.detail: Barré-Brisebois and Hill 2012

#include "lib/gbuffer.glsl"
#if defined(HATCHED) && !defined(LIT_AT_VERTICES)
#include "lib/hatching.glsl"
#endif
#include "lib/interpolation.glsl"
#include "lib/material_maps.glsl"

#ifndef LIT_AT_VERTICES
layout(location = 0) INTERPOLATED in vec3 normal_ws;
layout(location = 1) INTERPOLATED in vec4 tangent_ws;
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

vec4 map_uv = uv;  // texture coordinates of maps: hooks may shift them
// The visible point of the surface: hooks may find one off the mesh.
float surface_depth = gl_FragCoord.z;
vec3 surface_offset = vec3(0.0);  // from the fragment, world space
bool surface_hole = false;
#ifdef OFF_MESH
layout(depth_less) out float gl_FragDepth;  // depth is reversed: never nearer than the mesh
#endif

#ifdef MAP_LAYERS
vec2 map_coordinates(uint slot, vec4 sets) {
    return map_coordinates(material_and_flags.x, slot, sets, 1.0);
}

vec2 map_gradient(uint slot, vec4 difference) {
    return map_coordinates(material_and_flags.x, slot, difference, 0.0);
}

// Texture coordinates and layer of a map.
vec3 map_texcoord(uint slot) {
    float layer = map_layer(
        slot < kLayersPerTexel ? map_layers : material_texel(5), slot < kLayersPerTexel ? slot : slot - kLayersPerTexel);
    return vec3(map_coordinates(slot, map_uv), layer);
}

#ifdef SHIFTED_UV
vec4 map_uv_dx = dFdx(uv);
vec4 map_uv_dy = dFdy(uv);
#define MAP_TEXEL(unit, slot) textureGrad(material_maps[unit], map_texcoord(slot), map_gradient(slot, map_uv_dx), map_gradient(slot, map_uv_dy))
#else
#define MAP_TEXEL(unit, slot) texture(material_maps[unit], map_texcoord(slot))
#endif
#endif

// sRGB to linear, to within 0.002, without pow().
vec3 srgb_decode(vec3 c) {
    return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}

// Texel of the base color map; white without one.
vec4 base_color_texel() {
    vec4 texel = vec4(1.0);
#ifdef BASE_COLOR_MAP
    texel = MAP_TEXEL(BASE_COLOR_MAP, kBaseColorSlot);
#ifdef SRGB_BASE_COLOR
    texel.rgb = srgb_decode(texel.rgb);
#endif
#endif
    return texel;
}

#include "generated/surface_hooks.glsl"
#if defined(DRESSED) && defined(VERTEX_COLOR)
#include "lib/dress.glsl"
#endif

#ifdef NORMAL_MAP
#define FINE_NORMALS
#endif

// What diffuse light that was found at vertices or facets is multiplied by: colors finer than they are.
vec3 color_over_light() {
    vec3 color = base_color_texel().rgb;
#if defined(DRESSED) && defined(VERTEX_COLOR)
    color *= dress_factor(material_and_flags.x, vertex_color.a, uv.xy);
#endif
    return color;
}

vec4 surface_color() {
    hook_uv(map_uv);
    vec4 color = material_texel(0) * base_color_texel();
    hook_color(color);
#if defined(DRESSED) && defined(VERTEX_COLOR)
    color.rgb *= max(vertex_color.rgb, 0.0) * dress_factor(material_and_flags.x, vertex_color.a, uv.xy);
#elif defined(VERTEX_COLOR)
    color *= max(vertex_color, 0.0);
#endif
    return color;
}

vec3 surface_emission() {
    vec3 emission = material_texel(1).rgb;
#ifdef EMISSION_MAP
    emission *= MAP_TEXEL(EMISSION_MAP, kEmissionSlot).rgb;
#endif
    return emission;
}

// Of a texel of a tangent-space map. Two channels (BC5) have no blue, which then reads as 0.
vec3 tangent_normal(vec3 texel) {
    vec3 n = texel * 2.0 - 1.0;
    return texel.z > 0.0 ? n : vec3(n.xy, sqrt(max(1.0 - dot(n.xy, n.xy), 0.0)));
}

#ifndef LIT_AT_VERTICES
// The normal, with and without the hooks' changes.
vec3 surface_normal(float strength, out vec3 smooth_normal) {
    vec3 n = normal_ws;
    smooth_normal = n;
#if defined(FINE_NORMALS) || defined(DETAIL_MAP)
    vec3 n_ts = vec3(0.0, 0.0, 1.0);
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
#ifdef NORMAL_MAP
    n_ts = tangent_normal(MAP_TEXEL(NORMAL_MAP, kNormalSlot).xyz);
    n_ts.xy *= strength;
#endif
#ifdef DETAIL_MAP
    vec3 detail = tangent_normal(MAP_TEXEL(DETAIL_MAP, kDetailSlot).xyz);
    vec2 detail_slopes = detail.xy / max(detail.z, 0.1);
#if defined(VERTEX_COLOR) && !defined(ALPHA_MASK) && !defined(DRESSED)
    detail_slopes *= clamp(vertex_color.a, 0.0, 1.0);
#endif
    n_ts.xy += n_ts.z * detail_slopes;  // slopes of both heights add up
#endif
    smooth_normal = n_ts.x * tangent_ws.xyz + n_ts.y * bitangent + n_ts.z * normal_ws;
    hook_normal(n_ts);
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
// Along tangent and bitangent. Of Hair, from root to tip: along v, opposite to the bitangent. Directions of opposite
// texels cancel where they are filtered, which leaves that of the material.
vec2 strand_direction_ts(uint model) {
    vec2 along = vec2(0.0, -1.0);
    if (model == kModelStrand) {
        along = block_texel(material_and_flags.x, kStrandBlock, 0).xy;
#ifdef ANISOTROPY_MAP
        vec2 d = MAP_TEXEL(ANISOTROPY_MAP, kAnisotropySlot).xy * 2.0 - 1.0;
        along = dot(d, d) > 0.01 ? mat2(along, vec2(-along.y, along.x)) * d : along;
#endif
    }
    return along;
}

// In the plane of `normal`.
vec3 strand_direction(vec3 normal, uint model) {
    vec2 d = strand_direction_ts(model);
    vec3 bitangent = tangent_ws.w * cross(normal_ws, tangent_ws.xyz);
    vec3 along = d.x * tangent_ws.xyz + d.y * bitangent;
    along -= normal * dot(normal, along);
    float length2 = dot(along, along);
    return length2 > 1e-8 ? along * inversesqrt(length2) : vec3(0.0);
}
#endif

// From tangent space to world space, facing the viewer.
vec3 from_tangent_space(vec3 v) {
    vec3 n = v.x * tangent_ws.xyz + v.y * tangent_ws.w * cross(normal_ws, tangent_ws.xyz) + v.z * normal_ws;
    n *= inversesqrt(max(dot(n, n), 1e-20));
#ifdef DOUBLE_SIDED
    n = gl_FrontFacing == ((material_and_flags.y & 1u) != 0u) ? -n : n;
#endif
    return n;
}

#if defined(NORMAL_SPREAD_MAP) && defined(NORMAL_MAP)
// Variances of the slopes that a texel of the normal map averages, along tangent and bitangent, and their covariance
// (render/material/normal_mips.h).
vec3 normal_spread(float strength) {
    vec3 texel = MAP_TEXEL(NORMAL_SPREAD_MAP, kNormalSpreadSlot).xyz;
    vec2 deviation = strength * texel.xy;
    return vec3(deviation * deviation, (2.0 * texel.z - 1.0) * deviation.x * deviation.y);
}
#else
vec3 normal_spread(float strength) {
    return vec3(0.0);
}
#endif

// Roughness with slopes of this variance along any direction in place of smooth facets.
float rougher(float roughness, float variance) {
    float alpha = roughness * roughness;
    return sqrt(sqrt(min(alpha * alpha + 2.0 * variance, 1.0)));
}

#ifdef LAYERED_SURFACE
// In the plane of a unit normal; `otherwise` where there is none.
vec3 layer_direction(vec2 direction, vec3 normal, vec3 otherwise) {
    vec3 along = direction.x * tangent_ws.xyz + direction.y * tangent_ws.w * cross(normal_ws, tangent_ws.xyz);
    along -= normal * dot(normal, along);
    float length2 = dot(along, along);
    return length2 > 1e-8 ? along * inversesqrt(length2) : otherwise;
}

#ifdef LEAN_NORMALS
// Stretches highlights along the principal axis of the slopes. Returns the roughness across.
float stretch_highlights(inout SurfaceLayers layers, float roughness, vec3 spread, vec3 normal) {
    vec2 axis = vec2(0.5 * (spread.x - spread.y), spread.z);  // its angle is twice that of the principal axis
    float mean = 0.5 * (spread.x + spread.y);
    float radius = min(length(axis), mean);
    float wide = rougher(roughness, mean + radius);
    float narrow = rougher(roughness, mean - radius);
    vec2 alphas = vec2(wide * wide, narrow * narrow);
    layers.anisotropy = sqrt(clamp((alphas.x - alphas.y) / max(1.0 - alphas.y, 1e-4), 0.0, 1.0));
    float angle = radius > 0.0 ? 0.5 * atan(axis.y, axis.x) : 0.0;
    layers.along_ws = layer_direction(vec2(cos(angle), sin(angle)), normal, layers.along_ws);
    return narrow;
}
#endif

// `normal`: unit, of the surface.
SurfaceLayers surface_layers(vec3 normal) {
    SurfaceLayers layers = plain_layers(normal);
    layers.coat_normal_ws = from_tangent_space(vec3(0.0, 0.0, 1.0));
#ifdef CLEARCOAT_NORMAL_MAP
    vec3 coat_ts = tangent_normal(MAP_TEXEL(CLEARCOAT_NORMAL_MAP, kClearcoatNormalSlot).xyz);
    coat_ts.xy *= block_texel(material_and_flags.x, kLayersBlock, 4).x;
    layers.coat_normal_ws = from_tangent_space(coat_ts);
#endif
#ifdef CLEARCOAT_MAP
    layers.coat = MAP_TEXEL(CLEARCOAT_MAP, kClearcoatSlot).r;
#endif
#ifdef CLEARCOAT_ROUGHNESS_MAP
    layers.coat_roughness =
        MAP_TEXEL(CLEARCOAT_ROUGHNESS_MAP, kClearcoatRoughnessSlot).g;
#endif
#ifdef SHEEN_MAP
    layers.sheen = MAP_TEXEL(SHEEN_MAP, kSheenSlot).rgb;
#endif
#ifdef SHEEN_ROUGHNESS_MAP
    layers.sheen_roughness = MAP_TEXEL(SHEEN_ROUGHNESS_MAP, kSheenRoughnessSlot).a;
#endif
#ifdef SPECULAR_WEIGHT_MAP
    layers.weight = MAP_TEXEL(SPECULAR_WEIGHT_MAP, kSpecularWeightSlot).a;
#endif
#ifdef SPECULAR_TINT_MAP
    layers.tint = MAP_TEXEL(SPECULAR_TINT_MAP, kSpecularTintSlot).rgb;
#endif
#ifdef IRIDESCENCE_MAP
    layers.iridescence = MAP_TEXEL(IRIDESCENCE_MAP, kIridescenceSlot).r;
#endif
#ifdef IRIDESCENCE_THICKNESS_MAP
    layers.film =
        MAP_TEXEL(IRIDESCENCE_THICKNESS_MAP, kIridescenceThicknessSlot).g;
#endif
#ifdef ANISOTROPIC
    vec2 direction = vec2(1.0, 0.0);
#ifdef ANISOTROPY_MAP
    vec3 texel = MAP_TEXEL(ANISOTROPY_MAP, kAnisotropySlot).rgb;
    direction = texel.rg * 2.0 - 1.0;
    layers.anisotropy = texel.b;
#endif
    float rotation = block_texel(material_and_flags.x, kLayersBlock, 3).w;
    vec2 turn = vec2(cos(rotation), sin(rotation));
    direction = vec2(turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x * direction.y);
    layers.along_ws = layer_direction(direction, normal, layers.along_ws);
#endif
    return layers;
}
#endif

// Widens the specular lobe by the variation of a normal map within a pixel, which prevents sparkling. Not for the
// curvature of meshes, since roughness blurs their reflections too. Tokuyoshi and Kaplanyan, "Improved Geometric
// Specular Antialiasing", 2019.
float widen_roughness(float roughness, vec3 normal) {
#ifdef FINE_NORMALS
    vec3 dx = dFdx(normal);
    vec3 dy = dFdy(normal);
    float variance = 0.159 * (dot(dx, dx) + dot(dy, dy));
    float alpha = roughness * roughness;
    roughness = sqrt(sqrt(clamp(alpha * alpha + min(2.0 * variance, 0.18), 0.0, 1.0)));
#endif
    return roughness;
}

#if defined(BUMP_GATE) || defined(BUMP_SMOOTH) || defined(BUMP_RAMP)
// The normal of the mesh is stored in place of the emission: where a surface emits, its bumps are lit from behind, too.
void shadow_bumps(inout SurfaceSample s) {
    bool stores = !s.smooth_is_stored && s.emission == vec3(0.0) && s.model != kModelUnlit && !has_strands(s.model);
    if (stores) {
        s.smooth_is_stored = true;
        s.smooth_normal_ws = from_tangent_space(vec3(0.0, 0.0, 1.0));
#ifdef BUMP_RAMP
        s.fades = true;
#elif defined(BUMP_GATE)
        s.bump_shadow = kBumpGated;
#else
        s.bump_shadow = kBumpSmoothed;
#endif
    }
}
#endif

SurfaceSample surface_sample(vec3 albedo) {
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
    vec3 texel = MAP_TEXEL(METAL_ROUGH_MAP, kMetalRoughSlot).rgb;
    s.roughness *= texel.g;
    s.metalness *= texel.b;
#ifdef OCCLUSION_SHARED
    s.occlusion = 1.0 + factors.z * (texel.r - 1.0);
#endif
#endif
#ifdef OCCLUSION_MAP
    s.occlusion = 1.0 + factors.z * (MAP_TEXEL(OCCLUSION_MAP, kOcclusionSlot).r - 1.0);
#endif
#ifdef LIGHT_MAP
    s.emission += (1.0 - s.metalness) * s.albedo * MAP_TEXEL(LIGHT_MAP, kLightMapSlot).rgb;
#endif
    // Highlights of strands follow their direction, not the normal.
    s.roughness = has_strands(s.model) ? s.roughness : widen_roughness(s.roughness, s.normal_ws);
    vec3 spread = normal_spread(material_texel(1).w);
#if defined(NORMAL_SPREAD_MAP) && !defined(LEAN_NORMALS)
    s.roughness = has_strands(s.model) ? s.roughness : rougher(s.roughness, 0.5 * (spread.x + spread.y));
#endif
#if defined(VERTEX_COLOR) && !defined(ALPHA_MASK) && !defined(DRESSED)
    set_cavity(s, vertex_color.a);
#else
    set_cavity(s, 1.0);
#endif
    set_plain(s);
#ifdef STRANDS
    s.strand_ws = strand_direction(s.normal_ws, s.model);
#endif
#ifdef HATCHED
    s.metalness = s.model == kModelToon ? hatching_tone(map_uv.xy) : s.metalness;
#endif
#ifdef LAYERED_SURFACE
    s.layers = surface_layers(s.normal_ws);
#ifdef LEAN_NORMALS
    s.roughness = stretch_highlights(s.layers, s.roughness, spread, s.normal_ws);
#endif
#endif
    hook_sample(s, smooth_normal);
#if defined(BUMP_GATE) || defined(BUMP_SMOOTH) || defined(BUMP_RAMP)
    shadow_bumps(s);
#endif
    split_unlit(s);
    return s;
}
#endif

// Writes the depth of the visible point and discards what is not there. Last: a discard leaves the derivatives of the
// quad undefined, and texture lookups need them.
void cut_surface(float opacity) {
#ifdef OFF_MESH
    gl_FragDepth = surface_depth;
    if (surface_hole) {
        discard;
    }
#endif
#ifdef ALPHA_MASK
    if (opacity < material_texel(2).w) {
        discard;
    }
#endif
}

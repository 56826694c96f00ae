// One surface sample in 128 bits, the light-independent half of deferred shading (deferred.gbuffer). An
// integer target is written without conversion and read in one fetch, which is fast on a software OpenGL,
// and keeps more bits than four 8-bit targets would.
//
//     x   normal, octahedral              16 + 16
//     y   albedo r, g (square roots)      11 + 11,  low bits of b 10
//     z   occlusion 8, roughness 10, metalness 7, shading model 5,  high bits of albedo b 2
//     w   emission, shared exponent       9 + 9 + 9 + 5
//
// For Unlit, albedo is the mirrored fraction and its color is in emission. For Subsurface, which is no metal, metalness
// is how closed the cavity is in which it lies (set_cavity). Wrinkled skin that needs its smooth normal
// when lit (SMOOTH_NORMALS) emits nothing: w is
//
//     w   smooth normal, octahedral 11 + 11,  weight of the wrinkles 9,  fades 1
//
// An x of 0 says that no smooth normal is needed; y is then the factor of the light (SHADED_SKIN).
//
// A weight of 0 is that of folds that light bounces in; 1 and 2 stand for SurfaceSample::bump_shadow, and there for the
// weight 1. So do other surfaces whose bumps are not lit from behind the mesh: their smooth normal is that of the mesh,
// and the shading model has its highest bit set. Hair and Strand emit nothing: w is
//
//     w   direction of the strand, octahedral 16 + 16, or 0: unknown
//
// All zero: no surface here. The index of the
// material is in a target of its own, which exists only where shading models read their material's record when lit
// (lib/stored_surface.glsl). So are the layers of surfaces (lib/surface_layers.glsl), where some material has them;
// their last 32 bits stand beside the index. KEY_SHADOWS: so is the visibility of the key lights.
// Techniques: deferred.gbuffer

#include "generated/model_numbers.glsl"
#include "lib/octahedral.glsl"

#if (defined(WRINKLE_BLEND) || defined(WRINKLE_FADE) || defined(WRINKLE_BOUNCE) || defined(WRINKLE_SHADE) || defined(BUMP_GATE) || defined(BUMP_SMOOTH) || defined(BUMP_RAMP)) && !defined(SMOOTH_NORMALS)
#define SMOOTH_NORMALS
#endif
#if defined(WRINKLE_BLEND) && !defined(BLENDED_SKIN)
#define BLENDED_SKIN
#endif
#if defined(WRINKLE_SHADE) && !defined(SHADED_SKIN)
#define SHADED_SKIN
#endif
#if defined(WRINKLE_BOUNCE) && !defined(FOLD_LIGHT)
#define FOLD_LIGHT
#endif
#if (defined(SHADE_HAIR) || defined(SHADE_STRAND)) && !defined(STRANDS)
#define STRANDS
#endif
#ifdef LAYERED
#ifdef COATED_MATERIALS
#define LAYER_COAT
#endif
#ifdef SHEEN_MATERIALS
#define LAYER_SHEEN
#endif
#ifdef ANISOTROPIC_MATERIALS
#define LAYER_ANISOTROPY
#endif
#ifdef FILM_MATERIALS
#define LAYER_FILM
#endif
#endif

// Unit vector in 16 + 16 bits, never 0.
uint pack_direction(vec3 direction) {
    uvec2 n = uvec2(clamp(octahedral_encode(direction) * 32767.0 + 32768.5, 1.0, 65535.0));
    return n.x | n.y << 16;
}

vec3 unpack_direction(uint bits) {
    return octahedral_decode((vec2(bits & 0xffffu, bits >> 16) - 32768.0) / 32767.0);
}

#ifdef LAYERED
#include "lib/surface_layers.glsl"
#endif

struct SurfaceSample {
    vec3 normal_ws;   // unit
    vec3 albedo;      // linear, 0 .. 1
    vec3 emission;    // radiance, 0 .. 65408
    float occlusion;  // 0 occluded .. 1 open
    float roughness;  // perceptual, 0 .. 1
    float metalness;  // 0 .. 1; of Subsurface: of a cavity, 0 open .. 1 closed
    uint material;    // index; not in pack_surface()
    uint model;       // kModel*
#ifdef SMOOTH_NORMALS
    vec3 smooth_normal_ws;  // unit, of skin without its wrinkles
    float raised;           // weight of lighting by normal_ws; the rest is by smooth_normal_ws
    bool bounces;           // light bounces within the folds, whose normal is normal_ws; raised is 1
    float shade;            // factor of all light that it reflects; below 1 only if no smooth normal is needed
    bool fades;             // light at grazing angles to smooth_normal_ws fades
    uint bump_shadow;       // kBump*: how light from behind smooth_normal_ws is left out; 0: it is not
    bool smooth_is_stored;  // otherwise raised is 1
#endif
#ifdef STRANDS
    vec3 strand_ws;  // of Hair, from root to tip, and Strand: unit; 0: unknown
#endif
#ifdef LAYERED
    SurfaceLayers layers;  // not in pack_surface()
#endif
#ifdef KEY_SHADOWS
    vec2 key_visibility;  // of the key lights (lib/key_lights.glsl), 0 .. 1; not in pack_surface()
#endif
};

const uint kBumpGated = 1u;     // with a hard border
const uint kBumpSmoothed = 2u;  // times the cosine
const uint kSmoothNormalBit = 16u;  // of the stored shading model

// Clears the members that only wrinkled skin, strands and layered surfaces use.
void set_plain(inout SurfaceSample s) {
#ifdef SMOOTH_NORMALS
    s.smooth_normal_ws = s.normal_ws;
    s.raised = 1.0;
    s.bounces = false;
    s.shade = 1.0;
    s.fades = false;
    s.bump_shadow = 0u;
    s.smooth_is_stored = false;
#endif
#ifdef STRANDS
    s.strand_ws = vec3(0.0);
#endif
#ifdef LAYERED
    s.layers = plain_layers(s.normal_ws);
#endif
#ifdef KEY_SHADOWS
    s.key_visibility = vec2(1.0);
#endif
}

// How open a cavity of skin is, for shading model Subsurface, from the alpha of its vertices: below kCavityAlpha
// (kSkinCavity of heads), where there are no pores, it is the share of the surroundings that light the surface. So an
// opaque mesh of that model needs an alpha of 1, or none. Unlike what an occlusion map darkens, closed cavities mirror
// no lamps.
void set_cavity(inout SurfaceSample s, float alpha) {
    const float kCavityAlpha = 0.1;
    if (s.model == kModelSubsurface) {
        float open = clamp(alpha / kCavityAlpha, 0.0, 1.0);
        s.occlusion *= open;
        s.metalness = 1.0 - open;
    }
}

// Whether surfaces have a direction of strands and emit nothing.
bool has_strands(uint model) {
    return model == kModelHair || model == kModelStrand;
}

// Splits the color of an unlit surface into emission and mirrored fraction.
void split_unlit(inout SurfaceSample s) {
    if (s.model == kModelUnlit) {
        s.emission += (1.0 - s.metalness) * s.albedo;
        s.albedo = vec3(s.metalness);
    }
}

// Nonnegative color with a shared exponent, as GL_RGB9_E5; 0 stays 0.
uint pack_rgb9e5(vec3 color) {
    color = clamp(color, 0.0, 65408.0);
    float peak = max(color.r, max(color.g, color.b));
    // The exponent bits of the peak, raised by one when its nine-bit mantissa would round up to 512.
    uint bits = floatBitsToUint(peak * (1.0 + 1.0 / 1024.0));
    int exponent = max(int(bits >> 23) - 127, -16) + 16;                   // 0 .. 31
    float scale = uintBitsToFloat(uint(127 - (exponent - 15 - 9)) << 23);  // 2^-(exponent - 15 - 9)
    uvec3 m = min(uvec3(color * scale + 0.5), uvec3(511u));
    return m.r | m.g << 9 | m.b << 18 | uint(exponent) << 27;
}

vec3 unpack_rgb9e5(uint bits) {
    float scale = uintBitsToFloat(((bits >> 27) + (127u - 15u - 9u)) << 23);
    return vec3(bits & 511u, bits >> 9 & 511u, bits >> 18 & 511u) * scale;
}

const vec3 kAlbedoRange = vec3(2047.0, 2047.0, 4095.0);
const vec3 kFactorRange = vec3(255.0, 1023.0, 127.0);  // occlusion, roughness, metalness

#ifdef SMOOTH_NORMALS
uint pack_smooth_normal(SurfaceSample s) {
    uvec2 n = uvec2(clamp(octahedral_encode(s.smooth_normal_ws) * 1023.0 + 1024.5, 1.0, 2047.0));
    n = s.shade < 1.0 ? uvec2(0u, uint(clamp(s.shade, 0.0, 1.0) * 2047.0 + 0.5)) : n;
    uint raised = s.bounces ? 0u : max(uint(clamp(s.raised, 0.0, 1.0) * 511.0 + 0.5), kBumpSmoothed + 1u);
    raised = s.bump_shadow > 0u ? s.bump_shadow : raised;
    return n.x | n.y << 11 | raised << 22 | (s.fades ? 1u : 0u) << 31;
}

void unpack_smooth_normal(inout SurfaceSample s, uint bits) {
    s.smooth_normal_ws = octahedral_decode((vec2(bits & 2047u, bits >> 11 & 2047u) - 1024.0) / 1023.0);
    bool shaded = s.smooth_is_stored && (bits & 2047u) == 0u;
    s.smooth_normal_ws = shaded ? s.normal_ws : s.smooth_normal_ws;
    s.shade = shaded ? float(bits >> 11 & 2047u) / 2047.0 : 1.0;
    uint raised = bits >> 22 & 511u;
    s.bounces = s.smooth_is_stored && raised == 0u;
    s.raised = s.smooth_is_stored && raised > kBumpSmoothed ? float(raised) / 511.0 : 1.0;
    s.bump_shadow = s.smooth_is_stored && raised <= kBumpSmoothed ? raised : 0u;
    s.fades = s.smooth_is_stored && bits >> 31 != 0u;
}
#endif

uvec4 pack_surface(SurfaceSample s) {
    uvec3 a = uvec3(sqrt(clamp(s.albedo, 0.0, 1.0)) * kAlbedoRange + 0.5);
    uvec3 factors = uvec3(clamp(vec3(s.occlusion, s.roughness, s.metalness), 0.0, 1.0) * kFactorRange + 0.5);
    uint emission = pack_rgb9e5(s.emission);
    uint model = s.model;
#ifdef SMOOTH_NORMALS
    emission = s.smooth_is_stored ? pack_smooth_normal(s) : emission;
    model |= s.smooth_is_stored ? kSmoothNormalBit : 0u;
#endif
#ifdef STRANDS
    uint strand = s.strand_ws == vec3(0.0) ? 0u : pack_direction(s.strand_ws);
    emission = has_strands(s.model) ? strand : emission;
#endif
    return uvec4(
        pack_direction(s.normal_ws),
        a.r | a.g << 11 | a.b << 22,
        factors.x | factors.y << 8 | factors.z << 18 | model << 25 | a.b >> 10 << 30,
        emission);
}

SurfaceSample unpack_surface(uvec4 g) {
    SurfaceSample s;
    s.normal_ws = unpack_direction(g.x);
    vec3 root = vec3(g.y & 2047u, g.y >> 11 & 2047u, g.y >> 22 | g.z >> 30 << 10) / kAlbedoRange;
    s.albedo = root * root;
    vec3 factors = vec3(g.z & 255u, g.z >> 8 & 1023u, g.z >> 18 & 127u) / kFactorRange;
    s.occlusion = factors.x;
    s.roughness = factors.y;
    s.metalness = factors.z;
    s.material = 0u;
    s.model = g.z >> 25 & 15u;
    bool is_smooth_normal = (g.z >> 25 & kSmoothNormalBit) != 0u;
    s.emission = is_smooth_normal || has_strands(s.model) ? vec3(0.0) : unpack_rgb9e5(g.w);
#ifdef SMOOTH_NORMALS
    s.smooth_is_stored = is_smooth_normal;
    unpack_smooth_normal(s, g.w);
#endif
#ifdef STRANDS
    s.strand_ws = has_strands(s.model) && g.w != 0u ? unpack_direction(g.w) : vec3(0.0);
#endif
#ifdef KEY_SHADOWS
    s.key_visibility = vec2(1.0);
#endif
#ifdef LAYERED
    s.layers = plain_layers(s.normal_ws);
#endif
    return s;
}

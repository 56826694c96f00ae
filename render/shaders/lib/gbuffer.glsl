// One surface sample in 128 bits, the light-independent half of deferred shading (deferred.gbuffer). An
// integer target is written without conversion and read in one fetch, which is fast on a software OpenGL,
// and keeps more bits than four 8-bit targets would.
//
//     x   normal, octahedral                16 + 16
//     y   albedo r, g (square roots)        12 + 12,  occlusion 8
//     z   albedo b 12,  roughness 10, metalness 7 - or material 17 -,  shading model 3
//     w   emission, shared exponent         9 + 9 + 9 + 5
//
// Blinn, Phong and Skin take their coefficients from the material, whose index replaces roughness and metalness. For
// Unlit, albedo is the mirrored share and its color is in emission. All zero: no surface here.

#include "lib/octahedral.glsl"

// Stored shading models: ShadingModel + 1.
const uint kModelNone = 0u;
const uint kModelPbr = 1u;
const uint kModelBlinn = 2u;
const uint kModelPhong = 3u;
const uint kModelUnlit = 4u;
const uint kModelSkin = 5u;

// Whether the coefficients are in the material.
bool is_classic(uint model) {
    return model == kModelBlinn || model == kModelPhong || model == kModelSkin;
}

struct SurfaceSample {
    vec3 normal_ws;   // unit
    vec3 albedo;      // linear, 0 .. 1
    vec3 emission;    // radiance, 0 .. 65408
    float occlusion;  // 0 occluded .. 1 open
    float roughness;  // perceptual, 0 .. 1
    float metalness;  // 0 .. 1
    uint material;    // index; stored only if is_classic()
    uint model;       // kModel*
};

// Splits the color of an unlit surface into emission and mirrored share.
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
    int exponent = max(int(bits >> 23) - 127, -16) + 16;           // 0 .. 31
    float scale = uintBitsToFloat(uint(127 - (exponent - 15 - 9)) << 23);  // 2^-(exponent - 15 - 9)
    uvec3 m = min(uvec3(color * scale + 0.5), uvec3(511u));
    return m.r | m.g << 9 | m.b << 18 | uint(exponent) << 27;
}

vec3 unpack_rgb9e5(uint bits) {
    float scale = uintBitsToFloat(((bits >> 27) + (127u - 15u - 9u)) << 23);
    return vec3(bits & 511u, bits >> 9 & 511u, bits >> 18 & 511u) * scale;
}

uvec4 pack_surface(SurfaceSample s) {
    uvec2 n = uvec2(clamp(octahedral_encode(s.normal_ws) * 32767.0 + 32768.5, 1.0, 65535.0));
    uvec3 a = uvec3(sqrt(clamp(s.albedo, 0.0, 1.0)) * 4095.0 + 0.5);
    uint ao = uint(clamp(s.occlusion, 0.0, 1.0) * 255.0 + 0.5);
    uint pbr = uint(clamp(s.roughness, 0.0, 1.0) * 1023.0 + 0.5) | uint(clamp(s.metalness, 0.0, 1.0) * 127.0 + 0.5) << 10;
    uint word = is_classic(s.model) ? s.material & 0x1ffffu : pbr;
    return uvec4(n.x | n.y << 16, a.r | a.g << 12 | ao << 24, a.b | word << 12 | s.model << 29, pack_rgb9e5(s.emission));
}

SurfaceSample unpack_surface(uvec4 g) {
    SurfaceSample s;
    s.normal_ws = octahedral_decode((vec2(g.x & 0xffffu, g.x >> 16) - 32768.0) / 32767.0);
    vec3 root = vec3(g.y & 0xfffu, g.y >> 12 & 0xfffu, g.z & 0xfffu) / 4095.0;
    s.albedo = root * root;
    s.occlusion = float(g.y >> 24) / 255.0;
    s.roughness = float(g.z >> 12 & 1023u) / 1023.0;
    s.metalness = float(g.z >> 22 & 127u) / 127.0;
    s.material = g.z >> 12 & 0x1ffffu;
    s.model = g.z >> 29;
    s.emission = unpack_rgb9e5(g.w);
    return s;
}

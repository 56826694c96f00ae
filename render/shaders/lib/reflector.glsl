// Reflection of incoming light by a surface. Lights are reduced to direction and irradiance, whatever their type
// (light.interface). Definition CLASSIC_MODELS: some surface is Blinn, Phong or Skin; it only saves a software OpenGL
// needless work.

#include "lib/brdf.glsl"
#include "lib/gbuffer.glsl"
#include "material_gpu.h"

layout(binding = 8) uniform sampler2D specular_albedo;  // (scale, bias) of f0 by n.v and roughness
#ifdef CLASSIC_MODELS
layout(binding = 13) uniform samplerBuffer surface_materials;  // MaterialRecord
#endif

const float kDielectric = 0.04;  // reflectance head on, index of refraction 1.5

struct Incoming {
    vec3 to_light;    // unit
    vec3 irradiance;  // on a plane that faces the light
};

// The terms of a surface that are the same for all lights.
struct Reflector {
    vec3 normal;
    vec3 to_camera;
    float n_v;
    float alpha2;      // roughness^4
    vec3 diffuse;      // albedo of the diffuse part, less what the specular part reflects
    vec3 specular_0;   // reflectance at normal incidence, with multiple scattering; ks of the classic models
    vec3 specular_90;  // the same at grazing angles
    vec3 mirror;       // specular reflectance for a uniform environment
    float classic;     // 0: Pbr, 1: Blinn and Skin, 2: Phong
    float shininess;
    vec3 rim;          // of Skin: added to n.l for every light, whatever its direction
};

Reflector make_reflector(SurfaceSample s, vec3 to_camera) {
    Reflector r;
    r.normal = s.normal_ws;
    r.to_camera = to_camera;
    // Normal maps and interpolation turn some normals away from the viewer: treated as grazing.
    r.n_v = max(dot(s.normal_ws, to_camera), 1e-3);
    float roughness = max(s.roughness, kMinRoughness);
    r.alpha2 = roughness * roughness * roughness * roughness;

    // Metalness is the share of the surface that is metal (env.control-map); the rest is dielectric. Both compensate
    // the energy lost by single scattering: Turquin, "Practical Multiple Scattering Compensation for Microfacet
    // Models", 2019.
    vec2 size = vec2(textureSize(specular_albedo, 0));
    vec2 fit = texture(specular_albedo, (vec2(min(r.n_v, 1.0), s.roughness) * (size - 1.0) + 0.5) / size).rg;
    float lost = 1.0 / (fit.x + fit.y) - 1.0;
    float dielectric_90 = 1.0 + kDielectric * lost;
    float dielectric_mirror = dielectric_90 * (kDielectric * fit.x + fit.y);
    vec3 metal_90 = 1.0 + s.albedo * lost;
    r.specular_0 = mix(vec3(kDielectric * dielectric_90), s.albedo * metal_90, s.metalness);
    r.specular_90 = mix(vec3(dielectric_90), metal_90, s.metalness);
    r.mirror = r.specular_0 * fit.x + r.specular_90 * fit.y;
    r.diffuse = s.albedo * ((1.0 - s.metalness) * (1.0 - dielectric_mirror));
    if (s.model == kModelUnlit) {
        r.specular_0 = vec3(0.0);
        r.specular_90 = vec3(0.0);
        r.mirror = s.albedo;  // the mirrored share, see split_unlit()
        r.diffuse = vec3(0.0);
    }
    r.classic = 0.0;
    r.shininess = 1.0;
    r.rim = vec3(0.0);
#ifdef CLASSIC_MODELS
    if (is_classic(s.model)) {
        vec4 specular = texelFetch(surface_materials, int(s.material * kMaterialTexels) + 3);
        r.classic = s.model == kModelPhong ? 2.0 : 1.0;
        r.specular_0 = specular.rgb;
        r.shininess = specular.a;
        r.mirror = vec3(0.0);
        r.diffuse = s.albedo;
        if (s.model == kModelSkin) {
            vec4 skin = texelFetch(surface_materials, int(s.material * kMaterialTexels) + 14);
            r.rim = skin_rim(dot(s.normal_ws, to_camera), skin.w > 0.5) * skin.rgb;
        }
    }
#endif
    return r;
}

// Sums over lights, before the material's factors (light.multi).
struct LightSum {
    vec3 diffuse;   // E n.l
    vec3 specular;  // E lobe
    vec3 fresnel;   // E lobe (1 - v.h)^5, the part of it with grazing reflectance
};

void add_light(inout LightSum sum, Reflector r, Incoming light) {
    float n_l = max(dot(r.normal, light.to_light), 0.0);
    float l_v = dot(light.to_light, r.to_camera);
    vec2 h = half_cosines(n_l, r.n_v, l_v);  // n.h, v.h
    float lobe = ggx_lobe(n_l, r.n_v, h.x, r.alpha2);
    float p = schlick_weight(h.y);
#ifdef CLASSIC_MODELS
    float r_v = 2.0 * n_l * r.n_v - l_v;
    float classic = lit(n_l, r.classic > 1.5 ? r_v : h.x, r.shininess).z / kPi;
    lobe = r.classic > 0.5 ? classic : lobe;
    p = r.classic > 0.5 ? 0.0 : p;
    sum.diffuse += light.irradiance * (n_l + r.rim);
#else
    sum.diffuse += light.irradiance * n_l;
#endif
    sum.specular += light.irradiance * lobe;
    sum.fresnel += light.irradiance * (lobe * p);
}

struct Reflected {
    vec3 diffuse;
    vec3 specular;
};

// Shading model Pbr: metallic-roughness as in glTF. GGX with height-correlated Smith visibility, compensated for
// multiple scattering, over Lambert. The base of all models: others override what differs.
// Techniques: env.control-map, light.microfacet
// Source of light.microfacet: Walter et al. 2007; Heitz 2014; Turquin 2019

#include "lib/brdf.glsl"
#include "lib/material_record.glsl"
#include "environment_gpu.h"

layout(binding = kSpecularAlbedoUnit) uniform sampler2D specular_albedo;  // (scale, bias) of f0 by n.v and roughness

const float kDielectric = 0.04;  // reflectance at normal incidence, index of refraction 1.5

float dielectric_reflectance(SurfaceSample s) {
#ifdef TRANSMISSION
    float index = block_texel(s.material, kClearBlock, 0).y;
    return (index - 1.0) * (index - 1.0) / ((index + 1.0) * (index + 1.0));
#else
    return kDielectric;
#endif
}

// Reflectance of a specular lobe under uniform light: x f0 + y.
vec2 lobe_albedo(float n_v, float roughness) {
    vec2 size = vec2(textureSize(specular_albedo, 0));
    return texture(specular_albedo, (vec2(min(n_v, 1.0), roughness) * (size - 1.0) + 0.5) / size).rg;
}

// Metalness is the fraction of the surface that is metal (env.control-map); the rest is dielectric. Both compensate the
// energy lost by single scattering: Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019.
void prepare_pbr(inout Reflector r, SurfaceSample s) {
    float roughness = max(s.roughness, kMinRoughness);
    r.alpha2 = roughness * roughness * roughness * roughness;
    vec2 fit = lobe_albedo(r.n_v, s.roughness);
    float lost = 1.0 / (fit.x + fit.y) - 1.0;
    float head_on = dielectric_reflectance(s);
    float dielectric_90 = 1.0 + head_on * lost;
    float dielectric_mirror = dielectric_90 * (head_on * fit.x + fit.y);
    vec3 metal_90 = 1.0 + s.albedo * lost;
    r.specular_0 = mix(vec3(head_on * dielectric_90), s.albedo * metal_90, s.metalness);
    r.specular_90 = mix(vec3(dielectric_90), metal_90, s.metalness);
    r.mirror = r.specular_0 * fit.x + r.specular_90 * fit.y;
    r.diffuse = s.albedo * ((1.0 - s.metalness) * (1.0 - dielectric_mirror));
}

Response lobe_pbr(Reflector r, Cosines c) {
    float lobe = ggx_lobe(c.n_l, r.n_v, c.n_h, r.alpha2);
    return Response(vec3(c.n_l), lobe, lobe * schlick_weight(c.v_h));
}

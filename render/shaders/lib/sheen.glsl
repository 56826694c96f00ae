// Reflection by fibers that stand up from a surface, as of velvet: KHR_materials_sheen, after A. Estevez and C. Kulla,
// "Production Friendly Microfacet Sheen BRDF", 2017. The albedo is tabulated by render/environment/sheen_albedo.h.
// Techniques: shade.sheen
// Source of shade.sheen: Estevez and Kulla 2017; KHR_materials_sheen

#include "material_layers_gpu.h"

layout(binding = kSheenAlbedoUnit) uniform sampler2D sheen_albedo;  // by n.v and roughness

const float kMinSheenRoughness = 0.07;  // below, the lobe is narrower than the steps of the table

// Fitted logarithm of the masking function Lambda, for cosines up to 0.5.
float sheen_masking_exponent(float cosine, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float a = mix(21.5473, 25.3245, t);
    float b = mix(3.82987, 3.32435, t);
    float c = mix(0.19823, 0.16801, t);
    float d = mix(-1.97760, -1.27393, t);
    float e = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(cosine, c)) + d * cosine + e;
}

float sheen_masking(float cosine, float alpha) {
    return exp(
        cosine < 0.5 ? sheen_masking_exponent(cosine, alpha)
                     : 2.0 * sheen_masking_exponent(0.5, alpha) - sheen_masking_exponent(1.0 - cosine, alpha));
}

// The lobe times n.l, for white sheen; alpha = roughness^2.
float sheen_lobe(float n_l, float n_v, float n_h, float alpha) {
    float sine2 = max(1.0 - n_h * n_h, 1e-7);
    float distribution = (2.0 + 1.0 / alpha) * pow(sine2, 0.5 / alpha) / (2.0 * kPi);
    float shadowing = 1.0 + sheen_masking(n_v, alpha) + sheen_masking(max(n_l, 1e-4), alpha);
    return n_l > 0.0 ? distribution * min(1.0 / (4.0 * n_v * shadowing), n_l) : 0.0;
}

// Reflectance of white sheen for a uniform environment; smooth sheen at grazing angles would reflect more than 1, and
// is dimmed by it (sheen_dimming).
float sheen_reflectance(float cosine, float roughness) {
    vec2 size = vec2(textureSize(sheen_albedo, 0));
    return texture(sheen_albedo, (vec2(min(cosine, 1.0), roughness) * (size - 1.0) + 0.5) / size).r;
}

// Symmetric in the reflectances toward the camera and the light.
float sheen_dimming(float a, float b) {
    return 1.0 / max(max(a, b), 1.0);
}

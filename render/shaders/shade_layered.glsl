// Shading model Pbr with layers (render/material/material_layers.h): the extensions of glTF materials. From the outside
// in: a clear coat, sheen, and the metal-rough base, whose specular reflection may be tinted, weighted, stretched
// (anisotropy) or that of a thin film. Energy as in shade_pbr.glsl: what a layer reflects does not reach those below.
//
// Definitions of what some material of the level has: LAYER_COAT, LAYER_SHEEN, LAYER_ANISOTROPY, LAYER_FILM.
// Techniques: shade.anisotropic-specular, shade.clear-coat, shade.dielectric-specular, shade.sheen, shade.thin-film
// Source of shade.anisotropic-specular: Burley 2012; Heitz 2014; KHR_materials_anisotropy
// Source of shade.clear-coat: KHR_materials_clearcoat
// Source of shade.dielectric-specular: KHR_materials_specular, KHR_materials_ior

#include "material_layers_gpu.h"

#ifdef LAYERED
#ifdef LAYER_SHEEN
#include "lib/sheen.glsl"
#endif
#ifdef LAYER_FILM
#include "lib/thin_film.glsl"
#endif

float largest(vec3 color) {
    return max(color.r, max(color.g, color.b));
}

// Adds a part of the base: reflectance f0 to f90 by Schlick, with multiple scattering.
void add_base(inout Reflector r, float share, vec3 f0, vec3 f90, float lost) {
    vec3 more = share * (1.0 + f0 * lost);
    r.specular_0 += more * f0;
    r.specular_90 += more * f90;
}

vec3 mirrored_by(vec3 f0, vec3 f90, vec2 fit, float lost) {
    return (1.0 + f0 * lost) * (f0 * fit.x + f90 * fit.y);
}

void prepare_layered(inout Reflector r, SurfaceSample s) {
    SurfaceLayers layers = s.layers;
    vec4 specular = block_texel(s.material, kLayersBlock, 0);
    vec4 coat = block_texel(s.material, kLayersBlock, 1);
    float roughness = s.roughness;
#ifdef LAYER_ANISOTROPY
    float stretch = layers.anisotropy * coat.z;
    float alpha = sqrt(r.alpha2);
    r.alphas = vec2(mix(alpha, 1.0, stretch * stretch), alpha);
    r.along = layers.along_ws;
    r.stretch = stretch;
    roughness = sqrt(sqrt(r.alphas.x * r.alphas.y));  // an isotropic lobe that loses as much
#endif
    vec2 fit = lobe_albedo(r.n_v, roughness);
    float lost = 1.0 / (fit.x + fit.y) - 1.0;

    float weight = specular.w * layers.weight;
    vec3 head_on = min(specular.rgb * layers.tint, vec3(1.0));
    vec3 dielectric_0 = weight * head_on;
    vec3 dielectric_90 = vec3(weight);
    r.specular_0 = vec3(0.0);
    r.specular_90 = vec3(0.0);
    vec3 dielectric_mirror = mirrored_by(dielectric_0, dielectric_90, fit, lost);
    vec3 metal_mirror = mirrored_by(s.albedo, vec3(1.0), fit, lost);
    float plain = 1.0;
#ifdef LAYER_FILM
    vec4 film = block_texel(s.material, kLayersBlock, 3);
    float thickness = mix(film.y, film.z, layers.film);
    float iridescence = thickness > 0.0 ? layers.iridescence * coat.w : 0.0;
    vec3 film_dielectric = thin_film(r.n_v, film.x, thickness, head_on);
    vec3 film_metal = thin_film(r.n_v, film.x, thickness, s.albedo);
    add_base(r, iridescence * (1.0 - s.metalness), film_dielectric, film_dielectric, lost);
    add_base(r, iridescence * s.metalness, film_metal, film_metal, lost);
    plain = 1.0 - iridescence;
    dielectric_mirror =
        mix(dielectric_mirror, mirrored_by(film_dielectric, film_dielectric, fit, lost), iridescence);
    metal_mirror = mix(metal_mirror, mirrored_by(film_metal, film_metal, fit, lost), iridescence);
#endif
    add_base(r, plain * (1.0 - s.metalness), dielectric_0, dielectric_90, lost);
    add_base(r, plain * s.metalness, s.albedo, vec3(1.0), lost);
    r.mirror = mix(dielectric_mirror, metal_mirror, s.metalness);
    r.diffuse = s.albedo * ((1.0 - s.metalness) * max(1.0 - largest(dielectric_mirror), 0.0));

#ifdef LAYER_SHEEN
    vec4 sheen = block_texel(s.material, kLayersBlock, 2);
    r.sheen = sheen.rgb * layers.sheen;
    r.sheen_roughness = max(sheen.w * layers.sheen_roughness, kMinSheenRoughness);
    r.sheen_albedo = sheen_reflectance(r.n_v, r.sheen_roughness);
#endif
#ifdef LAYER_COAT
    float coat_roughness = max(coat.y * layers.coat_roughness, kMinRoughness);
    r.coat_normal = layers.coat_normal_ws;
    r.coat_n_v = max(dot(layers.coat_normal_ws, r.to_camera), 1e-3);
    r.coat_alpha2 = coat_roughness * coat_roughness * coat_roughness * coat_roughness;
    r.coat_roughness = coat.y * layers.coat_roughness;
    r.coat = coat.x * layers.coat * (kDielectric + (1.0 - kDielectric) * schlick_weight(r.coat_n_v));
#endif
}

Response lobe_layered(Reflector r, Cosines c) {
#ifdef LAYER_ANISOTROPY
    float lobe = anisotropic_lobe(c.n_l, r.n_v, c.to_light, r.to_camera, r.normal, r.along, r.alphas);
#else
    float lobe = ggx_lobe(c.n_l, r.n_v, c.n_h, r.alpha2);
#endif
    float passed = 1.0;
#ifdef LAYER_SHEEN
    passed = 1.0 - largest(r.sheen) * min(max(r.sheen_albedo, sheen_reflectance(c.n_l, r.sheen_roughness)), 1.0);
#endif
    return Response(vec3(passed * c.n_l), passed * lobe, passed * lobe * schlick_weight(c.v_h));
}
#endif

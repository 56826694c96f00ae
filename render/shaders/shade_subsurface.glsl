// Shading model Subsurface, for skin: diffuse light that scatters under the surface, below two GGX lobes, one of them
// for an oily film. Light that the lobes do not reflect is diffuse; the diffusion pass determines where it exits the
// surface. Reflector::own: x = roughness^4 of the second lobe, y = its weight.
// Techniques: skin.gloss
// Source of skin.gloss: Donner and Jensen 2006

#include "lib/brdf.glsl"
#include "lib/material_record.glsl"
#include "material_subsurface_gpu.h"

void prepare_subsurface(inout Reflector r, SurfaceSample s) {
    vec4 specular = block_texel(s.material, kSubsurfaceBlock, 0);
    vec4 diffusion = block_texel(s.material, kSubsurfaceBlock, kDiffusionTexel);
    float gloss = max(diffusion.w, kMinRoughness);
    // In a cavity where less than a quarter of the surroundings is open, as in a nostril, lamps are hidden as well.
    float open = min(4.0 * (1.0 - s.metalness), 1.0);
    vec2 fit = mix(lobe_albedo(r.n_v, s.roughness), lobe_albedo(r.n_v, diffusion.w), specular.w);
    r.specular_0 = specular.rgb * open;
    r.specular_90 = vec3(open);
    r.mirror = specular.rgb * fit.x + fit.y;
    r.diffuse = s.albedo * (1.0 - r.mirror);
#ifdef SHADE_SUBSURFACE
    r.diffusion = diffusion.rgb;
#endif
    r.own = vec4(gloss * gloss * gloss * gloss, specular.w, 0.0, 0.0);
}

Response lobe_subsurface(Reflector r, Cosines c) {
    float lobe = mix(
        ggx_lobe(c.n_l, r.n_v, c.n_h, r.alpha2), ggx_lobe(c.n_l, r.n_v, c.n_h, r.own.x), r.own.y);
    return Response(vec3(c.n_l), lobe, lobe * schlick_weight(c.v_h));
}

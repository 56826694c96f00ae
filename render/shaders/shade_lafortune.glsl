// Shading model Lafortune: the base color D and lobes fitted to a measured BRDF (skin.brdf-lafortune),
//
//     f = D + sum max(0, Cx (ux vx + uy vy) + Cz uz vz)^n
//
// with u toward the light, v toward the viewer and z along the normal. Reflects the environment only diffusely.
// Reflector::own: x = index of the material, y = number of lobes. Lafortune et al., "Non-Linear Approximation of
// Reflectance Functions", 1997.
// Techniques: skin.brdf-lafortune

#include "lib/lafortune.glsl"
#include "lib/material_record.glsl"
#include "material_lafortune_gpu.h"

const float kMinDiffuse = 1e-4;  // D, the factor of every response

void prepare_lafortune(inout Reflector r, SurfaceSample s) {
    r.diffuse = max(s.albedo, vec3(kMinDiffuse));
    r.mirror = vec3(0.0);
    r.own = vec4(float(s.material), block_texel(s.material, kLafortuneBlock, 0).w, 0.0, 0.0);
}

vec3 lafortune_lobes(uint material, int count, float n_l, float n_v, float l_v) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        int at = int(kLafortuneTexels) * i;
        sum += lafortune_lobe(
            block_texel(material, kLafortuneBlock, at).rgb, block_texel(material, kLafortuneBlock, at + 1).rgb,
            block_texel(material, kLafortuneBlock, at + 2).rgb, n_l, n_v, l_v);
    }
    return sum;
}

Response lobe_lafortune(Reflector r, Cosines c) {
    vec3 lobes = lafortune_lobes(uint(r.own.x), int(r.own.y), c.n_l, r.n_v, c.l_v);
    return Response(c.n_l * (1.0 + lobes / r.diffuse), 0.0, 0.0);
}

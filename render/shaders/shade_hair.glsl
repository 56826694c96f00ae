// Shading model Hair: strands along v, scattering light in three lobes (lib/hair.glsl). The first is the specular part.
// Techniques: hair.shading

#include "lib/brdf.glsl"
#include "lib/hair.glsl"
#include "lib/material_record.glsl"
#include "material_hair_gpu.h"

void prepare_hair(inout Reflector r, SurfaceSample s) {
#ifdef SHADE_HAIR
    r.hair = hair_lobes(
        block_texel(s.material, kHairBlock, 0), block_texel(s.material, kHairBlock, 1), s.albedo, s.roughness,
        s.strand_ws, r.to_camera);
    r.specular_0 = vec3(1.0);
    r.specular_90 = vec3(1.0);
    r.mirror = vec3(r.hair.reflected);
    r.diffuse = max(r.hair.tt + r.hair.trt + r.hair.scattered, vec3(1e-5));
#endif
}

Response lobe_hair(Reflector r, Cosines c) {
#ifdef SHADE_HAIR
    HairLight light = hair_light(r.hair, r.normal, c.to_light, c.l_v);
    float lit = lit_strands(r.hair.density, dot(r.normal, c.to_light), r.n_v);
    return Response((lit * light.transmitted + light.scattered) * (kPi / r.diffuse), lit * light.reflected, 0.0);
#else
    return Response(vec3(0.0), 0.0, 0.0);
#endif
}

// Shading model Toon: the light n.l, less what is shadowed, looks up the color of the diffuse light in a ramp; highlights
// are flat, where (n.h)^shininess is above a half. Does not mirror the environment. Reflector::own: x = shininess, y =
// index of the material, z = number of bands.
// Techniques: tex.toon-ramp

#include "lib/toon_ramp.glsl"

void prepare_toon(inout Reflector r, SurfaceSample s) {
    r.diffuse = s.albedo;
    vec4 specular = block_texel(s.material, kClassicBlock, 0);
    r.specular_0 = specular.rgb;
    r.mirror = vec3(0.0);
    r.own = vec4(specular.a, float(s.material), block_texel(s.material, kToonBlock, 0).w, 0.0);
}

Response lobe_toon(Reflector r, Cosines c) {
    vec3 color = toon_ramp(uint(r.own.y), int(r.own.z), c.n_l);
    float highlight = toon_step(0.5, pow(c.n_h, r.own.x)) * clamp(c.n_l / kToonBlend, 0.0, 1.0);
    return Response(color, highlight / kPi, 0.0);
}

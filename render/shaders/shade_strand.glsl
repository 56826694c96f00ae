// Shading model Strand: threads, blades or scratches along the tangent of the surface (lib/strand.glsl). n.l of the
// surface attenuates their light, since they shadow each other where it is turned away. Does not mirror the environment.
// Reflector::own: x = shininess, yzw = direction of the strands.
// Techniques: shade.strand-banks

#include "lib/lobe_tables.glsl"
#include "lib/material_record.glsl"
#include "lib/strand.glsl"

// Any direction across the normal, for meshes without tangents.
vec3 some_strand(vec3 normal) {
    vec3 axis = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    return normalize(cross(axis, normal));
}

void prepare_strand(inout Reflector r, SurfaceSample s) {
    vec4 specular = block_texel(s.material, kClassicBlock, 0);
    r.diffuse = s.albedo;
    r.specular_0 = specular.rgb;
    r.mirror = vec3(0.0);
#ifdef STRANDS
#ifdef LOBE_FACTORS
    specular.a = lobe_layer(s.material);
#endif
    r.own = vec4(specular.a, s.strand_ws == vec3(0.0) ? some_strand(s.normal_ws) : s.strand_ws);
#endif
}

Response lobe_strand(Reflector r, Cosines c) {
    float u = dot(c.to_light, r.own.yzw);
    float v = dot(r.to_camera, r.own.yzw);
#ifdef LOBE_FACTORS
    float diffuse = lobe_sine(u);
    float highlight = lobe_power(max(diffuse * lobe_sine(v) - u * v, 0.0), r.own.x);
#else
    float diffuse = strand_diffuse(u);
    float highlight = pow(strand_mirrored(u, v), r.own.x);
#endif
    return Response(vec3(c.n_l * diffuse), c.n_l * highlight / kPi, 0.0);
}

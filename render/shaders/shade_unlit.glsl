// Shading model Unlit: (1 - m) color + m surroundings, m = metalness (env.control-map). split_unlit() has moved the
// first part into the emission and left the mirrored fraction m as albedo; lights add nothing.
// Techniques: env.control-map

void prepare_unlit(inout Reflector r, SurfaceSample s) {
    r.specular_0 = vec3(0.0);
    r.specular_90 = vec3(0.0);
    r.mirror = s.albedo;
    r.diffuse = vec3(0.0);
}

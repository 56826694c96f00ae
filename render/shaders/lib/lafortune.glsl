// A lobe of Lafortune et al. 1997 for red, green and blue: max(0, Cx (ux vx + uy vy) + Cz uz vz)^n, from the cosines
// of u and v at the normal and between them.
// Techniques: skin.brdf-lafortune
vec3 lafortune_lobe(vec3 across, vec3 along, vec3 exponent, float n_l, float n_v, float l_v) {
    vec3 base = across * (l_v - n_l * n_v) + along * (n_l * n_v);
    return mix(vec3(0.0), pow(max(base, vec3(1e-20)), exponent), greaterThan(base, vec3(0.0)));
}

// Octahedral mapping of unit vectors to the square [-1, 1]^2: the octahedron |x| + |y| + |z| = 1, its lower half
// folded outward. 16 bits per coordinate are exact to 0.004 degrees.
// After Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014.

// 1 or -1, never 0.
vec2 sign_not_zero(vec2 v) {
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

// `direction` != 0, of any length. +y maps to the center of the square.
vec2 octahedral_encode(vec3 direction) {
    vec2 p = direction.xz / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return direction.y >= 0.0 ? p : (1.0 - abs(p.yx)) * sign_not_zero(p);
}

vec3 octahedral_decode(vec2 p) {
    vec3 v = vec3(p.x, 1.0 - abs(p.x) - abs(p.y), p.y);
    float fold = max(-v.y, 0.0);
    v.xz -= sign_not_zero(v.xz) * fold;
    return normalize(v);
}

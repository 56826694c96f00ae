// The direction `v` in the space of an interpolated frame, whose vectors are shorter than 1 between vertices.
// Techniques: engine.opt-normalise

// By four square roots, exact for any lengths.
vec3 to_tangent_space_exact(vec3 v, vec3 tangent, vec3 bitangent, vec3 normal) {
    return normalize(vec3(dot(v, normalize(tangent)), dot(v, normalize(bitangent)), dot(v, normalize(normal))));
}
// By one: exact where the three have the same length. With lengths of k, 1 and 1 off by up to asin((1 - k) / (1 + k)).
vec3 to_tangent_space(vec3 v, vec3 tangent, vec3 bitangent, vec3 normal) {
    return normalize(vec3(dot(v, tangent), dot(v, bitangent), dot(v, normal)));
}

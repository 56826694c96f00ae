// Normals of skin and of two wrinkle maps, composed by masks and weights (wrinkle.maps.*). After Oat, "Animated Wrinkle
// Maps", 2007; normals are in tangent space.
// Techniques: wrinkle.maps.composite, wrinkle.maps.influence, wrinkle.maps.normal-add

// Adds x and y, and so the slopes: neither normal loses its detail.
vec3 add_normals(vec3 n, vec3 w) {
    vec3 sum = vec3(n.xy + w.xy, n.z * w.z);
    return sum * inversesqrt(max(dot(sum, sum), 1e-20));
}

// Influence of the stretched and the compressed map, 0 .. 1: overlapping regions add up.
vec2 wrinkle_influence(
    vec4 first_mask, vec4 second_mask, float third_mask, vec4 first_weights, vec4 second_weights, float third_weight) {
    float stretched = dot(first_mask, max(-first_weights, 0.0)) + dot(second_mask, max(-second_weights, 0.0))
        + third_mask * max(-third_weight, 0.0);
    float compressed = dot(first_mask, max(first_weights, 0.0)) + dot(second_mask, max(second_weights, 0.0))
        + third_mask * max(third_weight, 0.0);
    return min(vec2(stretched, compressed), 1.0);
}

// Not normalized in between. At an influence of 1 of the compressed map, the stretched one has no effect.
vec3 compose_by_lerp(vec3 n, vec3 stretched, vec3 compressed, vec2 influence) {
    vec3 w = mix(vec3(0.0, 0.0, 1.0), stretched, influence.x);
    return add_normals(n, mix(w, compressed, influence.y));
}

// Heights times influence, added.
vec3 compose_by_slopes(vec3 n, vec3 stretched, vec3 compressed, vec2 influence) {
    vec2 slope = n.xy / max(n.z, 0.05) + influence.x * stretched.xy / max(stretched.z, 0.05)
        + influence.y * compressed.xy / max(compressed.z, 0.05);
    return vec3(slope, 1.0) * inversesqrt(1.0 + dot(slope, slope));
}

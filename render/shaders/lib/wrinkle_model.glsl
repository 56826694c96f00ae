// Polynomials of the strain of skin, fitted by content/bake/wrinkle_model.h (face.wrinkle-model).
// Techniques: face.wrinkle-model

// The strain (tt, bb, tb) clamped to its range in the poses of the fit, and divided by its largest magnitude there.
// `range`: minimum and maximum of tt, then of bb; `range_tb`: of tb.
vec3 model_strain(vec3 strain, vec4 range, vec4 range_tb) {
    vec3 least = vec3(range.xz, range_tb.x);
    vec3 most = vec3(range.yw, range_tb.y);
    return clamp(strain, least, most) / max(max(-least, most), vec3(1e-3));
}

// The n-th term: x, y, z, their products, the products of three; 0 beyond them.
float model_term(vec3 x, int n) {
    float terms[20] = float[20](
        x.x, x.y, x.z,
        x.x * x.x, x.x * x.y, x.x * x.z, x.y * x.y, x.y * x.z, x.z * x.z,
        x.x * x.x * x.x, x.x * x.x * x.y, x.x * x.x * x.z, x.x * x.y * x.y, x.x * x.y * x.z, x.x * x.z * x.z,
        x.y * x.y * x.y, x.y * x.y * x.z, x.y * x.z * x.z, x.z * x.z * x.z, 0.0);
    return terms[n];
}

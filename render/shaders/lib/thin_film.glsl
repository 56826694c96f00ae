// Reflectance of a thin film on a base: KHR_materials_iridescence, after L. Belcour and P. Barla, "A Practical Extension
// to Microfacet Theory for the Modeling of Varying Iridescence", 2017. Interference of the light reflected at both
// sides of the film, integrated over the spectrum by Gaussian fits of the color matching functions.
// Techniques: shade.thin-film
// Source of shade.thin-film: Belcour and Barla 2017; KHR_materials_iridescence

float film_square(float x) {
    return x * x;
}
vec3 film_square(vec3 x) {
    return x * x;
}

// Reflectance at normal incidence between two indices of refraction.
float film_reflectance(float inner, float outer) {
    return film_square((inner - outer) / (inner + outer));
}
vec3 film_reflectance(vec3 inner, float outer) {
    return film_square((inner - outer) / (inner + outer));
}

// Sensitivity of the eye to a modulation of the spectrum by an optical path difference [nm], as linear Rec. 709.
vec3 film_sensitivity(float path, vec3 shift) {
    float phase = 2.0 * kPi * path * 1e-9;
    const vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const vec3 center = vec3(1.6810e6, 1.7953e6, 2.2084e6);
    const vec3 variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 xyz = height * sqrt(2.0 * kPi * variance) * cos(center * phase + shift) * exp(-variance * phase * phase);
    xyz.x += 9.7470e-14 * sqrt(2.0 * kPi * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase * phase);
    const mat3 kRec709 = mat3(
        3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    return kRec709 * (xyz / 1.0685e-7);
}

// `cosine` of the angle to the normal; thickness [nm]; base: reflectance of the base at normal incidence, in air.
vec3 thin_film(float cosine, float film_index, float thickness, vec3 base) {
    float index = mix(1.0, film_index, smoothstep(0.0, 0.03, thickness));  // no film: none of its reflections
    float inside2 = 1.0 - (1.0 - cosine * cosine) / (index * index);
    float inside = sqrt(max(inside2, 0.0));
    float top = film_reflectance(index, 1.0);
    top += (1.0 - top) * schlick_weight(cosine);
    float passed = 1.0 - top;
    vec3 root = sqrt(clamp(base, 0.0, 0.9999));
    vec3 base_index = (1.0 + root) / (1.0 - root);
    vec3 bottom = film_reflectance(base_index, index);
    bottom += (1.0 - bottom) * schlick_weight(inside);
    vec3 shift = kPi + mix(vec3(0.0), vec3(kPi), lessThan(base_index, vec3(index)));
    vec3 both = clamp(top * bottom, 1e-5, 0.9999);
    vec3 mean = passed * passed * bottom / (1.0 - both);
    vec3 sum = top + mean;
    vec3 order = mean - passed;
    float path = 2.0 * index * thickness * inside;
    for (int m = 1; m <= 2; ++m) {
        order *= sqrt(both);
        sum += order * 2.0 * film_sensitivity(float(m) * path, float(m) * shift);
    }
    return clamp(sum, 0.0, 1.0);
}

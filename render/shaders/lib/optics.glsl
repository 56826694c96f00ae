// Reflection and refraction at the boundary of two clear media; see ecs/base/optics.h. to_light points away from the
// surface; eta is the refractive index on that side over the one beyond, index is the inverse.
// Techniques: water.fresnel, water.fresnel-approx, water.snell-vectors

// Direction in which reflected light leaves.
vec3 reflect_ray(vec3 normal, vec3 to_light) {
    return 2.0 * dot(normal, to_light) * normal - to_light;
}

// Direction in which refracted light leaves, or 0 for total internal reflection. The normal may point to either side.
vec3 refract_ray(vec3 normal, vec3 to_light, float eta) {
    float cosine = dot(normal, to_light);
    vec3 facing = cosine < 0.0 ? -normal : normal;
    float cos_in = abs(cosine);
    float radicand = 1.0 - eta * eta + eta * eta * cos_in * cos_in;
    return radicand < 0.0 ? vec3(0.0) : (eta * cos_in - sqrt(radicand)) * facing - eta * to_light;
}

// Reflectance 0 .. 1 for unpolarized light; cos_in = |N.L|. Exact (Fresnel).
float fresnel(float cos_in, float index) {
    float c = clamp(cos_in, 0.0, 1.0);
    float inverse2 = 1.0 / (index * index);
    float radicand = 1.0 - inverse2 + inverse2 * c * c;
    if (radicand < 0.0) {
        return 1.0;
    }
    const float kTiny = 1e-20;  // for grazing light at index 1
    float beyond = sqrt(radicand);
    float s = (c - index * beyond) / max(c + index * beyond, kTiny);
    float p = (index * c - beyond) / max(index * c + beyond, kTiny);
    return 0.5 * (s * s + p * p);
}

// Within 0.06 of fresnel() from air into water (Schlick 1994).
float fresnel_schlick(float cos_in, float index) {
    float root = (index - 1.0) / (index + 1.0);
    float normal_incidence = root * root;
    float m = 1.0 - clamp(cos_in, 0.0, 1.0);
    return normal_incidence + (1.0 - normal_incidence) * (m * m) * (m * m) * m;
}

// For water only, by the angle (T'so and Barsky 1987). Too bright by up to 0.27.
float fresnel_tso_barsky(float cos_in) {
    const float k4OverPi = 1.27323954473516;
    float u = max(0.0, acos(clamp(cos_in, 0.0, 1.0)) * k4OverPi - 1.0);
    return 0.02 + 0.98 * u * u;
}

// Surface reflectance. Every function returns the reflected light for an irradiance of 1 on a plane that faces
// the light; cosines are named n_l = dot(normal, to_light) and so on, with h halfway between l and v.
// Techniques: fakephong.vectors, light.lit, light.microfacet, shade.stdlib

const float kPi = 3.14159265358979;

// Coefficients (1, diffuse, specular, 1) of light.lit; no specular where the light is below the horizon.
vec4 lit(float n_l, float n_h, float shininess) {
    float diffuse = max(n_l, 0.0);
    float specular = n_l > 0.0 && n_h > 0.0 ? pow(n_h, shininess) : 0.0;
    return vec4(1.0, diffuse, specular, 1.0);
}

// (n.h, v.h) of the half vector h of l and v, from cosines alone: |l + v| = sqrt(2 + 2 l.v). Both 0 where l = -v.
vec2 half_cosines(float n_l, float n_v, float l_v) {
    float inverse_length = inversesqrt(max(2.0 + 2.0 * l_v, 1e-8));
    return vec2(clamp((n_l + n_v) * inverse_length, 0.0, 1.0), clamp((1.0 + l_v) * inverse_length, 0.0, 1.0));
}

// GGX distribution times height-correlated Smith visibility, times n.l: the specular lobe without Fresnel.
// alpha2 = roughness^4 (perceptual). Walter et al. 2007; Heitz 2014.
float ggx_lobe(float n_l, float n_v, float n_h, float alpha2) {
    float t = n_h * n_h * (alpha2 - 1.0) + 1.0;
    float smith_v = n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2);
    float smith_l = n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2);
    return n_l * alpha2 * 0.5 / max(kPi * t * t * (smith_v + smith_l), 1e-7);
}

// The same for roughness that differs along a unit vector in the surface and across it: alphas = roughness^2 of both.
// Burley 2012; Heitz 2014.
float anisotropic_lobe(float n_l, float n_v, vec3 to_light, vec3 to_camera, vec3 normal, vec3 along, vec2 alphas) {
    vec3 across = cross(normal, along);
    vec2 l = vec2(dot(to_light, along), dot(to_light, across));
    vec2 v = vec2(dot(to_camera, along), dot(to_camera, across));
    vec3 h = vec3(l + v, n_l + n_v);
    h *= inversesqrt(max(dot(h, h), 1e-12));
    float product = alphas.x * alphas.y;
    vec3 stretched = vec3(alphas.yx * h.xy, product * h.z);
    float w2 = product / max(dot(stretched, stretched), 1e-12);
    float smith_v = n_l * length(vec3(alphas * v, n_v));
    float smith_l = n_v * length(vec3(alphas * l, n_l));
    return n_l * product * w2 * w2 * 0.5 / max(kPi * (smith_v + smith_l), 1e-7);
}

// (1 - v.h)^5 of Schlick's Fresnel term f0 + (1 - f0) (1 - v.h)^5.
float schlick_weight(float v_h) {
    float m = clamp(1.0 - v_h, 0.0, 1.0);
    float m2 = m * m;
    return m2 * m2 * m;
}

// Perceptual roughness below which point lights would leave highlights smaller than a pixel.
const float kMinRoughness = 0.045;

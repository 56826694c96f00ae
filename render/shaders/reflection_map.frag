// Prefilters the environment for one roughness: one mip level of a reflection map. The mean of radiance over GGX half
// vectors, weighted by n.l, for a view along the normal (Karis 2013). A cube map is read at the mip level that matches
// the solid angle of each sample: few samples then catch even a small sun, without fireflies (Krivanek and Colbert,
// "Real-time Shading with Filtered Importance Sampling", 2008).
// Techniques: env.image-based-light
#version 450
#include "lib/sky.glsl"
#include "lib/reflection_map.glsl"

uniform float roughness;
uniform float size;      // side of this level [px]
uniform int samples;

layout(location = 0) out vec4 radiance;

const float kTwoPi = 6.28318530718;

// Radiance from `l`, averaged over the solid angle if the environment is a cube map.
vec3 radiance_about(vec3 l, float solid_angle) {
#if SKY_KIND == 3
    float face = float(textureSize(sky_cube, 0).x);
    float texels = solid_angle * 6.0 * face * face / (2.0 * kTwoPi);
    return textureLod(sky_cube, l, 0.5 * log2(max(texels, 1.0))).rgb;
#else
    return sky_radiance(l);
#endif
}

void main() {
    vec3 n = bordered_direction(gl_FragCoord.xy, size);
    vec3 t = normalize(abs(n.y) < 0.99 ? cross(vec3(0.0, 1.0, 0.0), n) : cross(vec3(1.0, 0.0, 0.0), n));
    vec3 b = cross(n, t);
    float alpha = roughness * roughness;
    float alpha2 = max(alpha * alpha, 1e-7);
    float texel = 2.0 * kTwoPi / (size * size);  // solid angle

    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < samples; ++i) {
        // Hammersley points: evenly spread, the same for every texel.
        float u = (float(i) + 0.5) / float(samples);
        float phi = kTwoPi * float(bitfieldReverse(uint(i))) * 2.3283064365386963e-10;
        float c2 = (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u);
        float sine = sqrt(max(1.0 - c2, 0.0));
        vec3 h = sine * (cos(phi) * t + sin(phi) * b) + sqrt(c2) * n;
        float n_h = sqrt(c2);
        vec3 l = 2.0 * n_h * h - n;
        float n_l = max(dot(n, l), 0.0);
        // The density of h is D(h) n.h; that of l is D / 4.
        float lobe = (alpha2 - 1.0) * c2 + 1.0;
        float density = alpha2 / (2.0 * kTwoPi * lobe * lobe);
        sum += radiance_about(l, max(1.0 / (float(samples) * density), texel)) * n_l;
        weights += n_l;
    }
    radiance = vec4(sum / max(weights, 1e-6), 1.0);
}

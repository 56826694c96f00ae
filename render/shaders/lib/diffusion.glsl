// The normalized diffusion profile (material_subsurface_gpu.h).
// Techniques: skin.transmission

const float kMinDiffusion = 1e-6;  // d below which light does not spread [m]

// Fraction of uniform light behind a slab that passes its thickness [m]: the integral of the profile beyond it.
vec3 transmitted_fraction(float thickness, vec3 d) {
    vec3 x = exp(-thickness / (3.0 * max(d, vec3(kMinDiffusion))));
    return mix(vec3(0.0), x * (0.75 + 0.25 * x * x), greaterThan(d, vec3(kMinDiffusion)));
}

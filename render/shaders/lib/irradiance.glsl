// Irradiance as nine spherical harmonics of the normal, whose constants are folded into the coefficients
// (Ramamoorthi and Hanrahan 2001); the same as render/environment/environment_light.cpp.

#include "environment_gpu.h"

// The nine basis functions without their constants.
float[9] harmonics(vec3 n) {
    return float[9](
        1.0, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3.0 * n.z * n.z - 1.0, n.x * n.z, n.x * n.x - n.y * n.y);
}

// Squares of the constants, times the band factors of convolution with the clamped cosine / pi.
const float kHarmonicFactors[9] = float[9](
    0.0795774715, 0.159154943, 0.159154943, 0.159154943, 0.298415518, 0.298415518, 0.0248679599, 0.298415518,
    0.0746038796);

// Irradiance / pi on a plane with this normal.
vec3 irradiance_toward(Irradiance e, vec3 n) {
    vec3 sum = e.coefficients[0].rgb + e.coefficients[1].rgb * n.y + e.coefficients[2].rgb * n.z
               + e.coefficients[3].rgb * n.x + e.coefficients[4].rgb * (n.x * n.y)
               + e.coefficients[5].rgb * (n.y * n.z) + e.coefficients[6].rgb * (3.0 * n.z * n.z - 1.0)
               + e.coefficients[7].rgb * (n.x * n.z) + e.coefficients[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}

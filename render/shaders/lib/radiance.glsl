// Radiance as written to a render target. Definition HALF_FLOATS: targets have half floats, where more than 65504
// becomes infinite, which spoils every mean or is left out of it. NaN becomes black there: min() would make it the
// brightest.

#include "lib/numbers.glsl"

const float kMaxHalfFloat = 65504.0;

vec3 storable(vec3 radiance) {
#ifdef HALF_FLOATS
    return mix(min(radiance, vec3(kMaxHalfFloat)), vec3(0.0), is_nan(radiance));
#else
    return radiance;
#endif
}

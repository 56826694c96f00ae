// Radiance as written to a render target. Definition HALF_FLOATS: targets have half floats, where more than 65504
// becomes infinite, which spoils every mean or is left out of it.

const float kMaxHalfFloat = 65504.0;

vec3 storable(vec3 radiance) {
#ifdef HALF_FLOATS
    return min(radiance, vec3(kMaxHalfFloat));
#else
    return radiance;
#endif
}

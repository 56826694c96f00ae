// Tests for NaN and infinity by their bits. Compilers may assume that NaN does not occur; isnan, x != x, min, max and
// comparisons then give results that differ from driver to driver.

bool is_nan(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}
bvec3 is_nan(vec3 v) {
    return greaterThan(floatBitsToUint(v) & 0x7fffffffu, uvec3(0x7f800000u));
}

bool is_infinite(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u;
}
bvec3 is_infinite(vec3 v) {
    return equal(floatBitsToUint(v) & 0x7fffffffu, uvec3(0x7f800000u));
}

// Neither infinite nor NaN.
bool is_finite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}
bool is_finite(vec2 v) {
    return is_finite(v.x) && is_finite(v.y);
}
bool is_finite(vec3 v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

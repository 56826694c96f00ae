// Functions made only of additions, multiplications and bit operations, bit-identical to those of
// ecs/base/repeatable_math.h. `precise` prevents fused multiply-add.

float repeatable_reciprocal(float x) {
    uint bits = floatBitsToUint(x);
    precise float size = uintBitsToFloat(bits & 0x7fffffffu);
    precise float y = uintBitsToFloat(0x7ef311c7u - (bits & 0x7fffffffu));
    for (int i = 0; i < 4; ++i) {
        y = y * (2.0 - size * y);
    }
    return uintBitsToFloat(floatBitsToUint(y) | (bits & 0x80000000u));
}

float repeatable_inverse_root(float x) {
    precise float y = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(x) >> 1));
    precise float half_x = 0.5 * x;
    for (int i = 0; i < 4; ++i) {
        y = y * (1.5 - half_x * y * y);
    }
    return y;
}

// |angle| <= 1.2.
vec2 repeatable_cos_sin(float angle) {
    const float kCosine[6] =
        float[6](-1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0);
    const float kSine[6] =
        float[6](-1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0);
    precise float a2 = angle * angle;
    precise float cosine = 0.0;
    precise float sine = 0.0;
    for (int i = 0; i < 6; ++i) {
        cosine = cosine * a2 + kCosine[i];
        sine = sine * a2 + kSine[i];
    }
    sine = sine * angle;
    return vec2(cosine, sine);
}

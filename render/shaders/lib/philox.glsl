// Philox4x32-10, the random numbers of ecs/base/rng.h.

uvec4 philox(uvec4 counter, uvec2 key) {
    for (int i = 0; i < 10; ++i) {
        uint a_high, a_low, b_high, b_low;
        umulExtended(0xd2511f53u, counter.x, a_high, a_low);
        umulExtended(0xcd9e8d57u, counter.z, b_high, b_low);
        counter = uvec4(b_high ^ counter.y ^ key.x, b_low, a_high ^ counter.w ^ key.y, a_low);
        key += uvec2(0x9e3779b9u, 0xbb67ae85u);
    }
    return counter;
}

// 0 <= x < 1, of one word.
float unit_float(uint word) {
    return float(word >> 8) * (1.0 / 16777216.0);
}

// Steps between pictures of which one is about half as large as the other, and both show the same. A texel of the
// smaller one stands for a tent over the larger one, twice as wide as the texel: neighbors overlap so that all tents
// together weigh every point the same.

// Area of a tent of height 1 over -1 .. 1 that lies to the left of x.
float tent_area(float x) {
    float outside = 1.0 - min(abs(x), 1.0);
    float tail = 0.5 * outside * outside;
    return x < 0.0 ? tail : 1.0 - tail;
}

// Share of the tent about `middle` of half-width `ratio` that lies in from .. to [pixels of the larger picture].
float tent_share(float from, float to, float middle, float ratio) {
    return tent_area((to - middle) / ratio) - tent_area((from - middle) / ratio);
}

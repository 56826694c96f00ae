// Down- and upsampling between images of which one is about half as large as the other. A texel of the smaller one
// is a tent over the larger one, twice as wide as the texel. Neighboring tents overlap and sum to 1 everywhere,
// whatever the sizes, so that energy is conserved. Images are mirrored beyond their borders.

// Area of a tent of height 1 over -1 .. 1 that lies to the left of x.
float tent_area(float x) {
    float outside = 1.0 - min(abs(x), 1.0);
    float tail = 0.5 * outside * outside;
    return x < 0.0 ? tail : 1.0 - tail;
}

// Fraction of the tent about `center` of half-width `ratio` that lies in from .. to [pixels of the larger image].
float tent_fraction(float from, float to, float center, float ratio) {
    return tent_area((to - center) / ratio) - tent_area((from - center) / ratio);
}

// The same for pixel `at` smoothed with its two neighbors by [1 2 1] / 4.
float smooth_fraction(float at, float center, float ratio) {
    return 0.25
           * (tent_fraction(at, at + 2.0, center, ratio) + tent_fraction(at - 1.0, at + 1.0, center, ratio));
}

int mirrored(int at, int size) {
    at = at < 0 ? -1 - at : at;
    // Without a remainder of integers, which a software OpenGL divides one by one.
    at -= 2 * size * int(floor((float(at) + 0.5) / float(2 * size)));
    return at < size ? at : 2 * size - 1 - at;
}

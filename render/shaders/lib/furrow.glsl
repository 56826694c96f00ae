// The image on which furrows are drawn, as in content/bake/furrow_trace.cpp.

uniform ivec2 size;  // [px]
uniform ivec2 wraps; // 1: the image repeats to the right, downwards

// `i` within an image that repeats; % is undefined for negative numbers.
int wrapped_index(int i, int period) {
    return i >= 0 ? i % period : period - 1 - (-1 - i) % period;
}

// Index of the pixel, or -1 beyond the borders of the image.
int pixel_index(ivec2 at) {
    if (wraps.x != 0) {
        at.x = wrapped_index(at.x, size.x);
    }
    if (wraps.y != 0) {
        at.y = wrapped_index(at.y, size.y);
    }
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
    return inside ? at.y * size.x + at.x : -1;
}

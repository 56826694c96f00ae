// Ways that pixels go while the shutter is open.

// Half of a way [px], cut to the longest. NaN and infinity are no motion: better sharp than a picture of NaN.
vec2 bounded_motion(vec2 reach, float longest) {
    float len = length(reach);
    return len < 1e7 ? reach * (min(len, longest) / max(len, 1e-6)) : vec2(0.0);
}

// Whether something that reaches so far gets there; over one pixel, as edges lie between them.
float covers(float reach, float way) {
    return clamp(reach - way + 0.5, 0.0, 1.0);
}

// The mean of what a pixel sees on its way from -motion to motion [px]: a box filter, read where the way crosses
// columns or rows of pixels; of more than `most` of them one in so many.
vec3 mean_along(sampler2D picture, vec2 pixel, vec2 motion, int most, float jitter) {
    ivec2 last = textureSize(picture, 0) - 1;
    float reach = max(abs(motion.x), abs(motion.y));
    vec2 pace = motion / max(reach, 1e-6);
    int far = int(reach + 0.5);
    int stride = (2 * far + most) / most;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = int(jitter * float(stride)) - far; k <= far; k += stride) {
        ivec2 there = clamp(ivec2(floor(pixel + float(k) * pace)), ivec2(0), last);
        float weight = covers(reach, abs(float(k)));
        sum += weight * texelFetch(picture, there, 0).rgb;
        weights += weight;
    }
    return sum / weights;
}

// By how much a point of a surface with this unit normal is taken along when the surface moves, in the space of both:
// the motion where it goes ahead of its surface, backward where it follows, nothing where it slides along
// (post.motion-blur-optic-flow).
vec3 flow_offset(vec3 normal, vec3 motion) {
    float len = length(motion);
    return len > 1e-9 ? dot(normal, motion / len) * motion : vec3(0.0);
}

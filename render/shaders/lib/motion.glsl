// Motion of pixels while the shutter is open.
// Techniques: post.motion-blur-camera-psf

#include "lib/numbers.glsl"

// Half of a motion [px], clamped in length. NaN and infinity become no motion.
vec2 bounded_motion(vec2 motion, float longest) {
    float len = length(motion);
    return is_finite(motion) && len < 1e7 ? motion * (min(len, longest) / max(len, 1e-6)) : vec2(0.0);
}

// Whether a motion of `length_px` covers the distance `offset` [px]; a ramp one pixel wide, for edges between pixels.
float covers(float length_px, float offset) {
    return clamp(length_px - offset + 0.5, 0.0, 1.0);
}

// Box filter from -motion to motion [px], sampled where that line crosses pixel columns or rows; at most about
// `max_samples` of them, at a regular stride.
vec3 mean_along(sampler2D image, vec2 pixel, vec2 motion, int max_samples, float jitter) {
    ivec2 last = textureSize(image, 0) - 1;
    float range = max(abs(motion.x), abs(motion.y));
    vec2 pace = motion / max(range, 1e-6);
    int far = int(range + 0.5);
    int stride = (2 * far + max_samples) / max_samples;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = int(jitter * float(stride)) - far; k <= far; k += stride) {
        ivec2 at = clamp(ivec2(floor(pixel + float(k) * pace)), ivec2(0), last);
        float weight = covers(range, abs(float(k)));
        sum += weight * texelFetch(image, at, 0).rgb;
        weights += weight;
    }
    return sum / weights;
}

// Offset of a point with this unit normal on a moving surface, in the space of both: the motion on leading faces, its
// opposite on trailing ones, zero where the surface slides along itself (post.motion-blur-optic-flow).
vec3 flow_offset(vec3 normal, vec3 motion) {
    float len = length(motion);
    return len > 1e-9 ? dot(normal, motion / len) * motion : vec3(0.0);
}

// Motion of pixels while the shutter is open.
// Techniques: post.motion-blur-camera-psf

#include "lib/numbers.glsl"

// Half of a motion [px], clamped in length. NaN and infinity become no motion.
vec2 bounded_motion(vec2 reach, float longest) {
    float len = length(reach);
    return is_finite(reach) && len < 1e7 ? reach * (min(len, longest) / max(len, 1e-6)) : vec2(0.0);
}

// Whether a motion of length `reach` covers the distance `offset`; a ramp one pixel wide, for edges between pixels.
float covers(float reach, float offset) {
    return clamp(reach - offset + 0.5, 0.0, 1.0);
}

// Box filter from -motion to motion [px], sampled where that line crosses pixel columns or rows; at most about
// `max_samples` of them, at a regular stride.
vec3 mean_along(sampler2D image, vec2 pixel, vec2 motion, int max_samples, float jitter) {
    ivec2 last = textureSize(image, 0) - 1;
    float reach = max(abs(motion.x), abs(motion.y));
    vec2 pace = motion / max(reach, 1e-6);
    int far = int(reach + 0.5);
    int stride = (2 * far + max_samples) / max_samples;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = int(jitter * float(stride)) - far; k <= far; k += stride) {
        ivec2 there = clamp(ivec2(floor(pixel + float(k) * pace)), ivec2(0), last);
        float weight = covers(reach, abs(float(k)));
        sum += weight * texelFetch(image, there, 0).rgb;
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

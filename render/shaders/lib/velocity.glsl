// Screen-space motion since the previous frame, as a difference of texture coordinates (current - previous).

#include "lib/numbers.glsl"

const float kMaxVelocity = 8.0;          // image sizes
const float kMinVelocity = 1.0 / 256.0;  // [px]; less is rounding: OpenGL may snap vertices to as much

// `now`: NDC without the jitter. `previous`: clip x, y, w of the point in the previous frame, without the jitter;
// points beside or behind the camera map to far off screen. NaN becomes no motion. `size`: of the image [px].
vec2 velocity_from(vec2 now, vec3 previous, vec2 size) {
    vec2 motion = 0.5 * (now - previous.xy / max(previous.z, 1e-6));
    float speed = length(motion);
    bool moves = is_finite(motion) && length(motion * size) > kMinVelocity && speed < 1e15;
    return moves ? motion * min(1.0, kMaxVelocity / speed) : vec2(0.0);
}

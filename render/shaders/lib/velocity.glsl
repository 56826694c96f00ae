// Motion over the picture since the moment before, as a difference of texture coordinates (now - before).

const float kFastest = 8.0;   // pictures
const float kSlowest = 1e-6;  // less is rounding

// `now`: NDC without the jitter. `before`: clip x, y, w of the same point, without the jitter; what was beside or
// behind the camera comes from far outside. What is no number stands still.
vec2 velocity_from(vec2 now, vec3 before) {
    vec2 motion = 0.5 * (now - before.xy / max(before.z, 1e-6));
    float speed = length(motion);
    return speed > kSlowest && speed < 1e15 ? motion * min(1.0, kFastest / speed) : vec2(0.0);
}

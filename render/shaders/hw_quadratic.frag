// The pixel program of appendix A (fakephong.hw-quadratic). Definition HW_REGISTER, a defect: s and t are passed in a
// color register, which has 8 bits and saturates at 1.
// Techniques: fakephong.hw-quadratic
#version 450
#define FACET_SAMPLES 6
#include "lib/sampled_light.glsl"

void main() {
    vec2 at = st;
#ifdef HW_REGISTER
    at = round(clamp(at, 0.0, 1.0) * 255.0) / 255.0;
#endif
    radiance = facet_radiance(quadratic_light(at));
}

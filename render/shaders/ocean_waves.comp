// Current wave spectrum and the first half of its transform, along z (water.fft-synthesis): one work group per line of
// a cascade. Spectra of two real fields a and b are packed in one complex line a + i b; the pairs are those of
// systems/water/ocean_kernels.h.
#version 450
#include "lib/fft_line.glsl"
#include "ocean_gpu.h"

// Wave (n, m) of cascade c, with n periods across the patch along x and m along z, is at (c * SIZE + n) * SIZE + m;
// indices from SIZE / 2 on are negative wave numbers from -SIZE / 2 on.
layout(std430, binding = kOceanWavesBinding) readonly buffer Waves {
    vec4 waves[];  // height ahead.xy e^(-i omega t) + behind.zw e^(i omega t) [m]
};
layout(std430, binding = kOceanFrequenciesBinding) readonly buffer Frequencies {
    float frequencies[];  // omega [rad/s]
};
// Point z of line n is at (c * SIZE + z) * SIZE + n, for the second half.
layout(std430, binding = kOceanLinesBinding) writeonly buffer Lines {
    Quad lines[];
};

uniform vec4 patches;         // sides of the cascades [m]
uniform float choppiness;
uniform vec2 time_in_periods;   // t / 2 pi [s/rad]: a float and its rounding error

float signed_number(uint index) {
    return float(int(index) - (index < SIZE / 2u ? 0 : int(SIZE)));
}

/// Sine and cosine of omega t, reduced to one period in double precision.
vec2 phase_of(float frequency) {
    double turns = double(frequency) * (double(time_in_periods.x) + double(time_in_periods.y));
    float angle = kFullTurn * float(turns - floor(turns));
    return vec2(sin(angle), cos(angle));
}

Quad spectra_of(uint wave, vec2 k) {
    vec4 h0 = waves[wave];
    vec2 phase = phase_of(frequencies[wave]);
    vec2 h = (h0.xy + h0.zw) * phase.y + vec2(h0.y - h0.w, h0.z - h0.x) * phase.x;
    float number = length(k);
    vec2 push = number > 0.0 ? choppiness * k / number : vec2(0.0);
    return Quad(
        vec4((1.0 - push.x) * h, -(k.x * push.x + k.x) * h),
        vec4(-(k.y * push.y + k.y) * h, -(k.x * push.y + push.y) * h));
}

void main() {
    uint cascade = gl_WorkGroupID.y;
    uint n = gl_WorkGroupID.x;
    float step = kFullTurn / patches[cascade];
    for (uint m = gl_LocalInvocationID.x; m < SIZE; m += kLineGroup) {
        vec2 k = step * vec2(signed_number(n), signed_number(m));
        store_line(m, spectra_of((cascade * SIZE + n) * SIZE + m, k));
    }
    transform_line();
    for (uint z = gl_LocalInvocationID.x; z < SIZE; z += kLineGroup) {
        lines[(cascade * SIZE + z) * SIZE + n] = load_line(z);
    }
}

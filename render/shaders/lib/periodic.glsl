// Periodic functions (engine.periodic), like ecs/components/periodic.cpp, for times within float precision.
// Techniques: engine.periodic
#include "lib/noise.glsl"

const int kWaveTriangle = 1;
const int kWaveSquare = 2;
const int kWaveSawtooth = 3;
const int kWaveNoise = 4;

// -1 .. 1 at `turns` periods after `phase`.
float periodic_wave(int wave, float turns, float phase) {
    if (wave == kWaveNoise) {
        return 2.0 * noise(turns, floatBitsToUint(phase), 3) - 1.0;
    }
    float at = fract(fract(turns) + fract(phase));
    return wave == kWaveTriangle   ? 1.0 - 4.0 * abs(at - floor(at + 0.25) - 0.25)
           : wave == kWaveSquare   ? (at < 0.5 ? 1.0 : -1.0)
           : wave == kWaveSawtooth ? 2.0 * at - 1.0
                                   : sin(6.28318530718 * at);
}

#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// One period of a PeriodicFunction, -1 .. 1, over x = 0 .. 1.
enum class Wave : std::uint8_t {
    Sine,      ///< 0, 1, 0, -1
    Triangle,  ///< likewise, along straight lines
    Square,    ///< 1, then -1
    Sawtooth,  ///< rises from -1 to 1
    Noise,     ///< smooth, never the same again; each phase gives another sequence
};

/// A number that varies with time (engine.periodic): base + amplitude wave(phase + frequency t).
/// The default varies between 0 and 1 within a second.
struct PeriodicFunction {
    Wave wave = Wave::Sine;
    float base = 0.5f;
    float amplitude = 0.5f;
    float phase = 0;
    float frequency = 1;

    bool operator==(const PeriodicFunction&) const = default;
};

LIMN_FIELDS(PeriodicFunction) {
    LIMN_FIELD(
        wave, .doc = "waveform, between -1 and 1; noise flickers like a flame",
        .values = "sine triangle square sawtooth noise");
    LIMN_FIELD(base, "what it varies about", "", -1000, 1000);
    LIMN_FIELD(amplitude, "how far it goes from there; 0: constant", "", -1000, 1000);
    LIMN_FIELD(phase, "fraction of a period at time 0; of noise, another sequence for each");
    LIMN_FIELD(frequency, "periods per second", "Hz", 0, 1000);
}

/// Does not vary.
[[nodiscard]] inline constexpr PeriodicFunction constant_function(float value) {
    return {.base = value, .amplitude = 0};
}

/// At `time` [s], which may be as long as a double can tell fractions of a period: the phase is
/// reduced to one period in double precision. Without NaN, whatever the function and time.
[[nodiscard]] float evaluate(const PeriodicFunction& function, double time);

/// The same, clamped to 0 .. 1: a fraction.
[[nodiscard]] float evaluate_share(const PeriodicFunction& function, double time);

}  // namespace limn

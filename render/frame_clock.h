#pragma once

#include "ecs/components/transform.h"

#include <cstdint>
#include <optional>

namespace limn {

/// Detects cuts between consecutive frames.
struct FrameClock {
    bool running = false;
    std::uint64_t world = 0;  ///< of the last frame
    double time = 0.0;        ///< [s]
    Affine camera;
};

/// Simulated seconds since the previous frame; nullopt after a cut: another world, time that ran
/// backward or forward by more than a second, or a camera that jumped (`cut`, is_cut).
[[nodiscard]] std::optional<float> seconds_since_last(
    FrameClock& clock, std::uint64_t world, double time, const Affine& camera, bool cut = false);

}  // namespace limn

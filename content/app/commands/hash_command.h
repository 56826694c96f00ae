#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <optional>
#include <string>

namespace limn {

// Shown by `limn hash museum --frames 20`: engine.animate

/// `limn hash`: a hash of the world's state after every step.
struct HashOptions {
    std::string scene;
    int frames = 60;
    int threads = 0;  ///< 0 = all hardware threads
    std::optional<std::uint64_t> seed;
};

/// Prints one line "frame hash" per step, the hash as 16 hex digits.
[[nodiscard]] Status run_hash(const HashOptions& options);

}  // namespace limn

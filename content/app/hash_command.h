#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <optional>
#include <string>

namespace limn {

/// `limn hash`: the state of the world after every step, as one number.
struct HashOptions {
    std::string scene;
    int frames = 60;
    int threads = 0;  ///< 0 = as many as the machine has
    std::optional<std::uint64_t> seed;
};

/// Prints "frame hash" a line, the hash in 16 hex digits.
[[nodiscard]] Status run_hash(const HashOptions& options);

}  // namespace limn

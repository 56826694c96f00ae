#pragma once

namespace limn::oracle {

// When a real branch pays off (shade.control-flow), by the cycle counts that the book measured in
// 2005: a shader either executes both sides and masks the writes of the untaken one, or jumps,
// which has its own overhead. On current GPUs the overhead is small, but a divergent warp executes
// both sides; software OpenGL always masks.

inline constexpr double kIfCycles = 4;      ///< if, endif
inline constexpr double kIfElseCycles = 6;  ///< if, else, endif
inline constexpr double kCallCycles = 2;    ///< call or return
inline constexpr double kLoopCycles = 4;    ///< loop, endloop

/// Whether skipping `body` cycles with this probability saves more than `cost` cycles.
[[nodiscard]] constexpr bool branch_pays(double body, double skip_probability, double cost) {
    return skip_probability * body > cost;
}

}  // namespace limn::oracle

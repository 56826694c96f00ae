#pragma once

namespace limn::oracle {

// When a true jump pays (shade.control-flow), by the cycles that the book measured in 2005: a
// shader either runs both sides of a branch and masks what the untaken one writes, or jumps, which
// has a price of its own. On today's GPUs the price is small but paid whenever one lane of a warp
// takes the branch; a software OpenGL always masks.

inline constexpr double kIfCycles = 4;      ///< if, endif
inline constexpr double kIfElseCycles = 6;  ///< if, else, endif
inline constexpr double kCallCycles = 2;    ///< call or return
inline constexpr double kLoopCycles = 4;    ///< loop, endloop

/// Whether jumping over `body` cycles with this probability saves more than `cost` cycles.
[[nodiscard]] constexpr bool jump_pays(double body, double skip_probability, double cost) {
    return skip_probability * body > cost;
}

}  // namespace limn::oracle

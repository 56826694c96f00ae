#pragma once

#include <cstdint>

namespace limn::gpu {

// When a branch or loop of a shader pays (shade.control-flow), by the cycles that control flow cost
// on the hardware of 2005: a jump is worth it where the cycles that it skips, times how often, are
// more than those that it costs itself.
// Techniques: shade.control-flow

inline constexpr double kIfCycles = 4;      ///< if, endif
inline constexpr double kIfElseCycles = 6;  ///< if, else, endif
inline constexpr double kLoopCycles = 4;    ///< loop, endloop, of each pass
inline constexpr int kMaxUnrolled = 8;      ///< a program for each number up to it

enum class BranchForm : std::uint8_t {
    Masked,  ///< both sides are executed, and one of them writes
    Jump,
};

/// `body`: cycles of what a jump skips; `skipped`: how often, 0 .. 1.
[[nodiscard]] constexpr BranchForm choose_branch(double body, double skipped, bool has_else) {
    return body * skipped > (has_else ? kIfElseCycles : kIfCycles) ? BranchForm::Jump
                                                                   : BranchForm::Masked;
}

/// Whether a loop with a count that is known when the program is compiled is unrolled: where its
/// jumps are a noticeable part of its cost.
[[nodiscard]] constexpr bool should_unroll(int count, double body) {
    return count <= kMaxUnrolled && kLoopCycles > 0.02 * body;
}

}  // namespace limn::gpu

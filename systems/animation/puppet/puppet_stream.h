#pragma once

#include "ecs/components/puppet.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// A stream of poses that arrive late, in any order, or not at all; and filters that know only the
// past. Pure functions of plain values.
// After G. Casiez et al., "1 Euro Filter: A Simple Speed-based Low-pass Filter for Noisy Input in
// Interactive Systems" (2012).
// Techniques: char.puppetry

/// Room for `packets` >= 2 packets of `joints` joints; what was in the stream is dropped.
void reset_stream(std::size_t packets, std::size_t joints, PuppetStream& stream);

/// Replaces the oldest packet, or the one of the same time. `turns`: one per joint. One that is
/// older than all is counted as late.
void push_packet(const PuppetPacket& packet, std::span<const Quat> turns, PuppetStream& stream);

/// What is played, and whether there was anything.
struct PlayedPose {
    PuppetPacket packet = {};
    bool is_valid = false;  ///< false: nothing has arrived yet
    bool is_held = false;   ///< nothing newer has arrived: this is the last pose
};
/// The pose at `time` of what has arrived until `now`: between two packets, or the last one before;
/// rotations into `turns`.
[[nodiscard]] PlayedPose
play_stream(const PuppetStream& stream, double time, double now, std::span<Quat> turns);

/// Share of the way to the input that a low-pass of first order goes in `dt` [s]; 1: no filter, for
/// a cutoff of 0 [Hz].
[[nodiscard]] float filter_share(float cutoff, float dt);

/// One-euro filters: the cutoff rises by `eagerness` with the speed. A cutoff of 0: no filter.
void filter_turn(const Quat& input, float cutoff, float eagerness, float dt, FilteredTurn& turn);

}  // namespace limn

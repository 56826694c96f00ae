#pragma once

#include "content/bake/marker_motion.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Repair of recorded markers, in this order: labels that were exchanged, gaps where a marker was
// hidden, noise (char.mocap-cleanup).

/// Markers that move together like points of a solid body, by their indices.
using MarkerSegment = std::vector<std::uint32_t>;

struct MarkerCleanup {
    float swap_margin = 0.02f;  ///< by which exchanged labels must fit better, rms [m]; 0: never
    float max_gap = 0.5f;       ///< longest gap that is filled [s]
    float cutoff = 8.0f;        ///< of the low-pass filter [Hz]; 0: none
};

struct CleanupCounts {
    std::size_t swaps = 0;     ///< exchanged pairs, counted in each frame
    std::size_t filled = 0;    ///< missing positions that were filled
    std::size_t unfilled = 0;  ///< that remain
};

/// Exchanges the labels of two markers in a frame where that makes the sum of squared errors
/// smaller by more than margin^2; the prediction moves each at constant velocity from its last two
/// visible positions. Returns the number of exchanges.
std::size_t restore_swaps(MarkerMotion& motion, float margin);

/// Fills gaps of at most `max_frames`. A marker of a segment with three other visible markers moves
/// rigidly with them, from both ends of the gap; others follow the cubic through the two visible
/// positions before the gap and the two after it. At the start and the end the nearest position is
/// held. Returns the number of positions filled.
std::size_t fill_marker_gaps(
    MarkerMotion& motion, std::span<const MarkerSegment> segments, std::size_t max_frames);

/// The low-pass filter of motion_filter.h over each interval in which a marker is visible.
void smooth_markers(MarkerMotion& motion, float cutoff);

/// All three.
CleanupCounts clean_markers(
    MarkerMotion& motion, std::span<const MarkerSegment> segments, const MarkerCleanup& options);

}  // namespace limn

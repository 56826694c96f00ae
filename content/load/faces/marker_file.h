#pragma once

#include "content/bake/marker_motion.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

// Recorded markers from a TRC file (Track Row Column, as Motion Analysis and OpenSim write it):
// text in columns between tabs, with the rate, the unit and the names of the markers in front.
//
//     PathFileType  4  (X/Y/Z)  take.trc
//     DataRate  CameraRate  NumFrames  NumMarkers  Units
//     60        60          2          2           mm
//     Frame#  Time  brow        lip
//                   X1  Y1  Z1  X2  Y2  Z2
//     1       0     1   2   3   4   5   6
//     2       0.02              4   5   6           the brow is hidden
//
// Times follow from the rate; the time column is ignored. A subject before all names, as in
// "Anna:brow", is removed.

struct MarkerLimits {
    std::size_t max_markers = 4096;
    std::size_t max_positions = std::size_t{1} << 24;  ///< of all frames
};

/// Fails with one line: file, line, what was found and what was expected. `file` is for messages.
[[nodiscard]] Result<MarkerMotion>
parse_trc(std::string_view text, const std::string& file, const MarkerLimits& limits = {});

[[nodiscard]] Result<MarkerMotion> load_trc(const std::string& path);

}  // namespace limn

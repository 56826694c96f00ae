#pragma once

#include "content/load/motion/bvh_file.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// A channel of a joint over time, one value per frame.
struct ChannelCurve {
    std::string name;           ///< "Zrotation"
    std::vector<float> values;  ///< degrees, or file's unit
};

/// The rotation channels of a joint. Fails with one line on an unknown joint and on one without.
[[nodiscard]] Result<std::vector<ChannelCurve>>
find_channel_curves(const BvhFile& bvh, const std::string& joint);

/// Distance of the lines of a plot's grid: a step of 1, 2 or 5 times a power of ten that divides
/// `range` > 0 into at most ten.
[[nodiscard]] double nice_plot_step(double range);

/// The curves as an SVG with axes of degrees and seconds; each passes through all its samples
/// (char.ghost-view).
[[nodiscard]] std::string
plot_curves(const std::string& title, const std::vector<ChannelCurve>& curves, float frame_time);

}  // namespace limn

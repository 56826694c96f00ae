#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

// Shown by `limn compare a.png b.png`: fakephong.metric-color

/// `limn compare`: compares two images of equal size.
struct CompareOptions {
    std::string a;
    std::string b;
    std::string diff;   ///< PNG of the difference; empty = none
    bool json = false;  ///< print JSON instead of a table
};

[[nodiscard]] Status run_compare(const CompareOptions& options);

/// How far two images are from each other as displayed.
struct DisplayedDifference {
    double psnr = 0;     ///< [dB]; infinite: equal
    double largest = 0;  ///< of a channel, 0 .. 1
};
/// Fails where one cannot be read, or where they have different sizes.
[[nodiscard]] Result<DisplayedDifference>
compare_displayed(const std::string& a, const std::string& b);

}  // namespace limn

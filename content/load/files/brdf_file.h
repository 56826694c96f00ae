#pragma once

#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Text files of fitted reflectance (skin.brdf-lafortune), a word and its numbers on a line, `#`
// before comments:
//
//     channel 0.60          # diffuse part D, 0 .. 1; then the lobes of the channel
//     lobe -0.95 0.95 20    # Cx = Cy, Cz, exponent
//
// for red, green and blue in this order.

struct BrdfFit {
    Vec3 diffuse = {0, 0, 0};
    std::vector<LafortuneLobe> lobes;  ///< shorter channels are padded with zero lobes
};

/// `file` is the prefix of messages. Fails with the line and what was expected if a line is no
/// such line, a number is not finite or out of range, or there are not three
/// channels with at most kMaxLafortuneLobes each.
[[nodiscard]] Result<BrdfFit> parse_brdf(std::string_view text, const std::string& file);

}  // namespace limn

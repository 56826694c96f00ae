#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

// What the passes between radiance and display hand to one another.

/// Luminance blurred for dodge and burn: scale i is a Gaussian of variance 1.6^(2 i) / 16 [px^2].
struct LocalLuminance {
    TextureId fine;    ///< scales 0 .. 3, as large as the picture
    TextureId middle;  ///< 4 .. 7, half as wide and high
    TextureId coarse;  ///< 8 and 9, a quarter
};

}  // namespace limn

#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

// Techniques: particle.depth-of-field

/// Depth of what the lens focuses on in each pixel: that of the view, but where particles cover
/// enough of the pixel, theirs. Published by ParticleFrontEffect, where there are such.
struct LensDepth {
    TextureId depth;
};

}  // namespace limn

#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

// Techniques: particle.depth-of-field

/// Depth that focus is computed from: that of the view, or of particles where these cover enough of
/// a pixel. Published by ParticleFrontEffect if there are such particles.
struct LensDepth {
    TextureId depth;
};

}  // namespace limn

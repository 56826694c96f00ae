#pragma once

#include "render/frame_data.h"
#include "render/shadow/light_bounds.h"

namespace limn {

namespace gpu {
class Device;
class Program;
}  // namespace gpu

// A layer of half the width and height over the scene, for what is soft and covers much. Its depth
// is that at the center of each four pixels where they are of one surface, else the nearest and the
// farthest of them, in turn like the squares of a chessboard. Enlarged, a pixel lies between its
// four nearest texels, without those that are of another surface, so that the layer neither spills
// over edges nor leaves a rim (Cantlay, "High-Speed, Off-Screen Particles", GPU Gems 3, 2007;
// nearest-depth filter of Jansen and Bavoil, "Fast Rendering of Opacity-Mapped Particles Using
// DirectX 11 Tessellation and Mixed Resolutions", 2011). Four pixels count as one
// surface where depth changes between them about as much as beside them, four texels where they are
// alike, or in one plane with the pixel: as ground at a shallow angle is.

struct ParticleLayer {
    LightBounds
        window;       ///< of the view's pixels: outside, it has nothing and its depth is undefined
    TextureId depth;  ///< D32F, as Gbuffer::depth
    TextureId radiance;  ///< premultiplied, opacity in a; the pass that draws it clears it
};

struct ParticleLayerPrograms {
    const gpu::Program* shrink = nullptr;
    const gpu::Program* enlarge = nullptr;
};
[[nodiscard]] Result<ParticleLayerPrograms> create_particle_layer_programs(gpu::Device& device);

/// Adds the pass that makes its depth from that of the view, for what is drawn within `window`.
[[nodiscard]] ParticleLayer begin_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, ViewData& view,
    const LightBounds& window);
/// Adds the pass that lays it over the view's radiance.
void end_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, const ParticleLayer& layer,
    ViewData& view);

}  // namespace limn

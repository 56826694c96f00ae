#pragma once

#include "render/frame_data.h"
#include "render/shadow/light_bounds.h"

namespace limn {

namespace gpu {
class Device;
class Program;
}  // namespace gpu

// A layer of half the width and height over the scene, for soft particles that cover much of the
// image. Its depth is that at the center of each 2 x 2 pixels if they are on one surface, else the
// nearest or the farthest of them, in a checkerboard. It is upsampled bilinearly, without texels on
// another surface than the pixel, so that the layer neither bleeds over edges nor leaves a halo
// (Cantlay, "High-Speed, Off-Screen Particles", GPU Gems 3, 2007; nearest-depth filter of Jansen
// and Bavoil, "Fast Rendering of Opacity-Mapped Particles Using DirectX 11 Tessellation and Mixed
// Resolutions", 2011). Four pixels are on one surface if the depth changes between them about as
// much as next to them; four texels, if their depths are similar or in one plane with the pixel, as
// on ground at a grazing angle.

struct ParticleLayer {
    LightBounds window;  ///< pixels of the view, outside of which it is empty, its depth undefined
    TextureId depth;     ///< D32F, as Gbuffer::depth
    TextureId radiance;  ///< premultiplied, opacity in a; the pass that draws it clears it
};

struct ParticleLayerPrograms {
    const gpu::Program* shrink = nullptr;
    const gpu::Program* enlarge = nullptr;
};
[[nodiscard]] Result<ParticleLayerPrograms> create_particle_layer_programs(gpu::Device& device);

/// Adds the pass that downsamples the view's depth within `window`.
[[nodiscard]] ParticleLayer begin_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, ViewData& view,
    const LightBounds& window);
/// Adds the pass that upsamples and composites the layer over the view's radiance.
void end_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, const ParticleLayer& layer,
    ViewData& view);

}  // namespace limn

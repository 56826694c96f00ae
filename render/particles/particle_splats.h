#pragma once

#include "render/frame_data.h"
#include "render/gpu/buffer.h"
#include "render/particles/particle_list.h"
#include "render/variant.h"

namespace limn {

namespace gpu {
class Device;
class Program;
}  // namespace gpu

struct GpuParticlePool;

// Points that the GPU moves and that only add light, drawn by a compute shader instead of the
// rasterizer, which takes several times as long where triangles and points have a few pixels
// (M. Schütz, B. Kerbl, M. Wimmer, "Rendering Point Clouds with Compute Shaders and Vertex Order
// Optimization", 2021). Each adds its light to integer sums of the pixels that it covers, so that
// the image does not depend on the order; then the sums are added to the radiance. What is between
// two integers is rounded to either, at random by its distance: a million faint ones count in full.
// A unit of the sums is so large that all points together fit, even at one pixel.

struct ParticleSplats {
    ProgramVariants splat;
    ProgramVariants add;
    gpu::Buffer sums = {};  ///< three words a pixel, 0 between the frames
    float unit = 1;         ///< of radiance, in the sums of this frame
    float max_amount = 0;   ///< that a point adds to a pixel, in units of the sums
};

[[nodiscard]] ParticleSplats create_particle_splats(gpu::Device& device);

/// Whether this pool may be drawn so, in views that nothing hides but what is opaque.
[[nodiscard]] bool can_be_splats(const GpuParticlePool& pool, const LookRecord& look);

/// The most light that a point of this look adds to a pixel.
[[nodiscard]] float brightest_of(const LookRecord& look);

/// Before those of a view are added: `count` in all, brightest_of() them. Null: does not compile.
[[nodiscard]] const gpu::Program* begin_particle_splats(
    ParticleSplats& splats, const ViewData& view, std::size_t count, float brightest);

/// With that program, and with the view, its depth (unit 4), particles and looks bound.
void draw_particle_splats(
    PassContext& context, const gpu::Program& program, const ParticleSplats& splats,
    const GpuParticlePool& pool);

/// Adds the pass that adds what was drawn to the view's radiance.
void add_particle_sums(FrameGraph& graph, ParticleSplats& splats, ViewData& view);

}  // namespace limn

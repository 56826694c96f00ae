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
// rasterizer, which takes several times as long for primitives of a few pixels (M. Schütz,
// B. Kerbl, M. Wimmer, "Rendering Point Clouds with Compute Shaders and Vertex Order Optimization",
// 2021). Each point adds its light to integer sums of the pixels that it covers by atomics, so that
// the image does not depend on the order; then the sums are added to the radiance. Amounts are
// rounded stochastically, so that a million faint points count in full. The unit of the sums is
// chosen so that all points together do not overflow, even at one pixel.

struct ParticleSplats {
    ProgramVariants splat;
    ProgramVariants add;
    gpu::Buffer sums = {};  ///< three words a pixel, 0 between the frames
    float unit = 1;         ///< of radiance, in the sums of this frame
    float max_amount = 0;   ///< that a point adds to a pixel, in units of the sums
};

[[nodiscard]] ParticleSplats create_particle_splats(gpu::Device& device);

/// Whether this pool may be drawn as splats, in views without blended surfaces.
[[nodiscard]] bool can_be_splats(const GpuParticlePool& pool, const LookRecord& look);

/// The maximum light that a point of this look adds to a pixel.
[[nodiscard]] float max_light(const LookRecord& look);

/// Whether all points of this look have the same color at any age and distance, and no size but by
/// their spread.
[[nodiscard]] bool is_steady(const LookRecord& look);

/// Null if a program does not compile.
struct SplatPrograms {
    const gpu::Program* any = nullptr;
    const gpu::Program* steady = nullptr;  ///< for looks that are
};

/// Before the splats of a view: `count` is their number, `brightest` the maximum of max_light().
[[nodiscard]] SplatPrograms begin_particle_splats(
    ParticleSplats& splats, const ViewData& view, std::size_t count, float brightest);

/// Draws a pool of this look with those programs. The view, its depth (kParticleDepthUnit),
/// particles and looks must be bound.
void draw_particle_splats(
    PassContext& context, const SplatPrograms& programs, const ParticleSplats& splats,
    const GpuParticlePool& pool, const LookRecord& look);

/// Adds the pass that adds the sums to the view's radiance.
void add_particle_sums(FrameGraph& graph, ParticleSplats& splats, ViewData& view);

}  // namespace limn

#pragma once

#include "ecs/base/math.h"
#include "render/particles/particle_list.h"
#include "render/shadow/light_bounds.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

class GpuParticlePools;
struct FrameData;
struct ParticleDraws;
struct ViewData;

/// What a view draws of the particles that the CPU moves: runs of instances, from back to front.
struct ParticlesInView {
    std::vector<ParticleInstance> instances{};
    std::vector<ParticleRun> runs{};
    std::size_t half_begin = 0;  ///< of the runs at half the resolution; those before are behind
    std::size_t half_end = 0;
    LightBounds half_window{};            ///< of the view's pixels, those where they may be seen
    std::size_t weighted_begin = 0;       ///< of the runs that are weighted
    Bounds weighted_bounds{};             ///< of those
    std::size_t under_begin = 0;          ///< of the runs under water, to the end
    bool above_water = false;             ///< the camera looks down into water that has ground
    std::vector<std::uint8_t> visible{};  ///< of ParticleDraws::sorted
};

/// Leaves out what the view does not see. The window and the bounds include those that the GPU
/// moves.
void select_particles(
    const ParticleDraws& draws, const GpuParticlePools& gpu, const FrameData& frame,
    const ViewData& view, ParticlesInView& seen);

}  // namespace limn

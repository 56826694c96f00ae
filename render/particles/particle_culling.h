#pragma once

#include "ecs/base/depth_sort.h"
#include "ecs/components/particles.h"
#include "render/geometry/culling.h"
#include "render/particles/particle_list.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn {

// Which particles a view may see, and their order from back to front.

/// Keeps its memory from frame to frame.
struct DistanceOrder {
    std::vector<std::uint32_t> indices{};  ///< of instances, from back to front
    std::vector<std::uint32_t> keys{};
    SortScratch scratch{};
};
/// As seen from `eye` along `forward`; equal distances keep their order, NaN comes first
/// (particle.distance-sort). `places`: of each look, where all of its particles count as being, if
/// they are one thing (ParticleSort::Births).
void order_by_distance(
    std::span<const ParticleInstance> instances, std::span<const std::optional<Vec3>> places,
    const Vec3& eye, const Vec3& forward, DistanceOrder& order);

/// What is known of the particles of a look before they are drawn (particle.visibility).
struct LookExtent {
    ParticleCulling culling = ParticleCulling::Particles;
    float radius = INFINITY;  ///< about a particle's middle, beside what its speed adds [m]
    float stretch = 0;        ///< half the time whose way a streak is as long as [s]
    float texels = INFINITY;  ///< of the longer side of a frame of its image, 0: it has none
    Bounds group{};           ///< of all of them, unless each counts by itself
    Bounds ways{};            ///< of weighted ones that the GPU moves: where they are, roughly
};

/// Without a group; pixels and ribbons have no extent in meters and are always drawn.
[[nodiscard]] LookExtent make_look_extent(const ParticleLook& look);

/// visible[i] = 1 if instance i may be seen within the frustum.
void cull_particles(
    const std::vector<ParticleInstance>& instances, const std::vector<LookExtent>& extents,
    const Frustum& frustum, std::vector<std::uint8_t>& visible);

/// Width of the largest particle of a look, without its spread [m or px].
[[nodiscard]] float max_width(const ParticleLook& look);

/// The box about an emitter's shape, outside of which nothing is born.
[[nodiscard]] Bounds shape_bounds(const ParticleEmitter& emitter, const Affine& world);

/// Where the particles of an emitter are, roughly: as far from its shape as they go in their life.
[[nodiscard]] Bounds bounds_of_ways(const ParticleEmitter& emitter, const Affine& world);

/// Of the middles of particles.
[[nodiscard]] Bounds bounds_of(std::span<const ParticleInstance> instances);

/// Where a particle may be seen; unbounded for looks whose extent is not known.
[[nodiscard]] Bounds bounds_of(const ParticleInstance& instance, const LookRecord& look);

/// False where the group as a whole, if there is one, is outside the frustum.
[[nodiscard]] bool is_group_in_view(const LookExtent& extent, const Frustum& frustum);

}  // namespace limn

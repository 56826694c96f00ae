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

// Which particles a view may show, and their order from back to front.

/// Keeps its memory from frame to frame.
struct DistanceOrder {
    std::vector<std::uint32_t> indices{};  ///< of instances, from back to front
    std::vector<std::uint32_t> keys{};
    SortScratch scratch{};
};
/// Sorts by depth from `eye` along `forward`; equal depths keep their order, NaN comes first
/// (particle.distance-sort). `positions`: for each look whose particles are sorted as one
/// (ParticleSort::Births), the position that counts.
void order_by_distance(
    std::span<const ParticleInstance> instances, std::span<const std::optional<Vec3>> positions,
    const Vec3& eye, const Vec3& forward, DistanceOrder& order);

/// Bounds of the particles of a look, for culling (particle.visibility).
struct LookExtent {
    ParticleCulling culling = ParticleCulling::Particles;
    float radius = INFINITY;  ///< about a particle's position, without what its speed adds [m]
    float stretch = 0;        ///< half the time that a streak spans [s]
    float texels = INFINITY;  ///< on the longer side of a frame of its image, 0: it has none
    Bounds group{};           ///< of all particles, unless each is culled by itself
    Bounds travel{};          ///< of weighted particles that the GPU moves: approximate
};

/// Without a group; looks whose size is not in meters are never culled.
[[nodiscard]] LookExtent make_look_extent(const ParticleLook& look);

/// visible[i] = 1 if instance i may be visible within the frustum.
void cull_particles(
    const std::vector<ParticleInstance>& instances, const std::vector<LookExtent>& extents,
    const Frustum& frustum, std::vector<std::uint8_t>& visible);

/// Width of the largest particle of a look, without its spread [m or px].
[[nodiscard]] float max_width(const ParticleLook& look);

/// The bounding box of an emitter's shape.
[[nodiscard]] Bounds shape_bounds(const ParticleEmitter& emitter, const Affine& world);

/// Approximate bounds of the particles of an emitter: its shape, grown by the path of a life.
[[nodiscard]] Bounds travel_bounds(const ParticleEmitter& emitter, const Affine& world);

/// Bounds of the positions.
[[nodiscard]] Bounds bounds_of(std::span<const ParticleInstance> instances);

/// Where a particle may be visible; unbounded for looks whose extent is not known.
[[nodiscard]] Bounds bounds_of(const ParticleInstance& instance, const LookRecord& look);

/// False if the look has a group and that is outside the frustum.
[[nodiscard]] bool is_group_in_view(const LookExtent& extent, const Frustum& frustum);

}  // namespace limn

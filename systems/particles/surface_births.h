#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "systems/animation/mesh_source.h"
#include "systems/particles/mesh_volume.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

// Positions of births on and in meshes, on paths and pieces of meshes (ParticleSurface). The
// deformation of a mesh is that at the end of the step; the motion of its entity is interpolated.
// Points of a triangle are uniform by area: (1 - sqrt(u)) a + sqrt(u) (1 - v) b + sqrt(u) v c
// (Turk 1990). A step with births takes about 60 us for a skinned mesh of 3000 triangles.

/// A ParticleSurface in a step. Points to components and assets.
struct SurfaceSource {
    const ParticleSurface* surface = nullptr;  ///< null: none
    MeshSource mesh{};
    const PathData* path = nullptr;
    EmitterPose pose{};  ///< of the mesh or path
};

/// The entities that have a mesh, as a parameter of systems.
using MeshQuery = Query<
    const MeshInstance, const WorldTransform, const PreviousWorldTransform,
    Optional<const Deformed>, Optional<const DeformerState>, Optional<const SurfaceBindingState>>;

/// `mesh` may be null; `emitter` is the entity with the ParticleSurface and `pose` its pose.
[[nodiscard]] SurfaceSource find_surface_source(
    const ParticleSurface& surface, const ParticleMesh* mesh, Entity emitter,
    const EmitterPose& pose, const MeshQuery& meshes, const Query<const Pose>& poses,
    const Query<const MorphWeights>& morphs, const Assets& assets);

/// What sampling a source needs; kept from step to step to reuse its memory.
struct SurfaceTable {
    std::vector<Vec3> positions{};  ///< of the vertices, in the mesh's space [m]
    std::vector<double> areas{};    ///< in world space, sum up to and with each triangle [m^2]
    MeshVolume volume{};            ///< in the mesh's space
};

/// False if nothing can be born there.
bool fill_surface_table(const SurfaceSource& source, SurfaceTable& table);

inline constexpr std::uint32_t kPieceBits = 12;  ///< of `look` of a particle that is a piece
inline constexpr std::uint32_t kPieceMask = (1u << kPieceBits) - 1;

struct SurfacePoint {
    Vec3 position = {0, 0, 0};  ///< in world space [m]
    Quat turn = {1, 0, 0, 0};   ///< +y along the normal
    Vec3 velocity = {0, 0, 0};  ///< of the surface there [m/s]
    std::uint32_t piece = 0;    ///< index of the piece
};

/// For birth `number` at the fraction `at` of a step of length `dt` [s]. The table must be filled.
/// None where no point of a volume was found (draw_in_volume).
[[nodiscard]] std::optional<SurfacePoint> surface_point(
    const SurfaceSource& source, const SurfaceTable& table, std::uint64_t number, float at,
    float dt, Random& random);

}  // namespace limn

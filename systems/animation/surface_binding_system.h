#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface_binding.h"
#include "ecs/query.h"
#include "ecs/system.h"

namespace limn {

// Meshes that follow surfaces (surface_binding.h). Bound meshes are copies in Assets: entities with
// the same mesh, surface mesh and settings share one, and changed settings replace it if nothing
// else uses it. A mesh that cannot be bound is logged once, and drawn without the binding.

/// The components that may deform the mesh of a surface.
using SurfaceQuery = Query<
    Optional<const ControlSurface>, Optional<const MeshInstance>, Optional<const Deformed>,
    Optional<const DeformerState>, AnyOf<ControlSurface, MeshInstance>>;

/// Adds a SurfaceBindingState to every SurfaceBinding that lacks one, and a Deformed by itself
/// where nothing deforms the mesh.
void add_surface_binding_states(
    Query<const SurfaceBinding, With<MeshInstance>, Without<SurfaceBindingState>> bare,
    Query<const Deformed> deformed, Commands commands);

/// Restores the mesh of entities that lost their SurfaceBinding, and removes what was added for it.
void release_surface_bindings(
    Query<const SurfaceBindingState, Without<SurfaceBinding>> released,
    Query<const SurfaceBindingState, With<SurfaceBinding>> bound, Query<const Deformers> deformers,
    Query<MeshInstance> instances, Res<Assets> assets, Commands commands);

/// Binds meshes that are unbound, or whose settings, mesh or surface changed. Where the surface is
/// gone, the mesh is unbound.
void bind_surfaces(
    Query<const SurfaceBinding, SurfaceBindingState, const MeshInstance> bindings,
    Query<MeshInstance> instances, SurfaceQuery surfaces, Res<Assets> assets);

/// Updates the shape of each surface; that of the previous step is kept for velocities.
void update_surface_bindings(
    Query<SurfaceBindingState> bindings, SurfaceQuery surfaces, Query<const Pose> poses,
    Query<const MorphWeights> morphs, Res<const Assets> assets);

}  // namespace limn

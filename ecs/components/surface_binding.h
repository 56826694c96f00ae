#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_anchors.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace limn {

// Meshes that follow a control surface: its few vertices, posed by joints, clips, morph targets or
// deformers, move the thousands of vertices of a mesh that is bound to them.

/// A mesh that is not drawn but moves those that are bound to it. It is deformed like a drawn mesh,
/// by Deformed, Deformers or a Skeleton.
struct ControlSurface {
    MeshId mesh;
};

LIMN_FIELDS(ControlSurface) {
    LIMN_FIELD(mesh, "a mesh of the level, by name; it is not drawn");
}

enum class SurfaceMethod : std::uint8_t {
    Faces,    ///< surface-oriented free-form deformation (face.soffd), instead of joints
    Patches,  ///< smooth patches through the vertices (face.bids-surface); joints act afterwards
};

/// With a MeshInstance: its rest shape is bound to the rest shape of a surface, and follows it.
/// Both shapes must coincide, each in the space of its own mesh, regardless of the entities'
/// transforms. Morph targets and deformers of the mesh add to it. A binding of the surface itself
/// is ignored. Without its SurfaceBinding, or without the surface, the mesh is unbound again.
struct SurfaceBinding {
    Entity surface;
    SurfaceMethod method = SurfaceMethod::Faces;
    float locality = 4.0f;
    int faces = 8;
    float reach = 0.05f;
    bool by_uvs = false;

    bool operator==(const SurfaceBinding&) const = default;
};

LIMN_FIELDS(SurfaceBinding) {
    LIMN_FIELD(
        surface, "entity with a control_surface or mesh_instance, or a character with such a mesh");
    LIMN_FIELD(method, .doc = "how it follows", .values = "faces patches");
    LIMN_FIELD(
        locality,
        "of faces: exponent by which the influence of a face falls with distance, in mean edges of "
        "the "
        "surface: 0 all alike, 8 the nearest almost alone",
        "", 0, 16);
    LIMN_FIELD(faces, "of faces: maximum number that influence a vertex", "", 1, 32);
    LIMN_FIELD(
        reach,
        "of patches: distance from the surface at which vertices do not move; from half of it, and "
        "beside the surface from its border on, they follow less and less",
        "m", 0, 1e4);
    LIMN_FIELD(
        by_uvs,
        "of patches: a vertex is bound where the surface has its texture coordinates, so that each "
        "of two touching lips follows its own; both meshes need the same UV layout");
}

/// State of a SurfaceBinding; written by bind_surfaces and update_surface_bindings.
struct SurfaceBindingState {
    SurfaceBinding settings;             ///< with which it was bound
    MeshId rest;                         ///< the mesh to bind
    MeshId surface_mesh;                 ///< to which it is bound
    MeshId bound;                        ///< a copy of `rest` with its influences; none: not bound
    Entity surface;                      ///< the entity of the surface's mesh
    std::vector<std::uint32_t> corners;  ///< three vertices of the surface per face

    SkinId skin;  ///< of `bound`, if by faces: one joint each
    Pose pose;    ///< of the faces

    /// Of the vertices of `bound`, if by patches. Immutable, shared by all equal bindings, and
    /// recreated where it is missing.
    std::shared_ptr<const std::vector<SurfaceAnchor>> anchors;
    std::shared_ptr<const std::vector<std::uint32_t>> order;  ///< bound vertices, patch by patch
    float largest_offset = 0.0f;                              ///< of the vertices [m]
    std::vector<Vec4> rest_patches;
    std::vector<Vec4> patches;                                 ///< of the last step
    std::vector<Vec4> previous_patches;                        ///< of the previous step
    ValueJump<std::vector<Vec4>> patches_jump{.at = kNoJump};  ///< of the last step; never saved

    bool has_added_deformed = false;  ///< the entity had no Deformed
};

LIMN_FIELDS(SurfaceBindingState) {
    LIMN_FIELD(settings, "settings with which it was bound");
    LIMN_FIELD(rest, "the mesh to bind");
    LIMN_FIELD(surface_mesh, "mesh to which it is bound");
    LIMN_FIELD(bound, "copy of the mesh with its influences");
    LIMN_FIELD(skin, "one joint per face of the surface");
    LIMN_FIELD(surface, "entity of the surface's mesh");
    LIMN_FIELD(corners, "three vertices of the surface per face");
    LIMN_FIELD(pose, "pose of the faces");
    LIMN_FIELD(largest_offset, "largest offset of vertices from the patches", "m");
    LIMN_FIELD(rest_patches, "packed patches at rest");
    LIMN_FIELD(patches, "packed patches after the last step");
    LIMN_FIELD(previous_patches, "packed patches of the previous step");
    LIMN_FIELD(has_added_deformed, "a deformed was added for this binding");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<SurfaceBindingState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// The shape that moves the vertices of an instance; `patches` are its own, or interpolated.
[[nodiscard]] inline SurfaceShape
surface_shape(const SurfaceBindingState* state, const std::vector<Vec4>& patches) {
    if (state == nullptr || state->anchors == nullptr || patches.empty()) {
        return {};
    }
    return {*state->anchors, patches, *state->order};
}

}  // namespace limn

#include "systems/animation/surface_binding_system.h"

#include "ecs/base/hash.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "systems/animation/clip_jumps.h"
#include "systems/animation/mesh_source.h"
#include "systems/animation/patch_binding.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/surface_faces.h"
#include "systems/animation/surface_patches.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// Techniques: face.bids-project, face.mocap-drive, face.soffd, face.soffd-skin

namespace limn {
namespace {

constexpr std::size_t kMaxFaces = 65536;  ///< joints that SkinWeights can name

using MeshBindings = Query<const SurfaceBinding, SurfaceBindingState, const MeshInstance>;

MeshId mesh_of(const SurfaceQuery& surfaces, Entity entity) {
    if (const auto* control = surfaces.find<const ControlSurface>(entity)) {
        return control->mesh;
    }
    const auto* instance = surfaces.find<const MeshInstance>(entity);
    return instance != nullptr ? instance->mesh : MeshId{};
}

/// The entity itself, or the first whose mesh it deforms.
Entity find_surface(const SurfaceQuery& surfaces, Entity named) {
    if (named.is_null() || mesh_of(surfaces, named) != MeshId{}) {
        return named;
    }
    Entity found{};
    surfaces.each([&](Entity entity, const ControlSurface*, const MeshInstance*,
                      const Deformed* deformed, const DeformerState*) {
        if (found.is_null() && deformed != nullptr && deformed->character == named) {
            found = entity;
        }
    });
    return found;
}

/// Hash of how each vertex is moved by joints and morph targets: equal on both sides of a seam.
std::vector<std::uint64_t> motion_kinds(const MeshData& mesh) {
    std::vector<std::uint64_t> kinds(mesh.positions.size(), 0);
    const auto add = [&](std::size_t v, std::uint64_t which, const auto& how) {
        kinds[v] = hash_combine(kinds[v], which);
        kinds[v] = hash_combine(kinds[v], hash_bytes(&how, sizeof(how)));
    };
    for (std::size_t v = 0; v + 1 < mesh.skin.first.size() && v < kinds.size(); ++v) {
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            add(v, mesh.skin.joints[i], mesh.skin.weights[i]);
        }
    }
    for (std::size_t m = 0; m < mesh.morphs.size(); ++m) {
        for (std::size_t i = 0; i < mesh.morphs[m].vertices.size(); ++i) {
            add(mesh.morphs[m].vertices[i], m, mesh.morphs[m].positions[i]);
        }
    }
    return kinds;
}

/// Says how many vertices the surface moves less than fully, and where they are.
void note_beyond(
    const MeshData& surface, const MeshData& bound, const std::vector<SurfaceAnchor>& anchors) {
    Bounds beyond;
    std::size_t less = 0;
    std::size_t still = 0;
    for (std::size_t v = 0; v < bound.positions.size(); ++v) {
        float follows = 0.0f;
        for (std::size_t a = v; anchors[v].patch != kNoPatch; a = anchors[a].next) {
            follows += anchors[a].share;
            if (anchors[a].next == 0) {
                break;
            }
        }
        if (follows < 0.999f) {
            grow(beyond, bound.positions[v]);
            ++(anchors[v].patch == kNoPatch ? still : less);
        }
    }
    if (less + still > 0) {
        const auto rounded = [](const Vec3& p) {  // to millimeters
            const Vec3 q = glm::round(1000.0f * p) / 1000.0f;
            return format_text("({} {} {})", q.x, q.y, q.z);
        };
        log_debug(
            "surface_binding of mesh {}: of {} vertices, {} beside the surface {} or far from it "
            "follow less, {} do not move; these are between {} and {}",
            bound.name, bound.positions.size(), less, surface.name, still, rounded(beyond.min),
            rounded(beyond.max));
    }
}

/// Binds one entity, for bind_surfaces.
class Binder {
  public:
    Binder(const MeshBindings& bindings, const SurfaceQuery& surfaces, Assets& assets)
        : bindings_(bindings), surfaces_(surfaces), assets_(assets) {}

    Status bind(Entity entity, SurfaceBindingState& state) {
        state.surface = find_surface(surfaces_, state.settings.surface);
        state.surface_mesh = mesh_of(surfaces_, state.surface);
        if (state.rest.index >= assets_.meshes.size()) {
            return fail("it has no mesh");
        }
        if (state.surface_mesh.index >= assets_.meshes.size() || state.surface == entity) {
            return fail("its surface has no mesh, expected a control_surface or mesh_instance");
        }
        const MeshData& named = assets_.meshes[state.surface_mesh.index];
        const bool by_patches = state.settings.method == SurfaceMethod::Patches;
        PatchFaces faces_of_patches;
        if (by_patches) {
            Result<PatchFaces> made =
                make_patch_faces(named.positions, named.indices, motion_kinds(named));
            if (!made) {
                return fail("surface {}: {}", named.name, made.error().message);
            }
            faces_of_patches = *std::move(made);
            state.corners = faces_of_patches.corners;
            make_patches(named.positions, state.corners, state.rest_patches);
        } else {
            state.corners = faces_with_area(named.positions, named.indices);
        }
        const std::size_t faces = state.corners.size() / 3;
        if (faces == 0 || faces > kMaxFaces) {
            return fail(
                "mesh {} has {} faces with area, expected 1 to {}", named.name, faces, kMaxFaces);
        }
        if (const SurfaceBindingState* equal = find_equal(entity, state)) {
            if (is_sole_user(entity, state) && state.bound != equal->bound) {
                free_mesh(assets_, state.bound);
            }
            state.bound = equal->bound;
            state.skin = equal->skin;
            state.anchors = equal->anchors;
            state.order = equal->order;
            state.largest_offset = equal->largest_offset;
            return Done{};
        }
        reserve(entity, state);  // may move the meshes
        const MeshData& surface = assets_.meshes[state.surface_mesh.index];
        MeshData bound = assets_.meshes[state.rest.index];
        bound.name += " on " + surface.name;
        bound.version = assets_.meshes[state.bound.index].version + 1;
        if (by_patches) {
            bind_to_patches_of(surface, faces_of_patches, bound, state);
        } else {
            bind_to_faces_of(surface, bound, state);
        }
        assets_.meshes[state.bound.index] = std::move(bound);
        return Done{};
    }

    /// Frees its bound mesh if nothing else uses it.
    void release(Entity entity, SurfaceBindingState& state) {
        if (is_sole_user(entity, state)) {
            free_mesh(assets_, state.bound);
        }
        state.bound = {};
    }

  private:
    static void bind_to_patches_of(
        const MeshData& surface, const PatchFaces& faces, const MeshData& bound,
        SurfaceBindingState& state) {
        const float max_distance = state.settings.reach;
        std::vector<Vec2> corner_uvs;
        PatchChart chart;
        if (state.settings.by_uvs) {
            for (const std::uint32_t v : faces.named) {
                corner_uvs.push_back(surface.uvs[v]);
            }
            chart = {bound.uvs, corner_uvs};
        }
        std::vector<SurfaceAnchor> anchors = bind_to_patches(
            {bound.positions, bound.normals, bound.tangents, bound.indices}, surface.positions,
            faces.corners, std::isfinite(max_distance) ? max_distance : 0.0f, chart);
        state.largest_offset = 0.0f;
        for (const SurfaceAnchor& anchor : anchors) {
            state.largest_offset = std::max(state.largest_offset, glm::length(anchor.offset));
        }
        note_beyond(surface, bound, anchors);
        state.order = std::make_shared<const std::vector<std::uint32_t>>(order_by_patch(anchors));
        state.anchors = std::make_shared<const std::vector<SurfaceAnchor>>(std::move(anchors));
    }

    void bind_to_faces_of(const MeshData& surface, MeshData& bound, SurfaceBindingState& state) {
        const SurfaceBinding& settings = state.settings;
        bound.skin = bind_to_faces(
            bound.positions, bound.normals, surface.positions, state.corners,
            std::isfinite(settings.locality) ? settings.locality : 0.0f,
            static_cast<std::size_t>(std::max(settings.faces, 1)));
        assets_.skins[state.skin.index] = make_face_skin(surface.positions, state.corners);
        state.anchors = nullptr;
        state.order = nullptr;
    }

    /// Another entity with an equal binding.
    const SurfaceBindingState* find_equal(Entity entity, const SurfaceBindingState& state) {
        const SurfaceBindingState* found = nullptr;
        bindings_.each([&](Entity other, const SurfaceBinding&, const SurfaceBindingState& theirs,
                           const MeshInstance&) {
            SurfaceBinding settings = theirs.settings;
            settings.surface = state.settings.surface;
            if (other != entity && theirs.bound != MeshId{} && theirs.rest == state.rest
                && theirs.surface_mesh == state.surface_mesh && settings == state.settings) {
                found = &theirs;
            }
        });
        return found;
    }

    /// Whether it has a bound mesh that no other entity uses.
    bool is_sole_user(Entity entity, const SurfaceBindingState& state) {
        bool sole = state.bound != MeshId{};
        bindings_.each([&](Entity other, const SurfaceBinding&, const SurfaceBindingState& theirs,
                           const MeshInstance&) {
            sole = sole && (other == entity || theirs.bound != state.bound);
        });
        return sole;
    }

    /// Keeps its bound mesh if nothing else uses it, or appends one.
    void reserve(Entity entity, SurfaceBindingState& state) {
        if (!is_sole_user(entity, state)) {
            state.bound = {static_cast<std::uint32_t>(assets_.meshes.size())};
            state.skin = {static_cast<std::uint32_t>(assets_.skins.size())};
            assets_.meshes.emplace_back();
            assets_.skins.emplace_back();
        }
    }

    const MeshBindings& bindings_;
    const SurfaceQuery& surfaces_;
    Assets& assets_;
};

/// `jump`: fraction of the step at which the surface jumps.
void step_patches(const std::vector<Vec3>& positions, float jump, SurfaceBindingState& state) {
    std::swap(state.patches, state.previous_patches);
    make_patches(positions, state.corners, state.patches);
    if (state.previous_patches.size() != state.patches.size()) {
        state.previous_patches = state.patches;
    } else if (jump != kNoJump) {
        state.patches_jump = {0, jump, std::exchange(state.previous_patches, state.patches)};
    }
}

void step_pose(
    const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& corners, float jump,
    Pose& pose) {
    const std::size_t faces = corners.size() / 3;
    const bool is_new = pose.joints.size() != faces;
    std::swap(pose.joints, pose.previous);
    pose.joints.resize(faces);
    compute_face_frames(positions, corners, pose.joints);
    if (is_new) {
        pose.previous = pose.joints;
    } else if (jump != kNoJump) {
        for (std::size_t i = 0; i < faces; ++i) {
            pose.jumps.push_back({static_cast<std::uint16_t>(i), jump, pose.previous[i]});
        }
        pose.previous = pose.joints;
    }
}

}  // namespace

void add_surface_binding_states(
    Query<const SurfaceBinding, With<MeshInstance>, Without<SurfaceBindingState>> bare,
    Query<const Deformed> deformed, Commands commands) {
    bare.each([&](Entity entity, const SurfaceBinding&) {
        SurfaceBindingState state;
        if (deformed.find<const Deformed>(entity) == nullptr) {
            Deformed by_itself;
            by_itself.character = entity;
            commands.add(entity, by_itself);
            state.has_added_deformed = true;
        }
        commands.add(entity, std::move(state));
    });
}

void release_surface_bindings(
    Query<const SurfaceBindingState, Without<SurfaceBinding>> released,
    Query<const SurfaceBindingState, With<SurfaceBinding>> bound, Query<const Deformers> deformers,
    Query<MeshInstance> instances, Res<Assets> assets, Commands commands) {
    released.each([&](Entity entity, const SurfaceBindingState& state) {
        auto* const instance = instances.find<MeshInstance>(entity);
        if (state.bound != MeshId{}) {
            if (instance != nullptr && instance->mesh == state.bound) {
                instance->mesh = state.rest;
            }
            bool is_used = false;
            bound.each([&](Entity, const SurfaceBindingState& other) {
                is_used = is_used || other.bound == state.bound;
            });
            if (!is_used) {
                free_mesh(*assets, state.bound);
            }
        }
        if (state.has_added_deformed && deformers.find<const Deformers>(entity) == nullptr) {
            commands.remove<Deformed>(entity);
        }
        commands.remove<SurfaceBindingState>(entity);
    });
}

void bind_surfaces(
    MeshBindings bindings, Query<MeshInstance> instances, SurfaceQuery surfaces,
    Res<Assets> assets) {
    bindings.each([&](Entity entity, const SurfaceBinding& binding, SurfaceBindingState& state,
                      const MeshInstance& instance) {
        const bool is_bound = state.bound != MeshId{} && instance.mesh == state.bound;
        const bool has_surface = is_bound && mesh_of(surfaces, state.surface) == state.surface_mesh;
        const bool has_anchors =
            state.anchors != nullptr || state.settings.method != SurfaceMethod::Patches;
        const bool failed =
            state.bound == MeshId{} && state.rest == instance.mesh && state.rest != MeshId{};
        if (((has_surface && has_anchors) || failed) && binding == state.settings) {
            return;
        }
        state.rest = is_bound ? state.rest : instance.mesh;
        state.settings = binding;
        Binder binder(bindings, surfaces, *assets);
        Status bound = binder.bind(entity, state);
        if (!bound) {
            binder.release(entity, state);
            state.corners.clear();
            state.anchors = nullptr;
            state.order = nullptr;
            const bool named = state.rest.index < assets->meshes.size();
            log_warn(
                "surface_binding of mesh {}: {}; it is not bound",
                named ? assets->meshes[state.rest.index].name : "none", bound.error().message);
        }
        state.pose = {};
        state.patches.clear();
        state.previous_patches.clear();
        instances.find<MeshInstance>(entity)->mesh = bound ? state.bound : state.rest;
    });
}

void update_surface_bindings(
    Query<SurfaceBindingState> bindings, SurfaceQuery surfaces, Query<const Pose> poses,
    Query<const MorphWeights> morphs, Res<const Assets> assets) {
    std::vector<Vec3> positions;
    bindings.each([&](SurfaceBindingState& state) {
        const MeshId mesh = mesh_of(surfaces, state.surface);
        state.pose.jumps.clear();
        state.patches_jump.at = kNoJump;
        if (state.corners.empty() || mesh != state.surface_mesh) {
            state.pose.previous = state.pose.joints;  // the surface is gone: keep the pose
            state.previous_patches = state.patches;
            return;
        }
        const MeshSource source = find_mesh_source(
            mesh, surfaces.find<const Deformed>(state.surface),
            surfaces.find<const DeformerState>(state.surface), poses, morphs, *assets);
        transform_vertices(source, Affine{}, positions);
        const float jump = first_jump(source.pose, source.morphs);
        if (state.settings.method == SurfaceMethod::Patches) {
            step_patches(positions, jump, state);
        } else {
            step_pose(positions, state.corners, jump, state.pose);
        }
    });
}

}  // namespace limn

#pragma once

#include "ecs/commands.h"
#include "ecs/components/input.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/animation/mesh_source.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace limn {

// Skin follows the pointer and springs back (face.pull). The pointer grabs the nearest front face
// under it, as posed in the previous step; that point follows the ray of the pointer at the
// distance at which it was grabbed. Offsets apply before joints, whose mean at the point is
// treated as linear, even with dual quaternions.

inline constexpr std::size_t kMaxSkinPulls = 8;  ///< per mesh; one more ends the oldest at once

/// Adds SkinPulls and Deformers to each PullableSkin that lacks them.
void add_skin_pulls(
    Query<const PullableSkin, Without<SkinPulls>> bare, Query<const Deformers> deformers,
    Commands commands);

/// Grabs skin where the action pull_skin begins, moves what is held, and lets the rest spring back.
/// Before update_deformers, which packs the pulls.
void update_skin_pulls(
    Query<const PullableSkin, SkinPulls, const MeshInstance, const Deformed, const WorldTransform>
        skins,
    Query<const DeformerState> deformers, Query<const Pose> poses, Query<const MorphWeights> morphs,
    Query<const SurfaceBindingState> bindings, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time);

// ---- parts of the above ----

/// State of a critically damped spring.
struct SpringState {
    Vec3 offset{0, 0, 0};    ///< [m]
    Vec3 velocity{0, 0, 0};  ///< [m/s]
};

/// The state `dt` [s] later, at rest at `goal`; exact, so that steps of any length agree.
[[nodiscard]] SpringState
spring_after(const SpringState& spring, const Vec3& goal, float rate, float dt);

/// `offset`, smoothly limited to a length below `limit` [m]; short offsets hardly change.
[[nodiscard]] Vec3 limited_pull(const Vec3& offset, float limit);

struct SkinHit {
    std::uint32_t triangle = 0;
    Vec3 barycentric{1, 0, 0};
    float distance = 0;  ///< along the ray, in units of its direction
};

/// The nearest triangle that the ray hits on its front, counterclockwise side.
[[nodiscard]] std::optional<SkinHit> hit_skin(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, const Vec3& origin,
    const Vec3& direction);

}  // namespace limn

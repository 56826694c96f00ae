#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_response.h"
#include "ecs/query.h"
#include "ecs/schedule.h"

#include <span>

namespace limn {

// From the deformed skin to the weights of wrinkle maps, per region (skin.pipeline, stages 2 to 5).
// With the strengths s of compression across the wrinkles (2) and along them (1) at vertices of
// area A and mask M,
//
//     S = sum M A max(s, 0) / sum M A,    w = clamp(animated + gain2 S2 - gain1 S1 + bias, -1, 1)
//
// and weights approach w by the fraction 1 - exp(-dt / smoothing). Regions are the channels of the
// masks. On the CPU: about a millisecond for 10,000 vertices.

/// Adds and updates the ResponseRest and MeasuredWrinkles of each WrinkleResponse on a deformed
/// mesh with uvs and regions that have directions, and removes them from others.
void prepare_wrinkle_responses(
    Query<const WrinkleResponse, const WrinkleMaps, const MeshInstance, const Deformed> faces,
    Query<const ResponseRest> rests, Query<const MeasuredWrinkles> measured,
    Res<const Assets> assets, Commands commands);

/// Steps MeasuredWrinkles, except of faces whose WrinkleRungs show none. After poses and deformers.
void update_wrinkle_responses(
    Query<
        const WrinkleResponse, const ResponseRest, const MeshInstance, const Deformed,
        MeasuredWrinkles>
        faces,
    Query<const WrinkleWeights> animated, Query<const DeformerState> deformers,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Query<const WrinkleRungs> ladders,
    Res<const Assets> assets, Res<const FrameTime> time);

// ---- parts of the above ----

/// `source` 0: there is nothing to measure. A region of less than 1e-4 of the mesh's area is
/// ignored.
[[nodiscard]] ResponseRest
make_response_rest(const WrinkleMaps& maps, const MeshInstance& instance, const Assets& assets);

/// The weights for skin with these positions, without smoothing; `animated` may be null.
[[nodiscard]] WrinkleWeights response_weights(
    const WrinkleResponse& response, const ResponseRest& rest, std::span<const Vec3> deformed,
    const WrinkleWeights* animated);

}  // namespace limn

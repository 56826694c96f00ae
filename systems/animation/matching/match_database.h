#pragma once

#include "ecs/components/motion_match.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"
#include "ecs/components/walk.h"
#include "systems/animation/graph/root_motion.h"
#include "systems/animation/matching/match_rows.h"
#include "systems/animation/matching/match_takes.h"
#include "systems/animation/walk/walk_body.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// What motion matching searches: for each frame of the clips, where the character will be and face
// in a third, two thirds and a whole second, where its feet are, and how feet and hips move. All in
// the space of the root at that frame, in units of the standard deviation of each feature, times
// its weight. Techniques: char.motion-select

inline constexpr float kMatchStep = 1.0f / 30.0f;  ///< between rows [s]
/// Rows after which the wanted path is compared: 1/3, 2/3 and 1 s.
inline constexpr std::array<std::size_t, 3> kMatchAhead = {10, 20, 30};

/// Numbers of a feature in a row.
struct MatchFeature {
    std::size_t first = 0;
    std::size_t count = 0;
};
/// Path and direction (sine and cosine) after each time, alternating: x z s c; feet, left and
/// right; velocities of feet and hips.
inline constexpr std::array<MatchFeature, 11> kMatchFeatureParts = {
    {{0, 2}, {2, 2}, {4, 2}, {6, 2}, {8, 2}, {10, 2}, {12, 3}, {15, 3}, {18, 3}, {21, 3}, {24, 3}}};
inline constexpr std::size_t kMatchPath = 0;   ///< number of the first trajectory feature
inline constexpr std::size_t kMatchFeet = 12;  ///< of the first one of the pose

/// A clip of a database.
struct MatchClip {
    ClipId clip{};  ///< of the level; for a take its index
    bool is_take = false;
    float duration = 0.0f;           ///< [s]
    std::vector<GroundMove> root{};  ///< where the character is at each kMatchStep, from the origin
    std::size_t first_row = 0;
    std::size_t rows = 0;  ///< frames that a second of the clip follows; they are searched
    std::vector<MatchRow> frames{};  ///< normalized; of all frames, as if the last move went on
    std::array<std::vector<ClipContact>, 2> contacts{};  ///< of the left and the right foot
};

/// A place in a clip.
struct MatchPlace {
    std::uint32_t clip = 0;
    float time = 0.0f;  ///< [s]
};

struct MatchDatabase {
    WalkBody body{};
    std::vector<MatchTake> takes{};
    std::vector<MatchClip> clips{};
    std::vector<std::uint16_t> turning{};  ///< joints that clips rotate, ascending
    std::vector<std::uint16_t> moving{};   ///< joints that clips move, ascending
    MatchRows rows{};
    MatchRow mean{};
    MatchRow scale{};  ///< of a row: (feature - mean) scale

    [[nodiscard]] const ClipData& clip(const Assets& assets, std::uint32_t index) const;
    [[nodiscard]] MatchPlace place_of(std::uint32_t row) const;
    /// The frame next to a place, normalized.
    [[nodiscard]] const MatchRow& frame_at(const MatchPlace& place) const;
};

/// Weights of features.
struct MatchWeights {
    float trajectory = 1.0f;
    float feet = 1.0f;
    float hips = 1.0f;
    bool operator==(const MatchWeights&) const = default;
};

/// A database of these clips, then of the takes. Warns of clips that are missing, that have joints
/// which the skeleton lacks, or that are not longer than a second; they are left out.
[[nodiscard]] MatchDatabase make_match_database(
    const SkeletonData& skeleton, const Assets& assets, std::span<const ClipId> clips,
    std::vector<MatchTake> takes, const MatchWeights& weights);

/// Where the root of a clip is at a time, between its rows.
[[nodiscard]] GroundMove root_of(const MatchClip& clip, float time);

/// A clip's pose in the space of its root: joints without keys as in `pose`.
void sample_match_pose(
    const MatchDatabase& database, const Assets& assets, const MatchPlace& place, LocalPose& pose);

/// Root of a clip that has none: under the hips, without their sway, as those of the last half
/// second face. At each `step` [s].
[[nodiscard]] std::vector<GroundMove> find_clip_root(
    const SkeletonData& skeleton, const WalkBody& body, const ClipData& clip, float step);

/// Features of each frame of a clip, not normalized. Those of the last second are as if the last
/// move of the root went on.
[[nodiscard]] std::vector<MatchRow> find_match_features(
    const SkeletonData& skeleton, const WalkBody& body, const ClipData& clip,
    std::span<const GroundMove> root);

/// Resource: databases, by what they are made of. Derived anew after a snapshot was restored.
struct MatchDatabases {
    struct Entry {
        SkeletonId skeleton{};
        Entity walk{};
        std::vector<ClipId> clips{};
        MatchWeights weights{};
        std::shared_ptr<const MatchDatabase> database{};
    };
    std::vector<Entry> entries{};

    [[nodiscard]] const MatchDatabase* find(SkeletonId skeleton, const MotionMatch& match) const;
};

[[nodiscard]] inline MatchWeights weights_of(const MotionMatch& match) {
    return {
        finite_or(match.trajectory, 1.0f), finite_or(match.feet, 1.0f),
        finite_or(match.hips, 1.0f)};
}

}  // namespace limn

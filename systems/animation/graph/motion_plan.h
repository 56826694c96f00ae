#pragma once

#include "ecs/components/motion_graph.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"
#include "systems/animation/graph/blend_space.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

/// How a clip's time follows from the phase of its state. Its footfalls divide the cycle into
/// segments; each is a part of the clip as long as the foot's turn takes.
struct ClipCycle {
    float duration = 0.0f;     ///< [s]; 0: no clip
    float offset = 0.0f;       ///< fraction of the clip at which the first foot touches down
    std::vector<float> marks;  ///< 0, each further foot's touchdown since the first, 1
};

/// What is derived once from a graph and a skeleton.
struct MotionPlan {
    struct State {
        std::vector<ClipCycle> cycles;         ///< of each clip
        std::vector<std::vector<Quat>> means;  ///< mean rotation of each joint in each clip
        std::vector<std::uint8_t> fits;        ///< whether the clip has no joints beyond
    };
    struct Layer {
        std::vector<std::uint16_t> joints;  ///< that it moves
        LocalPose reference;                ///< additive: what the clip is compared with
        std::vector<float> weights;         ///< likewise
        bool fits = false;
        bool is_whole = false;  ///< moves all joints, and morph weights
    };
    std::vector<State> states;
    std::vector<Layer> layers;
    std::size_t feet = 1;                 ///< segments of a cycle
    std::vector<std::uint16_t> animated;  ///< morph weights that the clips animate, ascending
    std::size_t morphs = 0;               ///< one past the largest of them
};

/// Resource: plans, by graph and skeleton. Derived anew after a snapshot was restored.
struct MotionPlans {
    struct Entry {
        MotionGraphId graph;
        SkeletonId skeleton;
        std::shared_ptr<const MotionPlan> plan;
    };
    std::vector<Entry> entries;

    [[nodiscard]] const MotionPlan* find(MotionGraphId graph, SkeletonId skeleton) const;
};

/// Warns of clips that are missing or have joints that the skeleton lacks, and of unknown names of
/// joints; these are ignored.
[[nodiscard]] MotionPlan
make_motion_plan(const MotionGraphData& graph, const SkeletonData& skeleton, const Assets& assets);

/// Cycle of a clip with these feet: their touchdowns are where their contacts begin. Evenly divided
/// if they do not touch down in this order.
[[nodiscard]] ClipCycle
make_clip_cycle(const ClipData& clip, std::span<const std::uint16_t> feet, std::size_t segments);

/// Position in a clip of a state at `phase`, unwrapped: `offset` .. `offset` + 1 at phases 0 .. 1,
/// increasing [cycles]. A clip that does not loop begins at 0 instead.
[[nodiscard]] float cycle_position(const ClipCycle& cycle, float phase, bool loop);

/// The inverse for one cycle: the phase, 0 .. 1, at which the clip is at `position` [cycles].
[[nodiscard]] float phase_at(const ClipCycle& cycle, float position, bool loop);

/// Time in the clip of an unwrapped position [s].
[[nodiscard]] float time_at(const ClipCycle& cycle, float position, bool loop);

}  // namespace limn

#pragma once

#include "ecs/components/motion_graph.h"
#include "systems/animation/graph/motion_plan.h"

#include <span>
#include <vector>

namespace limn {

// Poses of a motion graph: the clips of the current state, blended by its parameters; the
// transition that is not over; the layers.

/// A character whose graph is evaluated. All but `style` exist and belong together.
struct MotionContext {
    const Assets& assets;
    const SkeletonData& skeleton;
    const MotionGraphData& graph;
    const MotionPlan& plan;
    const MotionGraph& parameters;
    const MotionStyle* style = nullptr;
    float scale = 1.0f;  ///< of the character: of the way that clips cover
};

/// A pose with morph weights, as many as the plan has.
struct MotionPose {
    LocalPose joints;
    std::vector<float> weights;
};

/// Phases that a step plays.
struct PhaseStep {
    float from = 0.0f;
    float to = 0.0f;
    float cycles = 0.0f;    ///< whole cycles between them; `to` + `cycles` >= `from` if forward
    float leftover = 0.0f;  ///< a clip that has ended: the rest of the step [s]
    bool ended = false;     ///< reached the end of a clip that does not loop in this step
};

/// Weights of the clips of a state; those that do not fit the skeleton count as the rest pose.
[[nodiscard]] ClipWeights state_weights(const MotionContext& context, std::uint32_t state);

/// Advances a playback by `seconds`, which may be negative. The cycle of a blend space takes as
/// long as the mean of the frequencies of its clips or, with x = speed and clips that travel, as
/// its mean stride takes at that speed. The position of each clip is continuous in time even while
/// the weights change.
PhaseStep advance_playback(const MotionContext& context, GraphPlayback& playback, float seconds);

/// Advances both states of a crossfade with common phases, so that their feet touch down together:
/// `share`, 0 .. 1, of the second one.
PhaseStep advance_together(
    const MotionContext& context, GraphPlayback& from, GraphPlayback& to, float share,
    float seconds);

/// Pose of a state. A state without clips, or that does not exist: the rest pose.
void evaluate_state(const MotionContext& context, const GraphPlayback& playback, MotionPose& pose);

/// The same `seconds` earlier; for a clip that does not loop, extrapolated beyond its beginning.
void evaluate_state_earlier(
    const MotionContext& context, const GraphPlayback& playback, float seconds, MotionPose& pose);

/// Displayed pose without layers, or what it was `earlier` [s] ago (char.blend).
void evaluate_states(
    const MotionContext& context, const MotionGraphState& state, float earlier, MotionPose& pose);

/// Displayed pose.
void evaluate_motion(const MotionContext& context, const MotionGraphState& state, MotionPose& pose);

/// pose = interpolation from `pose` to `other`, rotations along the shorter arc.
void blend_pose(const MotionPose& other, float share, MotionPose& pose);

/// Share of the next state in a crossfade.
[[nodiscard]] float crossfade_share(const GraphTransition& transition, float clock);

}  // namespace limn

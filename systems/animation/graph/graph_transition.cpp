#include "systems/animation/graph/graph_transition.h"

#include "systems/animation/graph/inertial_offset.h"

#include <cstddef>
#include <cstdint>
#include <vector>

// Techniques: char.blend

namespace limn {

namespace {

constexpr float kVelocityInterval = 1.0f / 1000.0f;  ///< over which velocities are measured [s]

/// Empties the list and frees its memory.
template <typename T>
void free_list(std::vector<T>& list) {
    list = std::vector<T>();
}

}  // namespace

void end_transition(MotionGraphState& state) {
    state.transition = kNoGraphState;
    state.source = GraphPlayback{};
    state.clock = 0.0f;
    free_list(state.turns);
    free_list(state.shifted);
    free_list(state.shifts);
    free_list(state.morphs);
    free_list(state.frozen_translations);
    free_list(state.frozen_rotations);
    free_list(state.frozen_scales);
    free_list(state.frozen_weights);
}

void capture_offsets(
    const MotionContext& before, const MotionContext& now, const GraphPlayback& next,
    MotionGraphState& state) {
    thread_local MotionPose shown;
    thread_local MotionPose shown_earlier;
    thread_local MotionPose target;
    thread_local MotionPose target_earlier;
    evaluate_states(before, state, 0.0f, shown);
    evaluate_states(before, state, kVelocityInterval, shown_earlier);
    evaluate_state(now, next, target);
    evaluate_state_earlier(now, next, kVelocityInterval, target_earlier);
    shown.weights.resize(target.weights.size(), 0.0f);
    shown_earlier.weights.resize(target.weights.size(), 0.0f);
    end_transition(state);
    const std::size_t joints = shown.joints.size();
    state.turns.resize(joints);
    for (std::uint16_t j = 0; j < joints; ++j) {
        state.turns[j] = inertial_turn(
            shown.joints.rotations[j], shown_earlier.joints.rotations[j],
            target.joints.rotations[j], target_earlier.joints.rotations[j], kVelocityInterval);
        const InertialOffset shift = inertial_shift(
            shown.joints.translations[j], shown_earlier.joints.translations[j],
            target.joints.translations[j], target_earlier.joints.translations[j],
            kVelocityInterval);
        if (!is_negligible(shift)) {
            state.shifted.push_back(j);
            state.shifts.push_back(shift);
        }
    }
    for (std::size_t i = 0; i < shown.weights.size(); ++i) {
        state.morphs.push_back(inertial_shift(
            Vec3(shown.weights[i], 0, 0), Vec3(shown_earlier.weights[i], 0, 0),
            Vec3(target.weights[i], 0, 0), Vec3(target_earlier.weights[i], 0, 0),
            kVelocityInterval));
    }
}

}  // namespace limn

#include "systems/animation/ik/fabrik.h"

#include "systems/animation/ik/ccd.h"
#include "systems/animation/ik/turn_toward.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.ik-ccd

namespace limn {
namespace {

/// The joints from the base to the effector, and the points that they end at: the next joint, or
/// the effector.
struct Reach {
    std::vector<std::uint16_t> joints;
    std::vector<Vec3> points;    ///< of the joints, and the effector at the end
    std::vector<float> lengths;  ///< from each point to the next

    void begin(const JointTree& tree, const JointFrames& frames, const Effector& effector) {
        joints.clear();
        for (std::int32_t joint = effector.joint; joint >= 0; joint = tree.parents[joint]) {
            joints.push_back(static_cast<std::uint16_t>(joint));
        }
        std::reverse(joints.begin(), joints.end());
        points.resize(joints.size() + 1);
        lengths.resize(joints.size());
        read(frames, effector);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            lengths[i] = glm::distance(points[i], points[i + 1]);
        }
    }

    [[nodiscard]] bool has_hinges(const JointTree& tree) const {
        return std::any_of(joints.begin(), joints.end(), [&](std::uint16_t joint) {
            const AxisRange range = axes_of(tree, joint);
            return range.first == range.last || tree.axes[range.first].kind != AxisKind::Free;
        });
    }

    void read(const JointFrames& frames, const Effector& effector) {
        for (std::size_t i = 0; i < joints.size(); ++i) {
            points[i] = frames.positions[joints[i]];
        }
        points.back() = effector_position(frames, effector);
    }

    /// From the goal to the base.
    void drag(const Vec3& goal) {
        points.back() = goal;
        for (std::size_t i = joints.size(); i-- > 0;) {
            const Vec3 away =
                normalize_or(points[i] - points[i + 1], Vec3(0, i % 2 == 0 ? 1 : -1, 0));
            points[i] = points[i + 1] + lengths[i] * away;
        }
    }
};

/// From the base to the tip: each joint turns its end toward where it was dragged.
void follow_points(
    const JointTree& tree, const Reach& reach, const Effector& effector, bool limits,
    JointFrames& frames, JointState& state) {
    const TurnOptions options = {.limits = limits};
    for (std::size_t i = 0; i < reach.joints.size(); ++i) {
        const std::uint16_t joint = reach.joints[i];
        update_frame(tree, state, joint, frames);
        const Vec3 end =
            i + 1 < reach.joints.size() ? tree.offsets[reach.joints[i + 1]] : effector.offset;
        const Vec3 point = frames.positions[joint] + frames.rotations[joint] * end;
        turn_toward(tree, frames, joint, point, reach.points[i + 1], options, state);
        update_frame(tree, state, joint, frames);
    }
}

}  // namespace

IkResult solve_fabrik(
    const JointTree& tree, const Effector& effector, const Vec3& goal, const FabrikOptions& options,
    JointState& state) {
    if (!std::isfinite(glm::dot(goal, goal)) || tree.size() == 0) {
        return {INFINITY, 0, false};
    }
    thread_local JointFrames frames;
    thread_local Reach reach;
    thread_local JointState best;
    IkResult result;
    find_frames(tree, state, frames);
    reach.begin(tree, frames, effector);
    result.distance = glm::distance(reach.points.back(), goal);
    best = state;
    const bool has_hinges = reach.has_hinges(tree);
    while (result.iterations < options.iterations && result.distance > options.tolerance) {
        ++result.iterations;
        reach.drag(goal);
        follow_points(tree, reach, effector, options.limits, frames, state);
        if (has_hinges) {
            solve_ccd(tree, effector, goal, {.passes = 1, .limits = options.limits}, state);
            find_frames(tree, state, frames);
        }
        reach.read(frames, effector);
        const float distance = glm::distance(reach.points.back(), goal);
        if (distance < result.distance) {
            result.distance = distance;
            best = state;
        }
    }
    state = best;
    result.is_reached = result.distance <= options.tolerance;
    return result;
}

}  // namespace limn

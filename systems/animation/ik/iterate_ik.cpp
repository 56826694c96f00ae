#include "systems/animation/ik/iterate_ik.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_limits.h"
#include "systems/animation/ik/pseudo_inverse.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

// Techniques: char.ik-iterate, char.ik-joint-limits, char.ik-weights

namespace limn {
namespace {

constexpr float kTurnScale = 0.3f;  // of an angle, relative to the length of the chain; by eye
constexpr int kMaxHalvings = 10;
constexpr int kMaxBlocked = 8;  // times that axes are taken out

/// A move of the effector: position [m] and, if orientation matters, rotation vector times scale.
using Move = std::array<float, 6>;

float size_of_move(const Move& move) {
    float sum = 0;
    for (const float value : move) {
        sum += value * value;
    }
    return std::sqrt(sum);
}

/// One solve; buffers are reused.
class Iteration {
  public:
    void begin(
        const JointTree& tree, const Effector& effector, const IkGoal& goal,
        const IkOptions& options) {
        tree_ = &tree;
        effector_ = effector;
        goal_ = goal;
        options_ = &options;
        length_ = chain_length(tree, effector);
        turn_scale_ = goal.rotation ? kTurnScale * length_ : 0.0f;
        rows_ = goal.rotation ? 6 : 3;
        step_.resize(tree.axes.size());
        comfort_.resize(tree.axes.size());
    }

    IkResult run(JointState& state) {
        IkResult result;
        find_frames(*tree_, state, frames_);
        Move error = error_of(frames_);
        while (result.iterations < options_->iterations
               && size_of_move(error) > options_->tolerance) {
            ++result.iterations;
            find_jacobian(*tree_, frames_, effector_, turn_scale_, jacobian_);
            const float distance = size_of_move(error);
            float share = std::min(1.0f, options_->step * length_ / distance);
            damping_ = options_->damping * length_;
            int halvings = 0;
            while (halvings <= kMaxHalvings && !try_move(error, share, distance, state)) {
                share *= 0.5f;
                damping_ *= 2;  // toward the steepest descent, which cannot fail
                ++halvings;
            }
            if (halvings > kMaxHalvings) {
                break;  // no move brings it closer
            }
            std::swap(state, trial_);
            std::swap(frames_, trial_frames_);
            error = error_of(frames_);
        }
        result.distance = glm::distance(effector_position(frames_, effector_), goal_.position);
        result.is_reached = size_of_move(error) <= options_->tolerance;
        return result;
    }

  private:
    [[nodiscard]] Move error_of(const JointFrames& frames) const {
        Move error = {};
        const Vec3 position = goal_.position - effector_position(frames, effector_);
        Vec3 turn(0);
        if (goal_.rotation) {
            const Quat& now = frames.rotations[effector_.joint];
            const Quat left = to_same_hemisphere(now, *goal_.rotation) * glm::conjugate(now);
            turn = 2 * turn_scale_ * log_rotation(normalize_or_identity(left));
        }
        for (int i = 0; i < 3; ++i) {
            error[i] = position[i];
            error[i + 3] = turn[i];
        }
        return error;
    }

    /// Sets step_ for the move, with blocked axes taken out of `free_`.
    void find_step(const Move& move, const JointState& state) {
        free_ = jacobian_;
        for (std::size_t i = 0; i < step_.size(); ++i) {
            if (!(tree_->axes[i].weight > 0)) {
                take_out(i);
            }
        }
        for (int round = 0; round < kMaxBlocked; ++round) {
            find_pseudo_inverse(free_, damping_, inverse_);
            multiply(inverse_, std::span(move).first(rows_), step_);
            if (!options_->limits || !take_out_blocked(state)) {
                break;
            }
        }
        for (std::size_t i = 0; i < step_.size(); ++i) {
            step_[i] *= std::clamp(tree_->axes[i].weight, 0.0f, 1.0f);
        }
    }

    void take_out(std::size_t axis) {
        for (std::size_t row = 0; row < rows_; ++row) {
            free_.at(row, axis) = 0;
        }
    }

    /// Whether an axis was at its limit: then its column is 0 now.
    bool take_out_blocked(const JointState& state) {
        bool any = false;
        for (std::size_t i = 0; i < step_.size(); ++i) {
            if (is_blocked(tree_->axes[i], state.values[i], step_[i])) {
                any = true;
                take_out(i);
            }
        }
        return any;
    }

    /// Secondary task: the comfortable pose, as far as it does not move the effector.
    void add_comfort(float share) {
        find_comfort_step(*tree_, trial_, options_->comfort * share, comfort_);
        for (std::size_t i = 0; i < comfort_.size(); ++i) {
            comfort_[i] *= std::clamp(tree_->axes[i].weight, 0.0f, 1.0f);
        }
        project_to_null_space(jacobian_, inverse_, comfort_);
        advance(*tree_, comfort_, trial_);
    }

    /// Sets trial_ to the state after a share of the error; whether the move is good.
    bool try_move(const Move& error, float share, float distance, const JointState& state) {
        Move move = error;
        for (float& value : move) {
            value *= share;
        }
        find_step(move, state);
        trial_ = state;
        advance(*tree_, step_, trial_);
        if (options_->comfort > 0) {
            add_comfort(share);
        }
        const bool clamped = options_->limits && clamp_to_limits(*tree_, trial_);
        find_frames(*tree_, trial_, trial_frames_);
        if (options_->tracking <= 0) {
            return true;
        }
        const Move left = error_of(trial_frames_);
        if (!(size_of_move(left) < distance)) {
            return false;
        }
        Move expected = {};
        multiply(jacobian_, step_, std::span(expected).first(rows_));
        Move deviation = {};
        for (std::size_t i = 0; i < rows_; ++i) {
            deviation[i] = (error[i] - left[i]) - expected[i];
        }
        return clamped || options_->comfort > 0
               || size_of_move(deviation) <= options_->tracking * size_of_move(move);
    }

    const JointTree* tree_ = nullptr;
    const IkOptions* options_ = nullptr;
    Effector effector_;
    IkGoal goal_;
    float length_ = 0;
    float turn_scale_ = 0;
    float damping_ = 0;
    std::size_t rows_ = 3;
    JointFrames frames_;
    JointFrames trial_frames_;
    JointState trial_;
    IkMatrix jacobian_;
    IkMatrix free_;
    IkMatrix inverse_;
    std::vector<float> step_;
    std::vector<float> comfort_;
};

}  // namespace

IkResult iterate_ik(
    const JointTree& tree, const Effector& effector, const IkGoal& goal, const IkOptions& options,
    JointState& state) {
    LIMN_CHECK(state.values.size() == tree.axes.size() && state.turns.size() == tree.size());
    const bool is_finite_goal =
        std::isfinite(glm::dot(goal.position, goal.position))
        && (!goal.rotation || std::isfinite(glm::dot(*goal.rotation, *goal.rotation)));
    if (!is_finite_goal || tree.size() == 0) {
        return {INFINITY, 0, false};
    }
    thread_local Iteration iteration;
    iteration.begin(tree, effector, goal, options);
    return iteration.run(state);
}

}  // namespace limn

#include "systems/animation/ik/penalty_ik.h"

#include "ecs/base/check.h"
#include "systems/animation/ik/chain_jacobian.h"
#include "systems/animation/ik/joint_limits.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

// Techniques: char.ik-penalty

namespace limn {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr double kMaxDamping = 1e9;

bool counts(const PenaltyGoal& goal) {
    return is_finite(goal.position) && goal.weight > 0 && std::isfinite(goal.weight);
}

double energy_of(
    const JointTree& tree, const JointState& state, const JointFrames& frames,
    std::span<const PenaltyGoal> goals, float stiffness) {
    double energy = 0;
    for (const PenaltyGoal& goal : goals) {
        if (counts(goal)) {
            const Vec3 left = effector_position(frames, goal.effector) - goal.position;
            energy += double(goal.weight) * double(glm::dot(left, left));
        }
    }
    for (std::size_t i = 0; i < tree.axes.size(); ++i) {
        const JointAxis& axis = tree.axes[i];
        const float middle = axis.kind == AxisKind::Free ? 0.0f : axis.middle;
        const double away = double(axis_value(tree, state, i) - middle);
        energy += double(stiffness * axis.stiffness) * away * away;
    }
    return energy;
}

/// Solves the symmetric positive definite system a x = b in place, by Cholesky's method; false if
/// it is not definite.
bool solve_definite(std::size_t n, std::vector<double>& a, std::vector<double>& b) {
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[i * n + j];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= a[i * n + k] * a[j * n + k];
            }
            if (i == j && !(sum > 0)) {
                return false;
            }
            a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            b[i] -= a[i * n + k] * b[k];
        }
        b[i] /= a[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) {
            b[i] -= a[k * n + i] * b[k];
        }
        b[i] /= a[i * n + i];
    }
    return true;
}

/// Half of the gradient of E, and J^T K J: buffers of one minimization.
struct NormalEquations {
    std::vector<double> matrix;
    std::vector<double> downhill;
    std::vector<double> damped;
    std::vector<double> solution;
    std::vector<float> step;
    IkMatrix jacobian;

    void find(
        const JointTree& tree, const JointState& state, const JointFrames& frames,
        std::span<const PenaltyGoal> goals, float stiffness) {
        const std::size_t n = tree.axes.size();
        matrix.assign(n * n, 0.0);
        downhill.assign(n, 0.0);
        for (const PenaltyGoal& goal : goals) {
            if (counts(goal)) {
                const Vec3 left = goal.position - effector_position(frames, goal.effector);
                find_jacobian(tree, frames, goal.effector, 0, jacobian);
                add(double(goal.weight), left);
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            const JointAxis& axis = tree.axes[i];
            const float middle = axis.kind == AxisKind::Free ? 0.0f : axis.middle;
            const double pull = double(stiffness * axis.stiffness);
            matrix[i * n + i] += pull;
            downhill[i] += pull * double(middle - axis_value(tree, state, i));
        }
    }

    void add(double weight, const Vec3& left) {
        const std::size_t n = jacobian.columns;
        for (std::size_t i = 0; i < n; ++i) {
            for (int row = 0; row < 3; ++row) {
                const double slope = weight * double(jacobian.at(row, i));
                if (slope == 0) {
                    continue;
                }
                downhill[i] += slope * double(left[row]);
                for (std::size_t j = 0; j < n; ++j) {
                    matrix[i * n + j] += slope * double(jacobian.at(row, j));
                }
            }
        }
    }

    /// Sets `step`; axes without weight, or blocked by a limit downhill, stay.
    bool solve(const JointTree& tree, const JointState& state, double damping, bool limits) {
        const std::size_t n = tree.axes.size();
        double largest = 1e-12;
        for (std::size_t i = 0; i < n; ++i) {
            largest = std::max(largest, matrix[i * n + i]);
        }
        damped = matrix;
        solution = downhill;
        for (std::size_t i = 0; i < n; ++i) {
            damped[i * n + i] += damping * largest;
            const bool stays =
                !(tree.axes[i].weight > 0)
                || (limits
                    && is_blocked(tree.axes[i], state.values[i], static_cast<float>(downhill[i])));
            if (stays) {
                for (std::size_t j = 0; j < n; ++j) {
                    damped[i * n + j] = 0;
                    damped[j * n + i] = 0;
                }
                damped[i * n + i] = 1;
                solution[i] = 0;
            }
        }
        if (!solve_definite(n, damped, solution)) {
            return false;
        }
        step.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            step[i] = static_cast<float>(solution[i]);
        }
        return true;
    }
};

}  // namespace

float penalty_of(
    const JointTree& tree, const JointState& state, std::span<const PenaltyGoal> goals,
    float stiffness) {
    return static_cast<float>(energy_of(tree, state, find_frames(tree, state), goals, stiffness));
}

PenaltyResult minimize_penalty(
    const JointTree& tree, std::span<const PenaltyGoal> goals, const PenaltyOptions& options,
    JointState& state) {
    LIMN_CHECK(state.values.size() == tree.axes.size() && state.turns.size() == tree.size());
    thread_local NormalEquations equations;
    thread_local JointFrames frames;
    thread_local JointState trial;
    PenaltyResult result;
    find_frames(tree, state, frames);
    double energy = energy_of(tree, state, frames, goals, options.stiffness);
    result.before = static_cast<float>(energy);
    double damping = kFirstDamping;
    while (result.iterations < options.iterations && damping < kMaxDamping) {
        ++result.iterations;
        equations.find(tree, state, frames, goals, options.stiffness);
        double lower = energy;
        while (damping < kMaxDamping) {
            if (equations.solve(tree, state, damping, options.limits)) {
                trial = state;
                advance(tree, equations.step, trial);
                if (options.limits) {
                    clamp_to_limits(tree, trial);
                }
                find_frames(tree, trial, frames);
                lower = energy_of(tree, trial, frames, goals, options.stiffness);
                if (lower < energy) {
                    std::swap(state, trial);
                    damping = std::max(damping * 0.2, 1e-9);
                    break;
                }
            }
            damping *= 4;
        }
        const bool is_done = !(lower < energy - double(options.tolerance) * energy);
        energy = std::min(energy, lower);
        if (is_done) {
            break;
        }
    }
    result.after = static_cast<float>(energy);
    return result;
}

}  // namespace limn

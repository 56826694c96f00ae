#include "bench/oracles/ik_oracle.h"
#include "bench/quality/characters_quality.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/chain_jacobian.h"
#include "systems/animation/ik/ik_kernels.h"
#include "systems/animation/ik/iterate_ik.h"
#include "systems/animation/ik/two_link.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

// Techniques: char.ik-two-link, char.ik-jacobian, char.ik-iterate, char.ik-joint-limits

namespace limn::ik_quality {
namespace {

constexpr std::size_t kLimbs = 10000;
constexpr std::size_t kChains = 500;
constexpr std::size_t kJoints = 7;

/// One number at a time: compilers draw the arguments of a call in different orders.
Vec3 random_direction(Random& random) {
    const float x = random.normal();
    const float y = random.normal();
    const float z = random.normal();
    return normalize_or({x, y, z}, {0, 1, 0});
}

Vec3 random_offset(Random& random, float low, float high) {
    const Vec3 direction = random_direction(random);
    return random.uniform(low, high) * direction;
}

glm::dvec3 turned(const Quat& q, const glm::dvec3& v) {
    return glm::normalize(glm::dquat(q)) * v;
}

/// Distance of 10,000 tips from where the closed form has them: at the target, or at the nearest
/// point in reach.
void measure_limbs(QualityReport& report) {
    Random random(1, 0, 0, 0);
    TwoLinkBatch limbs;
    limbs.resize(kLimbs);
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const Vec3 root = random_offset(random, 0, 2);
        const Vec3 middle = root + random_offset(random, 0.2f, 0.5f);
        limbs.root.set(i, root);
        limbs.middle.set(i, middle);
        limbs.tip.set(i, middle + random_offset(random, 0.2f, 0.5f));
        limbs.target.set(i, root + random_offset(random, 0.0f, 1.2f));
        limbs.pole.set(i, random_direction(random));
    }
    solve_two_links(limbs);
    double reached = 0;
    double missed = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const glm::dvec3 root(limbs.root.get(i));
        const glm::dvec3 upper = glm::dvec3(limbs.middle.get(i)) - root;
        const glm::dvec3 lower = glm::dvec3(limbs.tip.get(i)) - glm::dvec3(limbs.middle.get(i));
        const glm::dvec3 target(limbs.target.get(i));
        const glm::dvec3 tip = root + turned(limbs.upper.get(i), upper)
                               + turned(limbs.lower.get(i), turned(limbs.upper.get(i), lower));
        const double far = glm::distance(target, root);
        const double reach = glm::length(upper) + glm::length(lower);
        const double least = std::abs(glm::length(upper) - glm::length(lower));
        const double expected = std::max({far - reach, least - far, 0.0});
        const double error = std::abs(glm::distance(tip, target) - expected);
        const bool is_inside = far > least + 0.01 && far < reach - 0.01;
        (is_inside ? reached : missed) = std::max(is_inside ? reached : missed, error);
    }
    report.at_most("10,000 limbs in reach, tip off its target", 1000 * reached, 0.01, "mm");
    report.at_most("the others, distance off the closed form", 1000 * missed, 2, "mm");
}

void measure_planar_limbs(QualityReport& report) {
    Random random(2, 0, 0, 0);
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
        const float first = random.uniform(0.2f, 1.5f);
        const float second = random.uniform(0.2f, 1.5f);
        const float x = random.uniform(-3.0f, 3.0f);
        const float y = random.uniform(-3.0f, 3.0f);
        const Vec2 tip = two_link_tip(solve_two_link({x, y}, first, second), first, second);
        const double found = std::hypot(double(tip.x) - double(x), double(tip.y) - double(y));
        const double best =
            oracle::two_link_distance(double(x), double(y), double(first), double(second));
        worst = std::max(worst, found - best);
    }
    report.at_most(
        "two links in a plane, farther than the best of a search", 1000 * worst, 0.01, "mm");
}

void measure_aim(QualityReport& report) {
    Random random(3, 0, 0, 0);
    AimBatch batch;
    batch.resize(kLimbs);
    for (std::size_t i = 0; i < kLimbs; ++i) {
        batch.forward.set(i, random_offset(random, 0.1f, 9));
        batch.wanted.set(i, random_offset(random, 0.1f, 9));
    }
    aim(batch);
    double worst = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const glm::dvec3 now =
            turned(batch.rotation.get(i), glm::normalize(glm::dvec3(batch.forward.get(i))));
        const double chord = glm::distance(now, glm::normalize(glm::dvec3(batch.wanted.get(i))));
        worst = std::max(worst, 2 * std::asin(std::min(chord / 2, 1.0)));
    }
    report.at_most("10,000 looks, off their targets", glm::degrees(worst), 0.001, "degrees");
}

/// Seven hinges about random axes, and the same for the oracle.
struct HingeChain {
    JointTree tree;
    std::vector<oracle::IkJoint> joints;
    Effector tip;
    oracle::Vec3d end = {};
};

oracle::Vec3d to_oracle(const Vec3& v) {
    return {double(v.x), double(v.y), double(v.z)};
}

HingeChain make_hinge_chain(Random& random, float limit) {
    HingeChain chain;
    for (std::size_t i = 0; i < kJoints; ++i) {
        const Vec3 offset = i == 0 ? Vec3(0) : random_offset(random, 0.1f, 0.4f);
        add_joint(chain.tree, static_cast<std::int32_t>(i) - 1, offset);
        add_hinge(chain.tree, random_direction(random), -limit, limit);
        chain.joints.push_back({to_oracle(offset), to_oracle(chain.tree.axes[i].axis), false});
    }
    chain.tip = {kJoints - 1, random_offset(random, 0.1f, 0.3f)};
    chain.end = to_oracle(chain.tip.offset);
    return chain;
}

JointState random_angles(Random& random, const JointTree& tree, float range) {
    JointState state = zero_state(tree);
    for (float& value : state.values) {
        value = random.uniform(-range, range);
    }
    return state;
}

oracle::Vec3d exact_tip(const HingeChain& chain, const JointState& state) {
    return oracle::ik_tip(
        chain.joints, std::vector<double>(state.values.begin(), state.values.end()), chain.end);
}

/// Largest difference of the analytic Jacobian from central differences of forward kinematics in
/// double precision.
double jacobian_error(const HingeChain& chain, const JointState& state) {
    IkMatrix jacobian;
    find_jacobian(chain.tree, find_frames(chain.tree, state), chain.tip, 0, jacobian);
    double worst = 0;
    for (std::size_t column = 0; column < kJoints; ++column) {
        const oracle::Vec3d expected = oracle::ik_column(
            chain.joints, std::vector<double>(state.values.begin(), state.values.end()), chain.end,
            column);
        for (std::size_t row = 0; row < 3; ++row) {
            worst = std::max(worst, std::abs(double(jacobian.at(row, column)) - expected[row]));
        }
    }
    return worst;
}

/// Goals that a pose within the limits reaches, from another such pose.
void measure_hinges(QualityReport& report) {
    Random random(4, 0, 0, 0);
    double jacobian = 0;
    double claimed = 0;
    double beyond = 0;
    int reached = 0;
    for (std::size_t i = 0; i < kChains; ++i) {
        const float limit = random.uniform(0.6f, 2.5f);
        const HingeChain chain = make_hinge_chain(random, limit);
        JointState state = random_angles(random, chain.tree, 0.9f * limit);
        jacobian = std::max(jacobian, jacobian_error(chain, state));
        const oracle::Vec3d goal =
            exact_tip(chain, random_angles(random, chain.tree, 0.9f * limit));
        const IkResult result = iterate_ik(
            chain.tree, chain.tip, {.position = {float(goal[0]), float(goal[1]), float(goal[2])}},
            {.iterations = 200}, state);
        const double distance = oracle::size_of(oracle::minus(exact_tip(chain, state), goal));
        claimed = std::max(claimed, std::abs(distance - double(result.distance)));
        reached += distance < 2e-3 ? 1 : 0;
        for (const float value : state.values) {
            beyond = std::max(beyond, double(std::abs(value) - limit));
        }
    }
    report.at_most(
        "Jacobian of 500 chains of 7 hinges, off differences in double precision", jacobian, 1e-5,
        "m/rad");
    report.at_most(
        "distance it claims, off kinematics in double precision", 1000 * claimed, 0.01, "mm");
    report.at_most(
        "hinges beyond their limits", glm::degrees(std::max(beyond, 0.0)), 1e-4, "degrees");
    report.at_least(
        "goals in reach that are reached within 2 mm", 100.0 * reached / kChains, 90, "%");
}

struct ChainMethod {
    const char* name;
    void (*solve)(ChainBatch&, const ChainOptions&);
    double limit;  ///< of the mean distance that is left [mm]
};
constexpr std::array<ChainMethod, 3> kChainMethods = {
    {{"damped least squares", solve_chains_dls, 10},
     {"FABRIK", solve_chains_fabrik, 10},
     {"cyclic coordinate descent", solve_chains_ccd, 10}}};

void measure_free_chains(QualityReport& report) {
    for (const ChainMethod& method : kChainMethods) {
        Random random(5, 0, 0, 0);
        ChainBatch chains;
        chains.resize(kJoints, kChains);
        for (std::size_t i = 0; i < kChains; ++i) {
            Vec3 point(0);
            chains.points.set(i, point);
            for (std::size_t k = 1; k <= kJoints; ++k) {
                point += random_offset(random, 0.2f, 0.2f);
                chains.points.set(k * kChains + i, point);
            }
            chains.goals.set(i, random_offset(random, 0.1f, 1.0f));
        }
        method.solve(chains, {.iterations = 20});
        double left = 0;
        double stretched = 0;
        for (std::size_t i = 0; i < kChains; ++i) {
            left += double(
                glm::distance(chains.points.get(kJoints * kChains + i), chains.goals.get(i)));
            for (std::size_t k = 1; k <= kJoints; ++k) {
                const double length = double(glm::distance(
                    chains.points.get(k * kChains + i), chains.points.get((k - 1) * kChains + i)));
                stretched = std::max(stretched, std::abs(length - 0.2) / 0.2);
            }
        }
        const std::string suffix = std::string(", ") + method.name;
        report.at_most(
            "distance left after 20 iterations, mean of 500 chains" + suffix, 1000 * left / kChains,
            method.limit, "mm");
        report.at_most("bones longer or shorter" + suffix, 100 * stretched, 0.01, "%");
    }
}

Status measure_ik(HeadlessRenderer& /*headless*/, QualityReport& report) {
    measure_limbs(report);
    measure_planar_limbs(report);
    measure_aim(report);
    measure_hinges(report);
    measure_free_chains(report);
    return Done{};
}

const RegisterCharacterPart kIkPart("inverse kinematics", measure_ik);

}  // namespace
}  // namespace limn::ik_quality

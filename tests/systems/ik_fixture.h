#pragma once

#include "bench/oracles/ik_oracle.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"

#include <vector>

namespace limn::test {

/// Hinges about z in the plane z = 0, each link along +x.
inline JointTree make_planar_chain(const std::vector<float>& lengths) {
    JointTree tree;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        add_joint(
            tree, static_cast<std::int32_t>(i) - 1, Vec3(i == 0 ? 0.0f : lengths[i - 1], 0, 0));
        add_hinge(tree, {0, 0, 1});
    }
    return tree;
}

/// The tip of such a chain.
inline Effector planar_tip(const JointTree& tree, float last) {
    return {static_cast<std::uint16_t>(tree.size() - 1), {last, 0, 0}};
}

/// `count` joints that turn freely, each link of length 1 along +y.
inline JointTree make_free_chain(std::size_t count, float length = 1) {
    JointTree tree;
    for (std::size_t i = 0; i < count; ++i) {
        add_joint(tree, static_cast<std::int32_t>(i) - 1, Vec3(0, i == 0 ? 0.0f : length, 0));
        add_free_axes(tree);
    }
    return tree;
}

inline Vec3 any_direction(Random& random) {
    // one at a time: compilers draw the arguments of a call in different orders
    const float z = random.normal();
    const float y = random.normal();
    const float x = random.normal();
    return normalize_or({x, y, z}, {0, 1, 0});
}

/// In any direction, from `low` to `high` long.
inline Vec3 any_offset(Random& random, float low, float high) {
    const Vec3 direction = any_direction(random);
    return random.uniform(low, high) * direction;
}

/// About any axis, by up to `angle` either way [rad].
inline Quat any_turn(Random& random, float angle) {
    const float turn = random.uniform(-angle, angle);
    return rotation_about(any_direction(random), turn);
}

/// Hinges about random axes with random links, and the same for the oracle.
struct RandomChain {
    JointTree tree;
    std::vector<oracle::IkJoint> joints;
    Effector tip;
    oracle::Vec3d end = {};
};

inline oracle::Vec3d to_double(const Vec3& v) {
    return {double(v.x), double(v.y), double(v.z)};
}

inline RandomChain make_random_chain(Random& random, std::size_t count, bool slides = false) {
    RandomChain chain;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 offset = i == 0 ? Vec3(0) : any_offset(random, 0.3f, 1.0f);
        const Vec3 axis = any_direction(random);
        const bool is_slide = slides && i % 3 == 1;
        add_joint(chain.tree, static_cast<std::int32_t>(i) - 1, offset);
        if (is_slide) {
            add_slide(chain.tree, axis);
        } else {
            add_hinge(chain.tree, axis);
        }
        chain.joints.push_back({to_double(offset), to_double(chain.tree.axes[i].axis), is_slide});
    }
    chain.tip = {static_cast<std::uint16_t>(count - 1), 0.5f * any_direction(random)};
    chain.end = to_double(chain.tip.offset);
    return chain;
}

inline JointState random_state(Random& random, const JointTree& tree, float range = 1.5f) {
    JointState state = zero_state(tree);
    for (float& value : state.values) {
        value = random.uniform(-range, range);
    }
    std::vector<float> step(tree.axes.size());
    for (std::size_t i = 0; i < step.size(); ++i) {
        const bool is_free = tree.axes[i].kind == AxisKind::Free;
        step[i] = is_free ? random.uniform(-range, range) : 0.0f;
    }
    advance(tree, step, state);
    return state;
}

inline std::vector<double> to_double(const JointState& state) {
    return {state.values.begin(), state.values.end()};
}

inline Vec3 tip_of(const JointTree& tree, const JointState& state, const Effector& tip) {
    return effector_position(find_frames(tree, state), tip);
}

}  // namespace limn::test

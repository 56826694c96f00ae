#include "systems/animation/ik/joint_tree.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Techniques: char.fk-function

namespace limn {
namespace {

constexpr Vec3 kUnitAxes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void add_axis(JointTree& tree, const Vec3& axis, AxisKind kind, float min, float max) {
    LIMN_CHECK(tree.size() > 0);
    tree.axes.push_back(
        {.joint = static_cast<std::uint16_t>(tree.size() - 1),
         .kind = kind,
         .axis = normalize_or(axis, Vec3(1, 0, 0)),
         .min = min,
         .max = max});
}

/// Angle of the part of a rotation about a unit axis, -pi .. pi [rad].
float twist_angle(const Quat& q, const Vec3& axis) {
    const float along = glm::dot(Vec3(q.x, q.y, q.z), axis);
    return q.w < 0 ? 2 * std::atan2(-along, -q.w) : 2 * std::atan2(along, q.w);
}

/// Angles of r(x) r(y) r(z) = q about perpendicular axes, the middle one within a quarter turn.
std::array<float, 3> angles_about(const Quat& q, const Vec3& x, const Vec3& y, const Vec3& z) {
    const Vec3 to_z = q * z;
    const Vec3 to_x = q * x;
    const Vec3 to_y = q * y;
    return {
        std::atan2(-glm::dot(y, to_z), glm::dot(z, to_z)),
        std::asin(std::clamp(glm::dot(x, to_z), -1.0f, 1.0f)),
        std::atan2(-glm::dot(x, to_y), glm::dot(x, to_x))};
}

/// Angles about one to three hinges, as if they were perpendicular.
std::array<float, 3> hinge_angles(std::span<const JointAxis> hinges, const Quat& q) {
    const Vec3 x = hinges[0].axis;
    if (hinges.size() == 1) {
        return {twist_angle(q, x), 0, 0};
    }
    const Vec3 across = hinges[1].axis - glm::dot(hinges[1].axis, x) * x;
    const Vec3 y = normalize_or(across, any_perpendicular(x));
    const Vec3 z = glm::cross(x, y);
    std::array<float, 3> angles = angles_about(q, x, y, z);
    if (hinges.size() > 2 && glm::dot(hinges[2].axis, z) < 0) {
        angles[2] = -angles[2];
    }
    return angles;
}

/// Product of the rotations about the axes of a joint.
Quat axes_rotation(const JointTree& tree, const JointState& state, const AxisRange& range) {
    Quat rotation(1, 0, 0, 0);
    for (std::size_t i = range.first; i < range.last; ++i) {
        if (tree.axes[i].kind == AxisKind::Hinge) {
            rotation = rotation * rotation_about(tree.axes[i].axis, state.values[i]);
        }
    }
    return rotation;
}

}  // namespace

std::uint16_t add_joint(JointTree& tree, std::int32_t parent, const Vec3& offset) {
    LIMN_CHECK(parent < static_cast<std::int32_t>(tree.size()));
    tree.parents.push_back(parent);
    tree.offsets.push_back(offset);
    tree.rests.emplace_back(1, 0, 0, 0);
    return static_cast<std::uint16_t>(tree.size() - 1);
}

void add_hinge(JointTree& tree, const Vec3& axis, float min, float max) {
    add_axis(tree, axis, AxisKind::Hinge, min, max);
}

void add_slide(JointTree& tree, const Vec3& axis, float min, float max) {
    add_axis(tree, axis, AxisKind::Slide, min, max);
}

void add_free_axes(JointTree& tree) {
    for (const Vec3& axis : kUnitAxes) {
        add_axis(tree, axis, AxisKind::Free, -INFINITY, INFINITY);
    }
}

JointState zero_state(const JointTree& tree) {
    return {
        std::vector<float>(tree.axes.size(), 0.0f),
        std::vector<Quat>(tree.size(), Quat(1, 0, 0, 0))};
}

AxisRange axes_of(const JointTree& tree, std::uint16_t joint) {
    const auto by_joint = [](const JointAxis& axis, std::uint16_t wanted) {
        return axis.joint < wanted;
    };
    const auto first = std::lower_bound(tree.axes.begin(), tree.axes.end(), joint, by_joint);
    AxisRange range;
    range.first = static_cast<std::size_t>(first - tree.axes.begin());
    range.last = range.first;
    while (range.last < tree.axes.size() && tree.axes[range.last].joint == joint) {
        ++range.last;
    }
    return range;
}

AxisLimits axis_limits(const JointAxis& axis) {
    if (std::isnan(axis.min) || std::isnan(axis.max)) {
        return {};
    }
    return {std::min(axis.min, axis.max), std::max(axis.min, axis.max)};
}

void update_frame(
    const JointTree& tree, const JointState& state, std::uint16_t joint, JointFrames& frames) {
    const std::int32_t parent = tree.parents[joint];
    const bool is_base = parent < 0;
    const Quat before = is_base ? tree.base_rotation : frames.rotations[parent];
    Vec3 position =
        (is_base ? tree.base_position : frames.positions[parent]) + before * tree.offsets[joint];
    Quat rotation = before * tree.rests[joint];
    const AxisRange range = axes_of(tree, joint);
    for (std::size_t i = range.first; i < range.last; ++i) {
        const JointAxis& axis = tree.axes[i];
        frames.axes[i] = rotation * axis.axis;
        frames.centers[i] = position;
        if (axis.kind == AxisKind::Hinge) {
            rotation = rotation * rotation_about(axis.axis, state.values[i]);
        } else if (axis.kind == AxisKind::Slide) {
            position += state.values[i] * frames.axes[i];
        }
    }
    rotation = normalize_or_identity(rotation * state.turns[joint]);
    for (std::size_t i = range.first; i < range.last; ++i) {
        if (tree.axes[i].kind == AxisKind::Free) {
            frames.axes[i] = rotation * tree.axes[i].axis;
        }
    }
    frames.positions[joint] = position;
    frames.rotations[joint] = rotation;
}

void find_frames(const JointTree& tree, const JointState& state, JointFrames& frames) {
    frames.positions.resize(tree.size());
    frames.rotations.resize(tree.size());
    frames.axes.resize(tree.axes.size());
    frames.centers.resize(tree.axes.size());
    for (std::size_t joint = 0; joint < tree.size(); ++joint) {
        update_frame(tree, state, static_cast<std::uint16_t>(joint), frames);
    }
}

JointFrames find_frames(const JointTree& tree, const JointState& state) {
    JointFrames frames;
    find_frames(tree, state, frames);
    return frames;
}

Vec3 effector_position(const JointFrames& frames, const Effector& effector) {
    return frames.positions[effector.joint] + frames.rotations[effector.joint] * effector.offset;
}

void advance(const JointTree& tree, std::span<const float> step, JointState& state) {
    for (std::size_t i = 0; i < tree.axes.size(); ++i) {
        const JointAxis& axis = tree.axes[i];
        if (axis.kind != AxisKind::Free) {
            state.values[i] += step[i];
            continue;
        }
        Vec3 turn(0);
        const std::size_t first = i;
        while (i < tree.axes.size() && tree.axes[i].joint == tree.axes[first].joint) {
            turn += step[i] * tree.axes[i].axis;
            ++i;
        }
        --i;
        Quat& joint = state.turns[axis.joint];
        joint = normalize_or_identity(joint * exp_rotation(0.5f * turn));
    }
}

float axis_value(const JointTree& tree, const JointState& state, std::size_t axis) {
    const JointAxis& at = tree.axes[axis];
    if (at.kind != AxisKind::Free) {
        return state.values[axis];
    }
    const Quat& turn = state.turns[at.joint];
    return 2 * glm::dot(log_rotation(turn.w < 0 ? -turn : turn), at.axis);
}

float chain_length(const JointTree& tree, const Effector& effector) {
    float length = glm::length(effector.offset);
    for (std::int32_t joint = effector.joint; tree.parents[joint] >= 0;
         joint = tree.parents[joint]) {
        length += glm::length(tree.offsets[joint]);
    }
    return length;
}

Quat local_rotation(const JointTree& tree, const JointState& state, std::uint16_t joint) {
    return normalize_or_identity(
        tree.rests[joint] * axes_rotation(tree, state, axes_of(tree, joint)) * state.turns[joint]);
}

void set_local_rotation(
    const JointTree& tree, const Quat& local, std::uint16_t joint, JointState& state) {
    const Quat q = glm::conjugate(tree.rests[joint]) * local;
    const AxisRange range = axes_of(tree, joint);
    const std::span<const JointAxis> axes(tree.axes.data() + range.first, range.last - range.first);
    const bool has_hinges = !axes.empty() && axes.size() <= 3
                            && std::all_of(axes.begin(), axes.end(), [](const JointAxis& axis) {
                                   return axis.kind == AxisKind::Hinge;
                               });
    if (has_hinges) {
        const std::array<float, 3> angles = hinge_angles(axes, q);
        std::copy_n(angles.begin(), axes.size(), state.values.begin() + range.first);
    }
    state.turns[joint] =
        normalize_or_identity(glm::conjugate(axes_rotation(tree, state, range)) * q);
}

JointTree make_joint_tree(const SkeletonData& skeleton, std::span<const std::uint16_t> joints) {
    JointTree tree;
    make_joint_tree(skeleton, joints, tree);
    return tree;
}

void make_joint_tree(
    const SkeletonData& skeleton, std::span<const std::uint16_t> joints, JointTree& tree) {
    tree.parents.clear();
    tree.offsets.clear();
    tree.rests.clear();
    tree.axes.clear();
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::uint16_t joint = joints[i];
        const auto parent = std::find(joints.begin(), joints.begin() + i, skeleton.parents[joint]);
        const auto found = static_cast<std::int32_t>(parent - joints.begin());
        LIMN_CHECK(i == 0 || found < static_cast<std::int32_t>(i));
        add_joint(tree, i == 0 ? -1 : found, skeleton.rest.translations[joint]);
        tree.rests.back() = normalize_or_identity(skeleton.rest.rotations[joint]);
        const std::size_t axes = tree.axes.size();
        for (const JointFreedom& freedom : skeleton.freedoms) {
            if (freedom.joint == joint) {
                add_hinge(tree, freedom.axis, freedom.min, freedom.max);
                tree.axes.back().middle = freedom.middle;
                tree.axes.back().stiffness = freedom.stiffness;
            }
        }
        if (tree.axes.size() == axes) {
            add_free_axes(tree);
        }
    }
}

std::vector<std::uint16_t>
list_chain(const SkeletonData& skeleton, std::uint16_t tip, std::size_t bones) {
    std::vector<std::uint16_t> joints;
    for (std::int32_t joint = tip; joint >= 0 && joints.size() <= bones;
         joint = skeleton.parents[joint]) {
        joints.push_back(static_cast<std::uint16_t>(joint));
    }
    std::reverse(joints.begin(), joints.end());
    return joints;
}

JointPlace find_place(const SkeletonData& skeleton, const LocalPose& pose, std::int32_t joint) {
    // Up from the joint: each ancestor moves, turns and scales what is below it.
    JointPlace place;
    for (; joint >= 0; joint = skeleton.parents[joint]) {
        place.position = pose.translations[joint]
                         + pose.rotations[joint] * (pose.scales[joint] * place.position);
        place.rotation = pose.rotations[joint] * place.rotation;
        place.scale *= pose.scales[joint];
    }
    place.rotation = normalize_or_identity(place.rotation);
    return place;
}

void read_pose(
    const SkeletonData& skeleton, const LocalPose& pose, std::span<const std::uint16_t> joints,
    JointTree& tree, JointState& state) {
    LIMN_CHECK(joints.size() == tree.size());
    if (joints.empty()) {
        return;
    }
    state.values.resize(tree.axes.size());
    state.turns.resize(tree.size());
    const JointPlace base = find_place(skeleton, pose, skeleton.parents[joints[0]]);
    tree.base_position = base.position;
    tree.base_rotation = base.rotation;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::int32_t parent = tree.parents[i];
        const Vec3 scale =
            parent < 0 ? base.scale
                       : find_place(skeleton, pose, joints[static_cast<std::size_t>(parent)]).scale;
        tree.offsets[i] = scale * pose.translations[joints[i]];
        set_local_rotation(tree, pose.rotations[joints[i]], static_cast<std::uint16_t>(i), state);
    }
}

void write_pose(
    const JointTree& tree, const JointState& state, std::span<const std::uint16_t> joints,
    LocalPose& pose) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
        pose.rotations[joints[i]] = local_rotation(tree, state, static_cast<std::uint16_t>(i));
    }
}

}  // namespace limn

#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Kinematic chains and trees: joints that turn about axes, slide along them, or turn freely, and
// forward kinematics X = f(theta). The space of a joint is its parent's space, moved by `offset`,
// then turned by rest * r(first axis) * r(second axis) ... * turn. theta has a number per axis, and
// three for a free joint. A shoulder that turns freely, an elbow with one axis and a wrist that
// turns freely have 7 for the 6 of a hand's position and orientation: one is left, the swivel of
// the elbow.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), appendix 9.1.
// Techniques: char.fk-function

enum class AxisKind : std::uint8_t {
    Hinge,  ///< turns about the axis; value [rad]
    Slide,  ///< moves along the axis; value [m]
    Free,   ///< one of the three axes of a joint that turns freely; its value is always 0
};

struct JointAxis {
    std::uint16_t joint = 0;
    AxisKind kind = AxisKind::Hinge;
    Vec3 axis = {1, 0, 0};  ///< unit; hinge and slide: after rest and earlier axes of the joint
    float min = -INFINITY;
    float max = INFINITY;
    float middle = 0.0f;     ///< the most comfortable value
    float stiffness = 0.0f;  ///< how strongly solvers prefer `middle`, 0 .. 1
    float weight = 1.0f;     ///< share of each step that the joint takes, 0 .. 1: muscle tone
};

/// Joints are sorted parents first.
struct JointTree {
    std::vector<std::int32_t> parents;  ///< an earlier joint; -1: the base
    std::vector<Vec3> offsets;          ///< from the parent, in its space [m]
    std::vector<Quat> rests;            ///< unit
    std::vector<JointAxis> axes;        ///< ascending by joint; the three of a free joint adjacent
    Vec3 base_position = {0, 0, 0};
    Quat base_rotation = {1, 0, 0, 0};

    [[nodiscard]] std::size_t size() const { return parents.size(); }
};

/// A point in joint space.
struct JointState {
    std::vector<float> values;  ///< one per axis
    std::vector<Quat> turns;    ///< one per joint, unit; without freedom: a constant
};

/// Where the joints are, in the space of the base's parent.
struct JointFrames {
    std::vector<Vec3> positions;  ///< [m]
    std::vector<Quat> rotations;
    std::vector<Vec3> axes;     ///< unit, one per axis of the tree
    std::vector<Vec3> centers;  ///< a point on each axis [m]
};

/// A point of a joint.
struct Effector {
    std::uint16_t joint = 0;
    Vec3 offset = {0, 0, 0};  ///< in the joint's space [m]
};

/// Appends a joint without axes and returns its index.
std::uint16_t add_joint(JointTree& tree, std::int32_t parent, const Vec3& offset);
void add_hinge(JointTree& tree, const Vec3& axis, float min = -INFINITY, float max = INFINITY);
void add_slide(JointTree& tree, const Vec3& axis, float min = -INFINITY, float max = INFINITY);
void add_free_axes(JointTree& tree);

/// All values 0, all turns the identity.
[[nodiscard]] JointState zero_state(const JointTree& tree);

/// Forward kinematics. `frames` is resized as needed.
void find_frames(const JointTree& tree, const JointState& state, JointFrames& frames);
[[nodiscard]] JointFrames find_frames(const JointTree& tree, const JointState& state);

/// The same for one joint, whose parent's frame is known.
void update_frame(
    const JointTree& tree, const JointState& state, std::uint16_t joint, JointFrames& frames);

/// The axes of a joint: first <= i < last.
struct AxisRange {
    std::size_t first = 0;
    std::size_t last = 0;
};
[[nodiscard]] AxisRange axes_of(const JointTree& tree, std::uint16_t joint);

/// The limits of an axis in ascending order; none if one of them is NaN.
struct AxisLimits {
    float low = -INFINITY;
    float high = INFINITY;
};
[[nodiscard]] AxisLimits axis_limits(const JointAxis& axis);

[[nodiscard]] Vec3 effector_position(const JointFrames& frames, const Effector& effector);

/// theta + step: `step` has a number per axis.
void advance(const JointTree& tree, std::span<const float> step, JointState& state);

/// Angle of an axis [rad], or its distance [m]; of a free joint the component of the rotation
/// vector from rest.
[[nodiscard]] float axis_value(const JointTree& tree, const JointState& state, std::size_t axis);

/// Sum of the lengths of the bones from the base to the effector [m].
[[nodiscard]] float chain_length(const JointTree& tree, const Effector& effector);

/// Rotation of a joint relative to its parent.
[[nodiscard]] Quat
local_rotation(const JointTree& tree, const JointState& state, std::uint16_t joint);

/// Sets values and turn of a joint so that its rotation relative to its parent is `local`: angles
/// of a joint with axes are found about the axes, made perpendicular; what they cannot express
/// remains in its turn.
void set_local_rotation(
    const JointTree& tree, const Quat& local, std::uint16_t joint, JointState& state);

/// The tree of these joints of a skeleton, ascending; it has the parents of all but the first. A
/// joint without freedoms turns freely.
[[nodiscard]] JointTree
make_joint_tree(const SkeletonData& skeleton, std::span<const std::uint16_t> joints);
/// The same, reusing the memory of `tree`.
void make_joint_tree(
    const SkeletonData& skeleton, std::span<const std::uint16_t> joints, JointTree& tree);

/// The joints from the `bones`-th ancestor of `tip`, or the root, to `tip`, ascending.
[[nodiscard]] std::vector<std::uint16_t>
list_chain(const SkeletonData& skeleton, std::uint16_t tip, std::size_t bones);

/// A placement with scale, without shear.
struct JointPlace {
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    Vec3 scale = {1, 1, 1};
};

/// Where a joint of a skeleton is in a pose; -1: the identity. Shear of scaled joints is dropped.
[[nodiscard]] JointPlace
find_place(const SkeletonData& skeleton, const LocalPose& pose, std::int32_t joint);

/// Takes base, offsets and rotations from a pose.
void read_pose(
    const SkeletonData& skeleton, const LocalPose& pose, std::span<const std::uint16_t> joints,
    JointTree& tree, JointState& state);

/// Writes the rotations to the pose; values of slides are not written.
void write_pose(
    const JointTree& tree, const JointState& state, std::span<const std::uint16_t> joints,
    LocalPose& pose);

}  // namespace limn

#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Skeletal animation: a joint hierarchy, clips that animate it, and skinned meshes. A character is
// one entity; its joints are array elements, not entities. A mesh, light or camera is attached to a
// joint by JointAttachment. Skeletons, clips and skins are stored in the Assets resource.
// Techniques: char.clip-layout

struct SkeletonId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const SkeletonId&) const = default;
};
struct ClipId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const ClipId&) const = default;
};
struct SkinId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const SkinId&) const = default;
};
template <>
inline constexpr const char* asset_kind<SkeletonId> = "skeleton";
template <>
inline constexpr const char* asset_kind<ClipId> = "clip";
template <>
inline constexpr const char* asset_kind<SkinId> = "skin";

/// Joint transforms relative to their parents, one array entry per joint: matrix = T R S.
struct LocalPose {
    std::vector<Vec3> translations;  ///< [m]
    std::vector<Quat> rotations;     ///< unit
    std::vector<Vec3> scales;

    [[nodiscard]] std::size_t size() const { return rotations.size(); }
};

/// One axis about which a joint may turn, from its rest rotation: a knee has one, a hip three. The
/// rotation of a joint is rest * r(first) * r(second) * r(third), each r(angle) about its axis.
struct JointFreedom {
    std::uint16_t joint = 0;
    Vec3 axis = {1, 0, 0};    ///< unit, in the joint's space
    float min = -3.1415927f;  ///< angles [rad], min <= middle <= max
    float max = 3.1415927f;
    float middle = 0.0f;     ///< the most comfortable angle
    float stiffness = 0.0f;  ///< how strongly inverse kinematics prefers `middle`, 0 .. 1
};

/// Joints are sorted parents first, so that one pass computes all matrices
/// (char.skeleton-hierarchy). The first ones are a skeleton of less detail.
struct SkeletonData {
    std::string name;
    std::vector<std::string> joints;    ///< names
    std::vector<std::int32_t> parents;  ///< index of an earlier joint; -1 for the first, the root
    LocalPose rest;
    std::vector<JointFreedom> freedoms = {};  ///< at most three a joint, ascending by joint; a
                                              ///< joint without any turns freely
};

/// Interpolation between two keys, as in glTF.
enum class Interpolation : std::uint8_t {
    Step,    ///< the value of the previous key
    Linear,  ///< linear; spherical for rotations (anim.slerp)
    Cubic,   ///< Hermite; three values per key: in-tangent, value, out-tangent [1/s]
};

/// Keys at common times for any number of joints: one contiguous row per key, so that a pose is
/// interpolated from two rows (char.clip-layout). A row of `rotations` has rotating.size() entries,
/// three times as many if cubic; likewise for the others.
struct ClipSheet {
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;                ///< [s], strictly increasing
    std::vector<std::uint16_t> rotating;     ///< joints, each once
    std::vector<Quat> rotations;             ///< unit, in the hemisphere of the previous key
    std::vector<std::uint16_t> translating;  ///< joints
    std::vector<Vec3> translations;          ///< [m]
    std::vector<std::uint16_t> scaling;      ///< joints
    std::vector<Vec3> scales;
    std::vector<std::uint16_t> morphing;  ///< morph weights of the character
    std::vector<float> weights;
};

/// An interval of a clip in which a joint does not move: a planted foot, a hand on a rail.
struct ClipContact {
    std::uint16_t joint = 0;
    float begin = 0.0f;  ///< [s], 0 <= begin <= end <= duration
    float end = 0.0f;    ///< [s]
};

/// Something that happens at a time of a clip: "step", "throw".
struct ClipEvent {
    std::string name;
    float time = 0.0f;  ///< [s], 0 .. duration
};

/// Animation clip of a skeleton. Joints without keys keep their rest pose.
struct ClipData {
    std::string name;
    float duration = 0.0f;  ///< time of the last key [s]
    std::vector<ClipSheet> sheets;
    std::vector<ClipContact> contacts = {};  ///< ascending by `begin`
    std::vector<ClipEvent> events = {};      ///< ascending by time
};

/// Skin of a mesh: its joint indices refer to these lists.
struct SkinData {
    std::string name;
    std::vector<std::uint16_t> joints;    ///< of the skeleton
    std::vector<Affine> joint_from_mesh;  ///< inverse bind matrix of each joint
};

/// Joint influences of a mesh's vertices. Vertex i has the entries first[i] .. first[i + 1], any
/// number of them; a vertex without influences is not moved.
struct SkinWeights {
    std::vector<std::uint32_t> first;   ///< one per vertex and one past the last; empty: no skin
    std::vector<std::uint16_t> joints;  ///< indices into SkinData::joints
    std::vector<float> weights;         ///< > 0; sum to 1 per vertex

    [[nodiscard]] bool empty() const { return first.empty(); }
};

/// How many joints of a skin the weights need: up to the last one that has a weight.
[[nodiscard]] std::size_t used_joints(const SkinWeights& weights);

/// A morph target that another one follows: an in-between or a corrective (J. Lewis et al.,
/// "Practice and Theory of Blendshape Facial Models", 2014).
struct ShapeDriver {
    std::uint16_t target = 0;  ///< index in the same list; has no drivers itself
    float peak = 1;            ///< its weight at which the follower is whole, > 0 and <= 1

    bool operator==(const ShapeDriver&) const = default;
};

/// A morph target: sparse differences from the base mesh (char.morph-target). Facial action units:
/// P. Ekman and W. Friesen, "Facial Action Coding System", 1978.
struct MorphTarget {
    std::string name;
    std::string action_unit;  ///< of FACS that it shows: "AU12", a half as "AU12_L"; empty: none
    std::vector<std::uint32_t> vertices;    ///< indices of affected vertices, increasing
    std::vector<Vec3> positions;            ///< one per entry of `vertices` [m]
    std::vector<Vec3> normals;              ///< the same, or empty
    std::vector<Vec3> tangents;             ///< the same, or empty
    std::vector<ShapeDriver> drivers = {};  ///< its weight follows theirs; empty: it is set
};

/// Fails with one line: arrays of different length, a parent that is not an earlier joint, a second
/// root, numbers that are not finite, a rotation of length 0, an invalid freedom.
[[nodiscard]] Status check_skeleton(const SkeletonData& skeleton);

/// Likewise: no keys, times that do not increase (with the index of the key), rows of the wrong
/// length, joints beyond `joints`, morph weights beyond `morphs`, duplicates, numbers that are not
/// finite, contacts and events outside the clip.
[[nodiscard]] Status check_clip(const ClipData& clip, std::size_t joints, std::size_t morphs);

/// Likewise: an empty list, a joint beyond `joints`, a matrix that is not finite or has no inverse.
[[nodiscard]] Status check_skin(const SkinData& skin, std::size_t joints);

/// Number of floats in the clip: m (1 + 7 n) for m keys of n joints that rotate and translate.
[[nodiscard]] std::size_t clip_size(const ClipData& clip);

}  // namespace limn

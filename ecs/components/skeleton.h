#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Characters: a tree of joints, clips that move it, meshes that follow it. A character is one
// entity; its joints are rows of arrays, not entities. What is to hang on a joint - a mesh, a
// light, a camera - is an entity with JointAttachment. Skeletons, clips and skins are kept once, in
// the Assets resource.

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

/// Joints relative to their parents, one entry a joint in each array: matrix = T R S.
struct LocalPose {
    std::vector<Vec3> translations;  ///< [m]
    std::vector<Quat> rotations;     ///< unit
    std::vector<Vec3> scales;

    [[nodiscard]] std::size_t size() const { return rotations.size(); }
};

/// Parents come before their children, so that one pass over the joints finds all matrices
/// (char.skeleton-hierarchy).
struct SkeletonData {
    std::string name;
    std::vector<std::string> joints;    ///< names
    std::vector<std::int32_t> parents;  ///< an earlier joint; -1 of the first, the root
    LocalPose rest;
};

/// How values between two keys follow from them, as glTF has it.
enum class Interpolation : std::uint8_t {
    Step,    ///< the value of the key before
    Linear,  ///< straight; rotations on the great arc (anim.slerp)
    Cubic,   ///< Hermite; three values a key: slope before it, itself, slope after it [1/s]
};

/// Keys at the same times for any number of joints: the rows of one sheet lie next to each other, a
/// row a key, so that a pose is blended from two rows (char.clip-layout). A row of `rotations` has
/// rotating.size() entries, thrice as many if cubic; the same with the others.
struct ClipSheet {
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;                ///< [s], growing
    std::vector<std::uint16_t> rotating;     ///< joints, each once
    std::vector<Quat> rotations;             ///< unit, each near the key before it
    std::vector<std::uint16_t> translating;  ///< joints
    std::vector<Vec3> translations;          ///< [m]
    std::vector<std::uint16_t> scaling;      ///< joints
    std::vector<Vec3> scales;
    std::vector<std::uint16_t> morphing;  ///< morph weights of the character
    std::vector<float> weights;
};

/// What moves a skeleton. A joint that no sheet names rests.
struct ClipData {
    std::string name;
    float duration = 0.0f;  ///< the last of all keys [s]
    std::vector<ClipSheet> sheets;
};

/// Joints that a mesh follows: its joint indices are places in these lists. From the mesh's space
/// at rest into a joint's: the inverse of where the joint was when the mesh was bound to it.
struct SkinData {
    std::string name;
    std::vector<std::uint16_t> joints;    ///< of the skeleton
    std::vector<Affine> joint_from_mesh;  ///< one a joint
};

/// Beside a mesh: which joints move its vertices and by how much. Those of vertex i are entries
/// first[i] .. first[i + 1], any number of them; a vertex without any stays where it is.
struct SkinWeights {
    std::vector<std::uint32_t> first;   ///< one a vertex and one past the last; empty: no skin
    std::vector<std::uint16_t> joints;  ///< places in SkinData::joints
    std::vector<float> weights;         ///< > 0; those of a vertex sum to 1

    [[nodiscard]] bool empty() const { return first.empty(); }
};

/// A shape that a mesh can take on, as differences from it at those vertices that move
/// (char.morph-target).
struct MorphTarget {
    std::string name;
    std::vector<std::uint32_t> vertices;  ///< that move, growing
    std::vector<Vec3> positions;          ///< one a vertex of `vertices` [m]
    std::vector<Vec3> normals;            ///< the same, or empty
    std::vector<Vec3> tangents;           ///< the same, or empty
};

/// One line of what is wrong: lengths that differ, a parent that is no earlier joint, a second
/// root, numbers that are not finite, a rotation of length 0.
[[nodiscard]] Status check_skeleton(const SkeletonData& skeleton);

/// As above: no keys, times that do not grow (with the place of the key), rows of the wrong length,
/// joints beyond `joints`, morph weights beyond `morphs`, one named twice, numbers that are not
/// finite.
[[nodiscard]] Status check_clip(const ClipData& clip, std::size_t joints, std::size_t morphs);

/// As above: an empty list, a joint beyond `joints`, a matrix that is not finite or has no inverse.
[[nodiscard]] Status check_skin(const SkinData& skin, std::size_t joints);

/// Numbers that the clip stores: m (1 + 7 n) for m keys of n joints that turn and move.
[[nodiscard]] std::size_t clip_size(const ClipData& clip);

}  // namespace limn

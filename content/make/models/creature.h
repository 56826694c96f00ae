#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// A procedural fox-like animal: four slender legs, a pointed face, large ears, a bushy tail. Its
// body is one closed surface around 24 joints (implicit_mesh.h) with vertex colors, whose alpha is
// the length of fur (Fur) relative to that of the tail. Eyes and lids are separate closed surfaces.
// In the rest pose it faces +z and stands on y = 0.
//
// Morph targets: "blink" closes the lids, "breath" widens the chest. Clips: "idle", "walk", "run"
// (creature_gait.h), in place: relative to the animal, the ground moves toward -z.

struct CreatureShape {
    float height = 0.45f;
    float detail = 0.009f;
    int triangles = 0;
};

LIMN_FIELDS(CreatureShape) {
    LIMN_FIELD(height, "of the back above ground", "m", 0.01, 100);
    LIMN_FIELD(detail, "triangle size at a height of 0.45 m", "m", 0.004, 0.02);
    LIMN_FIELD(triangles, "target of the simplification; 0 = none", "", 0, 1000000);
}

/// The joints, parents first; those of the left side (+x) before those of the right.
enum class CreatureJoint : std::uint16_t {
    Hips,
    Spine,
    Chest,
    Neck,
    Head,
    Jaw,
    Tail,
    TailTip,
    LeftShoulder,
    LeftElbow,
    LeftWrist,
    LeftPaw,
    RightShoulder,
    RightElbow,
    RightWrist,
    RightPaw,
    LeftThigh,
    LeftKnee,
    LeftHock,
    LeftFoot,
    RightThigh,
    RightKnee,
    RightHock,
    RightFoot,
    Count,
};

inline constexpr std::size_t kCreatureJoints = static_cast<std::size_t>(CreatureJoint::Count);

/// Rest position of a joint at a height of 0.45 m [m].
[[nodiscard]] Vec3 creature_joint(CreatureJoint joint);

/// The parent joint; -1 for the hips.
[[nodiscard]] std::int32_t creature_parent(CreatureJoint joint);

/// With skin weights of at most 4 joints per vertex and the two morph targets.
[[nodiscard]] MeshData make_creature(const CreatureShape& shape);

/// Skeleton, skin and clips of a mesh; the caller names the assets.
struct MeshRig {
    SkeletonData skeleton;
    SkinData skin;
    std::vector<ClipData> clips;
};

[[nodiscard]] MeshRig make_creature_rig(const CreatureShape& shape);

}  // namespace limn

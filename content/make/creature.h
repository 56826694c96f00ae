#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// An animal of the project's own: four slender legs, a pointed face, large ears, a brush of a tail.
// Its body is one closed surface around 24 joints (implicit_mesh.h), colored by the vertex; eyes
// and lids are closed surfaces of their own. It faces +z and stands on y = 0, all joints unturned.
//
// Morph targets: "blink" closes the lids, "breath" widens the chest. Clips: "idle", "walk", "run"
// (creature_gait.h); they run on the spot, the ground under them goes toward -z.

struct CreatureShape {
    float height = 0.45f;   ///< of the back [m], > 0
    float detail = 0.009f;  ///< size of the triangles of a creature of 0.45 m [m]
    int triangles = 0;      ///< > 0: simplified to about so many
};

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

/// Where a joint is at rest in a creature of 0.45 m [m].
[[nodiscard]] Vec3 creature_joint(CreatureJoint joint);

/// The joint above it; -1 of the hips.
[[nodiscard]] std::int32_t creature_parent(CreatureJoint joint);

/// With skin weights of at most 4 joints a vertex and the two morph targets.
[[nodiscard]] MeshData make_creature(const CreatureShape& shape);

/// What moves a mesh; the names of assets are left to whoever keeps them.
struct MeshRig {
    SkeletonData skeleton;
    SkinData skin;
    std::vector<ClipData> clips;
};

[[nodiscard]] MeshRig make_creature_rig(const CreatureShape& shape);

template <typename Visitor>
void visit_fields(CreatureShape& shape, Visitor&& visit) {
    visit("height", shape.height, {.doc = "of the back", .unit = "m", .min = 0.01, .max = 100});
    visit(
        "detail", shape.detail,
        {.doc = "size of the triangles of a creature of 0.45 m",
         .unit = "m",
         .min = 0.004,
         .max = 0.02});
    visit(
        "triangles", shape.triangles,
        {.doc = "if not 0: simplified to about so many", .min = 0, .max = 1000000});
}

}  // namespace limn

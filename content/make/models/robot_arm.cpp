#include "content/make/models/robot_arm.h"

#include "content/make/models/rigid_parts.h"
#include "content/make/models/shapes.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

// Techniques: char.ik-joint-limits

namespace limn {
namespace {

struct ArmJoint {
    const char* name;
    float above;  ///< its parent, at size 1 [m]
    bool across;  ///< turns about x, not y
    float limit;  ///< to both sides [deg]
};

constexpr ArmJoint kArmJoints[] = {
    {"base", 0, false, 0},         {"turn", 0.16f, false, 170},
    {"shoulder", 0.2f, true, 115}, {"upper turn", 0.2f, false, 170},
    {"elbow", 0.2f, true, 120},    {"lower turn", 0.19f, false, 170},
    {"wrist", 0.19f, true, 115},   {"tool turn", 0.1f, false, 175},
};
constexpr std::uint16_t kArmBase = 0;
constexpr std::uint16_t kArmTurn = 1;
constexpr std::uint16_t kArmShoulder = 2;
constexpr std::uint16_t kArmUpperTurn = 3;
constexpr std::uint16_t kArmElbow = 4;
constexpr std::uint16_t kArmLowerTurn = 5;
constexpr std::uint16_t kArmWrist = 6;
constexpr std::uint16_t kArmToolTurn = 7;

const Quat kAlongX = glm::angleAxis(kPi / 2, Vec3(0, 0, -1));  // from +y to +x

SkeletonData make_arm_skeleton(const RobotArmShape& shape) {
    SkeletonData skeleton;
    for (std::size_t i = 0; i < std::size(kArmJoints); ++i) {
        const ArmJoint& joint = kArmJoints[i];
        add_rigid_joint(
            skeleton, joint.name, static_cast<std::int32_t>(i) - 1,
            {0, joint.above * shape.size, 0});
        if (joint.limit > 0) {
            const float limit = radians(joint.limit) * shape.range;
            skeleton.freedoms.push_back(
                {.joint = static_cast<std::uint16_t>(i),
                 .axis = joint.across ? Vec3(1, 0, 0) : Vec3(0, 1, 0),
                 .min = -limit,
                 .max = limit,
                 .middle = 0,
                 .stiffness = joint.across ? 0.2f : 1.0f});
        }
    }
    return skeleton;
}

/// Builds parts of size 1; `size` scales them.
class ArmBuilder {
  public:
    ArmBuilder(const RobotArmShape& shape, MeshData& mesh)
        : shape_(shape), skeleton_(make_arm_skeleton(shape)), mesh_(mesh) {}

    /// A body of revolution about the joint's y axis, or about x if `lies`; its edges are rounded.
    void add_barrel(
        std::uint16_t joint, float from, float to, float radius, float end_radius,
        bool lies = false) {
        const float bevel = std::min(0.18f * std::min(radius, end_radius), 0.3f * (to - from));
        LatheShape lathe;
        lathe.segments = shape_.segments;
        lathe.crease = 1.2f;
        lathe.profile = {{0, from}, {radius - bevel, from}};
        for (const float angle : {0.26f, 0.52f, 0.785f, 1.05f, 1.31f}) {
            lathe.profile.push_back(
                {radius - bevel * (1 - std::sin(angle)), from + bevel * (1 - std::cos(angle))});
        }
        lathe.profile.push_back({radius, from + bevel});
        lathe.profile.push_back({end_radius, to - bevel});
        for (const float angle : {1.31f, 1.05f, 0.785f, 0.52f, 0.26f}) {
            lathe.profile.push_back(
                {end_radius - bevel * (1 - std::sin(angle)), to - bevel * (1 - std::cos(angle))});
        }
        lathe.profile.push_back({end_radius - bevel, to});
        lathe.profile.push_back({0, to});
        add(make_lathe(lathe), {.joint = joint, .rotation = lies ? kAlongX : Quat(1, 0, 0, 0)});
    }

    void add_box(
        std::uint16_t joint, const Vec3& size, const Vec3& position, const Quat& rotation,
        const Vec3& color = Vec3(1)) {
        const BoxShape box = {.size = size, .bevel = 0.004f, .bevel_segments = 2};
        add(make_box(box),
            {.joint = joint, .position = position, .rotation = rotation, .color = color});
    }

    /// A flat sector in a plane across x, from `low` to `high` about its center, 0 being up.
    void add_sector(
        std::uint16_t joint, const Vec3& center, float inner, float outer, float low, float high,
        const Vec3& color) {
        constexpr int kSteps = 48;
        MeshData sector;
        for (const float side : {1.0f, -1.0f}) {
            const auto first = static_cast<std::uint32_t>(sector.positions.size());
            for (int i = 0; i <= kSteps; ++i) {
                const float angle = low + (high - low) * static_cast<float>(i) / kSteps;
                for (const float radius : {inner, outer}) {
                    sector.positions.emplace_back(
                        0.0015f * side, radius * std::cos(angle), radius * std::sin(angle));
                    sector.normals.emplace_back(side, 0, 0);
                    sector.tangents.emplace_back(0, 0, side, 1);
                    sector.uvs.emplace_back(static_cast<float>(i) / kSteps, radius);
                }
            }
            for (std::uint32_t i = 0; i < kSteps; ++i) {
                const std::uint32_t a = first + 2 * i;
                const bool flip = side < 0;
                for (const std::uint32_t corner :
                     {0u, flip ? 2u : 1u, flip ? 1u : 2u, 1u, flip ? 2u : 3u, flip ? 3u : 2u}) {
                    sector.indices.push_back(a + corner);
                }
            }
        }
        add(sector, {.joint = joint, .position = center, .color = color});
    }

    void add(const MeshData& part, RigidPart at) {
        at.position *= shape_.size;
        at.scale *= shape_.size;
        append_rigid(mesh_, skeleton_, part, at);
    }

    [[nodiscard]] float limit(std::uint16_t joint) const {
        return radians(kArmJoints[joint].limit) * shape_.range;
    }

  private:
    const RobotArmShape& shape_;
    SkeletonData skeleton_;
    MeshData& mesh_;
};

void add_shell(ArmBuilder& arm) {
    arm.add_barrel(kArmBase, 0.02f, 0.15f, 0.125f, 0.095f);
    arm.add_barrel(kArmTurn, 0.012f, 0.15f, 0.09f, 0.082f);
    arm.add_barrel(kArmShoulder, -0.088f, 0.088f, 0.082f, 0.082f, true);
    arm.add_barrel(kArmShoulder, 0.05f, 0.188f, 0.072f, 0.066f);
    arm.add_barrel(kArmUpperTurn, 0.012f, 0.16f, 0.066f, 0.062f);
    arm.add_barrel(kArmElbow, -0.074f, 0.074f, 0.068f, 0.068f, true);
    arm.add_barrel(kArmElbow, 0.04f, 0.178f, 0.06f, 0.054f);
    arm.add_barrel(kArmLowerTurn, 0.012f, 0.155f, 0.054f, 0.05f);
    arm.add_barrel(kArmWrist, -0.06f, 0.06f, 0.055f, 0.055f, true);
    arm.add_barrel(kArmWrist, 0.03f, 0.09f, 0.046f, 0.04f);
}

void add_metal(ArmBuilder& arm) {
    arm.add_barrel(kArmBase, 0, 0.022f, 0.15f, 0.145f);
    arm.add_barrel(kArmBase, 0.148f, 0.174f, 0.088f, 0.088f);
    arm.add_barrel(kArmUpperTurn, -0.014f, 0.014f, 0.06f, 0.06f);
    arm.add_barrel(kArmLowerTurn, -0.014f, 0.014f, 0.05f, 0.05f);
    arm.add_barrel(kArmToolTurn, -0.012f, 0.03f, 0.036f, 0.036f);
    for (const auto& [joint, half, radius] :
         {std::tuple(kArmShoulder, 0.096f, 0.06f), std::tuple(kArmElbow, 0.081f, 0.05f),
          std::tuple(kArmWrist, 0.066f, 0.04f)}) {
        arm.add_barrel(joint, -half, half, radius, radius, true);
    }
    const Quat none(1, 0, 0, 0);
    arm.add_box(kArmToolTurn, {0.1f, 0.022f, 0.036f}, {0, 0.04f, 0}, none);
    for (const float side : {1.0f, -1.0f}) {
        arm.add_box(kArmToolTurn, {0.014f, 0.06f, 0.03f}, {0.042f * side, 0.076f, 0}, none);
        arm.add_box(
            kArmToolTurn, {0.012f, 0.055f, 0.026f}, {0.033f * side, 0.122f, 0},
            glm::angleAxis(0.4f * side, Vec3(0, 0, 1)));
    }
}

void add_limits(ArmBuilder& arm) {
    const Vec3 range = {0.1f, 0.75f, 0.25f};
    const Vec3 stop = {1.0f, 0.12f, 0.05f};
    const Vec3 pointer = {1.0f, 0.85f, 0.3f};
    for (const auto& [joint, x, radius] :
         {std::tuple(kArmShoulder, 0.1f, 0.1f), std::tuple(kArmElbow, 0.085f, 0.084f),
          std::tuple(kArmWrist, 0.07f, 0.07f)}) {
        const float limit = arm.limit(joint);
        const auto fixed = static_cast<std::uint16_t>(joint - 1);
        // On the fixed side its range, red at both ends; a pointer on the moving side.
        const Vec3 center = {x, kArmJoints[joint].above, 0};
        const float red = 0.06f;
        arm.add_sector(fixed, center, radius, 1.18f * radius, -limit + red, limit - red, range);
        arm.add_sector(fixed, center, radius, 1.22f * radius, -limit, -limit + red, stop);
        arm.add_sector(fixed, center, radius, 1.22f * radius, limit - red, limit, stop);
        arm.add_sector(
            joint, {x + 0.004f, 0, 0}, 0.5f * radius, 1.15f * radius, -0.05f, 0.05f, pointer);
    }
}

}  // namespace

MeshData make_robot_arm(const RobotArmShape& shape) {
    MeshData mesh;
    ArmBuilder arm(shape, mesh);
    switch (shape.part) {
    case RobotArmPart::Shell:
        add_shell(arm);
        break;
    case RobotArmPart::Metal:
        add_metal(arm);
        break;
    case RobotArmPart::Limits:
        add_limits(arm);
        break;
    }
    finish_rigid(mesh);
    return mesh;
}

MeshRig make_robot_arm_rig(const RobotArmShape& shape) {
    MeshRig rig;
    rig.skeleton = make_arm_skeleton(shape);
    rig.skin = make_rigid_skin(rig.skeleton);
    return rig;
}

}  // namespace limn

#include "content/make/models/mannequin.h"

#include "content/make/models/rigid_parts.h"
#include "content/make/models/shapes.h"
#include "ecs/base/rotation.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr float kFigureHeight = 1.75f;  // at which all lengths below are given [m]
constexpr float kStandTime = 4;         // [s]
constexpr Vec3 kFigureWood = {1, 1, 1};
constexpr Vec3 kFigureBall = {0.72f, 0.66f, 0.6f};  // darker balls

/// Joints of one side; `side` is +1 for the left, which is +x.
struct SideJoints {
    std::uint16_t collar = 0;
    std::uint16_t arm = 0;
    std::uint16_t forearm = 0;
    std::uint16_t hand = 0;
    std::uint16_t thigh = 0;
    std::uint16_t shin = 0;
    std::uint16_t foot = 0;
    std::uint16_t toes = 0;
};

struct FigureJoints {
    std::uint16_t hips = 0;
    std::uint16_t spine = 0;
    std::uint16_t chest = 0;
    std::uint16_t neck = 0;
    std::uint16_t head = 0;
    SideJoints left;
    SideJoints right;
};

SideJoints
add_side_joints(SkeletonData& skeleton, const FigureJoints& body, float side, float scale) {
    const std::string name = side > 0 ? "Left" : "Right";
    const auto add = [&](const char* part, std::uint16_t parent, const Vec3& offset) {
        return add_rigid_joint(
            skeleton, name + part, parent, scale * Vec3(side * offset.x, offset.y, offset.z));
    };
    SideJoints joints;
    joints.collar = add("Shoulder", body.chest, {0.03f, 0.2f, 0});
    joints.arm = add("Arm", joints.collar, {0.16f, 0, 0});
    joints.forearm = add("ForeArm", joints.arm, {0.29f, 0, 0});
    joints.hand = add("Hand", joints.forearm, {0.26f, 0, 0});
    joints.thigh = add("UpLeg", body.hips, {0.095f, -0.06f, 0});
    joints.shin = add("Leg", joints.thigh, {0, -0.42f, 0});
    joints.foot = add("Foot", joints.shin, {0, -0.41f, 0});
    joints.toes = add("ToeBase", joints.foot, {0, -0.055f, 0.13f});
    return joints;
}

void add_freedom(
    SkeletonData& skeleton, std::uint16_t joint, const Vec3& axis, float min, float max) {
    skeleton.freedoms.push_back(
        {.joint = joint,
         .axis = axis,
         .min = radians(min),
         .max = radians(max),
         .middle = radians(0.5f * (min + max)),
         .stiffness = 0.3f});
}

FigureJoints add_figure_joints(SkeletonData& skeleton, float scale) {
    FigureJoints joints;
    const auto add = [&](const char* name, std::int32_t parent, const Vec3& offset) {
        return add_rigid_joint(skeleton, name, parent, scale * offset);
    };
    joints.hips = add("Hips", -1, {0, 0.96f, 0});
    joints.spine = add("Spine", joints.hips, {0, 0.1f, 0});
    joints.chest = add("Chest", joints.spine, {0, 0.16f, 0});
    joints.neck = add("Neck", joints.chest, {0, 0.26f, 0});
    joints.head = add("Head", joints.neck, {0, 0.08f, 0.01f});
    joints.left = add_side_joints(skeleton, joints, 1, scale);
    joints.right = add_side_joints(skeleton, joints, -1, scale);
    for (const std::uint16_t joint : {joints.neck, joints.head}) {
        add_freedom(skeleton, joint, {0, 1, 0}, -50, 50);
        add_freedom(skeleton, joint, {1, 0, 0}, -35, 35);
        add_freedom(skeleton, joint, {0, 0, 1}, -25, 25);
    }
    for (const auto* side : {&joints.left, &joints.right}) {
        const float sign = side == &joints.left ? 1.0f : -1.0f;
        add_freedom(skeleton, side->forearm, {0, -sign, 0}, 0, 145);
        add_freedom(skeleton, side->hand, {0, 0, 1}, -70, 70);
        add_freedom(skeleton, side->hand, {0, 1, 0}, -35, 35);
        add_freedom(skeleton, side->shin, {1, 0, 0}, 0, 150);
    }
    std::stable_sort(
        skeleton.freedoms.begin(), skeleton.freedoms.end(),
        [](const JointFreedom& a, const JointFreedom& b) { return a.joint < b.joint; });
    return joints;
}

/// Adds turned parts to the mesh.
class FigureBuilder {
  public:
    FigureBuilder(const MannequinShape& shape, MeshData& mesh)
        : shape_(shape), scale_(shape.height / kFigureHeight), mesh_(mesh) {
        joints = add_figure_joints(skeleton_, scale_);
    }

    /// A ball about a joint.
    void add_ball(std::uint16_t joint, float radius) {
        SphereShape sphere;
        sphere.radius = radius;
        sphere.segments = shape_.segments;
        sphere.rings = shape_.segments / 2;
        add(make_sphere(sphere), {.joint = joint, .color = kFigureBall});
    }

    /// A turned limb from one point to another, in the space of a joint: radii at equal distances
    /// along it, the ends rounded. `flat`: its depth relative to its width.
    void add_limb(
        std::uint16_t joint, const Vec3& from, const Vec3& to, const std::vector<float>& radii,
        float flat = 1) {
        const float length = glm::distance(from, to);
        LatheShape lathe;
        lathe.segments = shape_.segments;
        lathe.crease = 1.3f;
        lathe.profile.clear();
        const int rows = std::max(7 * shape_.segments / 8, 7);
        for (int i = 0; i <= rows; ++i) {
            // Denser at the ends, where it is round.
            const float u =
                0.5f - 0.5f * std::cos(kPi * static_cast<float>(i) / static_cast<float>(rows));
            lathe.profile.push_back({radius_at(radii, u, length), u * length});
        }
        lathe.profile.front().x = 0;
        lathe.profile.back().x = 0;
        const Vec3 along = (to - from) / length;
        const Quat turn = rotation_from_up(along);
        add(make_lathe(lathe), {.joint = joint,
                                .position = from,
                                .rotation = turn,
                                .scale = {1, 1, flat},
                                .color = kFigureWood});
    }

    void add(const MeshData& part, RigidPart at) {
        at.position *= scale_;
        at.scale *= scale_;
        append_rigid(mesh_, skeleton_, part, at);
    }

    FigureJoints joints;

  private:
    /// Smooth through the radii, and elliptic toward both ends.
    static float radius_at(const std::vector<float>& radii, float u, float length) {
        const float at = u * static_cast<float>(radii.size() - 1);
        const auto first = std::min(static_cast<std::size_t>(at), radii.size() - 2);
        const float t = at - static_cast<float>(first);
        const float radius = std::lerp(radii[first], radii[first + 1], t * t * (3 - 2 * t));
        const float cap = std::min(0.5f, 0.8f * radius / length);
        const float end = std::min(std::min(u, 1 - u) / cap, 1.0f);
        return radius * std::sqrt(std::max(0.0f, 1 - square(1 - end)));
    }

    static Quat rotation_from_up(const Vec3& direction) {
        const Vec3 axis = glm::cross(Vec3(0, 1, 0), direction);
        const float angle = std::atan2(glm::length(axis), direction.y);
        return direction.y < -0.999f ? rotation_about(Vec3(0, 0, 1), kPi)
                                     : rotation_about(axis, angle);
    }

    const MannequinShape& shape_;
    float scale_;
    MeshData& mesh_;
    SkeletonData skeleton_;
};

void add_torso(FigureBuilder& figure) {
    const FigureJoints& at = figure.joints;
    figure.add_limb(at.hips, {0, -0.1f, 0}, {0, 0.085f, 0}, {0.105f, 0.15f, 0.14f, 0.1f}, 0.68f);
    figure.add_ball(at.spine, 0.066f);
    figure.add_limb(at.spine, {0, 0.02f, 0}, {0, 0.14f, 0}, {0.09f, 0.105f, 0.1f}, 0.7f);
    figure.add_ball(at.chest, 0.07f);
    figure.add_limb(
        at.chest, {0, 0.0f, 0}, {0, 0.25f, 0}, {0.09f, 0.13f, 0.165f, 0.15f, 0.06f}, 0.62f);
    figure.add_limb(at.neck, {0, -0.03f, 0}, {0, 0.075f, 0.005f}, {0.05f, 0.044f, 0.042f});
    figure.add_ball(at.head, 0.04f);
    figure.add_limb(
        at.head, {0, -0.035f, 0.025f}, {0, 0.19f, 0.0f}, {0.048f, 0.072f, 0.087f, 0.082f}, 1.15f);
}

void add_figure_side(FigureBuilder& figure, const SideJoints& at, float side) {
    figure.add_ball(at.arm, 0.052f);
    figure.add_limb(
        at.arm, {0.035f * side, 0, 0}, {0.262f * side, 0, 0}, {0.047f, 0.05f, 0.042f, 0.034f});
    figure.add_ball(at.forearm, 0.036f);
    figure.add_limb(
        at.forearm, {0.024f * side, 0, 0}, {0.236f * side, 0, 0}, {0.034f, 0.042f, 0.036f, 0.026f});
    figure.add_ball(at.hand, 0.026f);
    figure.add_limb(
        at.hand, {0.014f * side, 0, 0}, {0.12f * side, 0, 0}, {0.026f, 0.034f, 0.03f}, 1.0f);
    figure.add_limb(
        at.hand, {0.09f * side, 0, 0}, {0.19f * side, -0.004f, 0}, {0.026f, 0.03f, 0.02f}, 1.0f);
    figure.add_limb(
        at.hand, {0.03f * side, -0.004f, 0.02f}, {0.1f * side, -0.01f, 0.07f},
        {0.014f, 0.016f, 0.012f});
    figure.add_ball(at.thigh, 0.075f);
    figure.add_limb(at.thigh, {0, -0.03f, 0}, {0, -0.385f, 0}, {0.076f, 0.085f, 0.068f, 0.054f});
    figure.add_ball(at.shin, 0.055f);
    figure.add_limb(at.shin, {0, -0.03f, 0}, {0, -0.375f, 0}, {0.05f, 0.06f, 0.046f, 0.035f});
    figure.add_ball(at.foot, 0.038f);
    figure.add_limb(
        at.foot, {0, -0.045f, -0.05f}, {0, -0.052f, 0.135f}, {0.038f, 0.044f, 0.044f}, 0.8f);
    figure.add_limb(
        at.toes, {0, -0.002f, -0.01f}, {0, -0.008f, 0.075f}, {0.036f, 0.042f, 0.034f}, 0.7f);
}

/// Arms lowered; chest, head and arms move a little as it breathes.
ClipData make_stand_clip(const FigureJoints& joints, float scale) {
    ClipData clip;
    clip.name = "stand";
    clip.duration = kStandTime;
    ClipSheet sheet;
    sheet.rotating = {joints.chest,        joints.head,      joints.left.arm,
                      joints.left.forearm, joints.right.arm, joints.right.forearm};
    sheet.translating = {joints.hips};
    for (int i = 0; i <= 8; ++i) {
        const float phase = 2 * kPi * static_cast<float>(i) / 8;
        const float breath = std::sin(phase);
        sheet.times.push_back(kStandTime * static_cast<float>(i) / 8);
        sheet.rotations.push_back(rotation_about({1, 0, 0}, -0.015f * breath));
        sheet.rotations.push_back(rotation_about({1, 0, 0}, 0.02f * std::sin(phase - 0.6f)));
        for (const float side : {1.0f, -1.0f}) {
            sheet.rotations.push_back(rotation_about({0, 0, -side}, radians(72) + 0.015f * breath));
            sheet.rotations.push_back(rotation_about({0, -side, 0}, 0.25f));
        }
        sheet.translations.push_back(scale * Vec3(0, 0.96f + 0.003f * breath, 0));
    }
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

}  // namespace

MeshData make_mannequin(const MannequinShape& shape) {
    MeshData mesh;
    FigureBuilder figure(shape, mesh);
    add_torso(figure);
    add_figure_side(figure, figure.joints.left, 1);
    add_figure_side(figure, figure.joints.right, -1);
    finish_rigid(mesh);
    return mesh;
}

MeshRig make_mannequin_rig(const MannequinShape& shape) {
    MeshRig rig;
    const float scale = shape.height / kFigureHeight;
    const FigureJoints joints = add_figure_joints(rig.skeleton, scale);
    rig.skin = make_rigid_skin(rig.skeleton);
    rig.clips.push_back(make_stand_clip(joints, scale));
    return rig;
}

}  // namespace limn

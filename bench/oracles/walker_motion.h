#pragma once

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/foot_pins.h"
#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::oracle {

/// A person's skeleton that faces +z.
struct WalkerShape {
    float thigh = 0.45f;
    float shin = 0.43f;
    float ankle = 0.08f;         ///< height of the ankles above the soles [m]
    float arms = 0.0f;           ///< how far the arms hang down at rest [rad]: 0 is a T-pose
    int back = 2;                ///< joints between hips and neck
    bool has_bone_axes = false;  ///< joints have rotations at rest, as in Blender
    std::array<const char*, 2> sides = {"Left", "Right"};
    std::array<const char*, 7> limbs = {"UpLeg", "Leg",     "Foot", "ToeBase",
                                        "Arm",   "ForeArm", "Hand"};
};

inline SkeletonData make_walker(const WalkerShape& shape = {}) {
    SkeletonData skeleton;
    skeleton.name = "walker";
    std::vector<Vec3> positions;
    const auto add = [&](const std::string& name, std::int32_t parent, const Vec3& position) {
        skeleton.joints.push_back(name);
        skeleton.parents.push_back(parent);
        positions.push_back(position);
        return static_cast<std::int32_t>(skeleton.joints.size()) - 1;
    };
    const float hips = shape.thigh + shape.shin + shape.ankle;
    add("Hips", -1, {0, hips, 0});
    std::int32_t top = 0;
    for (int i = 0; i < shape.back; ++i) {
        const float t = static_cast<float>(i + 1) / static_cast<float>(shape.back);
        top = add("Spine" + (i > 0 ? std::to_string(i) : ""), top, {0, hips + 0.1f + 0.3f * t, 0});
    }
    const std::int32_t neck = add("Neck", top, {0, hips + 0.5f, 0});
    add("Head", neck, {0, hips + 0.6f, 0});
    for (int side = 0; side < 2; ++side) {
        const float sign = side == 0 ? 1.0f : -1.0f;
        const auto name = [&](std::size_t limb) {
            return std::string(shape.sides[static_cast<std::size_t>(side)]) + shape.limbs[limb];
        };
        const std::int32_t thigh = add(name(0), 0, {sign * 0.1f, hips, 0});
        const std::int32_t shin = add(name(1), thigh, {sign * 0.1f, shape.shin + shape.ankle, 0});
        const std::int32_t foot = add(name(2), shin, {sign * 0.1f, shape.ankle, 0});
        add(name(3), foot, {sign * 0.1f, 0.02f, 0.15f});
        const Vec3 along(sign * std::cos(shape.arms), -std::sin(shape.arms), 0);
        const Vec3 shoulder(sign * 0.2f, hips + 0.45f, 0);
        const std::int32_t arm = add(name(4), top, shoulder);
        const std::int32_t forearm = add(name(5), arm, shoulder + 0.28f * along);
        add(name(6), forearm, shoulder + 0.53f * along);
    }
    std::vector<Quat> rotations(positions.size(), Quat(1, 0, 0, 0));
    for (std::size_t j = 0; j < positions.size(); ++j) {
        if (shape.has_bone_axes && j > 0) {
            const auto number = static_cast<float>(j);
            rotations[j] = rotation_about({std::sin(number), std::cos(number), 1}, 2 + number);
        }
        const std::int32_t parent = skeleton.parents[j];
        const auto p = static_cast<std::size_t>(std::max(parent, 0));
        const Quat back = parent < 0 ? Quat(1, 0, 0, 0) : glm::conjugate(rotations[p]);
        skeleton.rest.rotations.push_back(back * rotations[j]);
        skeleton.rest.translations.push_back(
            parent < 0 ? positions[j] : back * (positions[j] - positions[p]));
        skeleton.rest.scales.emplace_back(1);
    }
    return skeleton;
}

/// Walks along +z, each foot planted for 60 % of its step; 60 frames per second. The arms swing.
struct RecordedWalk {
    SkeletonMotion motion;
    std::vector<ClipContact> plants;  ///< of both ankles
    float stride = 0;                 ///< that a foot moves from plant to plant [m]
    float lift = 0;                   ///< height of a flight above the plants [m]
};

inline RecordedWalk
make_walk(const SkeletonData& skeleton, float seconds = 3.0f, float lift = 0.1f) {
    constexpr float kRate = 60;
    constexpr float kCycle = 1.0f;   // [s]
    constexpr float kFlight = 0.4f;  // of the cycle
    const BodyJoints body = find_body_joints(skeleton);
    const float leg = find_leg_length(skeleton, body);
    RecordedWalk walk;
    walk.stride = 1.2f * leg;
    walk.lift = lift;
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    MotionFrames frames;
    frames.rate = kRate;
    frames.joints = skeleton.joints.size();
    const auto count = static_cast<std::size_t>(seconds * kRate) + 1;
    for (std::size_t f = 0; f < count; ++f) {
        const LocalPose& pose = skeleton.rest;
        frames.translations.insert(
            frames.translations.end(), pose.translations.begin(), pose.translations.end());
        frames.rotations.insert(
            frames.rotations.end(), pose.rotations.begin(), pose.rotations.end());
        frames.scales.insert(frames.scales.end(), pose.scales.begin(), pose.scales.end());
        const float cycle = static_cast<float>(f) / kRate / kCycle;
        move_joint(
            skeleton, frames, f, find_body_root(skeleton, body),
            {0, -0.12f * leg, walk.stride * (cycle - 0.3f)});
        for (int side = 0; side < 2; ++side) {
            const auto part = [&](BodyPart left, BodyPart right) {
                return body[side == 0 ? left : right];
            };
            const std::uint16_t foot = part(BodyPart::LeftFoot, BodyPart::RightFoot);
            const float phase = cycle + 0.5f * static_cast<float>(side);
            const float step = std::floor(phase);
            const float u = std::max((phase - step - (1 - kFlight)) / kFlight, 0.0f);
            const float ease = u * u * (3 - 2 * u);
            Vec3 target = transform_point(rest[foot], Vec3(0));
            target.y += lift * 16 * u * u * (1 - u) * (1 - u);
            target.z += walk.stride * (step + ease - 0.5f * static_cast<float>(side));
            reach_with_limb(
                skeleton, frames, f,
                {part(BodyPart::LeftThigh, BodyPart::RightThigh),
                 part(BodyPart::LeftShin, BodyPart::RightShin), foot},
                target, {1, 0, 0});
            const std::uint16_t arm = part(BodyPart::LeftUpperArm, BodyPart::RightUpperArm);
            Quat& swing = frames.rotations[f * frames.joints + arm];
            swing = swing * rotation_about({0, 0, 1}, 0.4f * std::sin(2 * kPi * phase));
        }
    }
    walk.motion.skeleton = skeleton;
    walk.motion.clip.name = "walk";
    walk.motion.clip = make_frames_clip(skeleton, frames, walk.motion.clip);
    for (int side = 0; side < 2; ++side) {
        const std::uint16_t foot = body[side == 0 ? BodyPart::LeftFoot : BodyPart::RightFoot];
        for (float step = 0; step < seconds + 1; step += 1) {
            const float begin = std::max(step - 0.5f * static_cast<float>(side), 0.0f);
            const float end = std::min(
                step - 0.5f * static_cast<float>(side) + (1 - kFlight) * kCycle,
                walk.motion.clip.duration);
            if (end > begin) {
                walk.plants.push_back({foot, begin, end});
            }
        }
    }
    std::ranges::stable_sort(walk.plants, {}, &ClipContact::begin);
    return walk;
}

}  // namespace limn::oracle

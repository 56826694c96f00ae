#pragma once

#include "ecs/base/rotation.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/walk/walk_plan.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::test {

/// A person of 17 joints that faces +z with arms out, its soles at a height of 0. `scale`: of all
/// lengths; `has_bone_axes`: joints have rotations at rest, as in Blender.
inline SkeletonData make_stick_person(float scale = 1, bool has_bone_axes = false) {
    SkeletonData skeleton;
    skeleton.name = "stick person";
    std::vector<Vec3> places;
    const auto add = [&](const std::string& name, std::int32_t parent, const Vec3& place) {
        skeleton.joints.push_back(name);
        skeleton.parents.push_back(parent);
        places.push_back(scale * place);
        return static_cast<std::int32_t>(places.size()) - 1;
    };
    const std::int32_t hips = add("Hips", -1, {0, 0.95f, 0});
    const std::int32_t spine = add("Spine", hips, {0, 1.05f, 0});
    const std::int32_t chest = add("Chest", spine, {0, 1.2f, 0});
    add("Head", chest, {0, 1.5f, 0});
    for (const float side : {1.0f, -1.0f}) {
        const std::string name = side > 0 ? "Left" : "Right";
        const std::int32_t thigh = add(name + "UpLeg", hips, {0.1f * side, 0.9f, 0});
        const std::int32_t shin = add(name + "Leg", thigh, {0.1f * side, 0.48f, 0.005f});
        const std::int32_t foot = add(name + "Foot", shin, {0.1f * side, 0.08f, -0.01f});
        add(name + "ToeBase", foot, {0.105f * side, 0.02f, 0.13f});
        const std::int32_t arm = add(name + "Arm", chest, {0.19f * side, 1.4f, 0});
        const std::int32_t fore = add(name + "ForeArm", arm, {0.48f * side, 1.4f, 0});
        add(name + "Hand", fore, {0.73f * side, 1.4f, 0});
    }
    std::vector<Quat> turns(places.size(), Quat(1, 0, 0, 0));
    for (std::size_t j = 0; j < places.size(); ++j) {
        if (has_bone_axes) {
            const auto number = static_cast<float>(j);
            turns[j] = rotation_about({std::sin(number), std::cos(number), 1}, 1.5f + number);
        }
        const std::int32_t parent = skeleton.parents[j];
        const auto p = static_cast<std::size_t>(parent < 0 ? 0 : parent);
        const Quat back = parent < 0 ? Quat(1, 0, 0, 0) : glm::conjugate(turns[p]);
        skeleton.rest.rotations.push_back(back * turns[j]);
        skeleton.rest.translations.push_back(
            parent < 0 ? places[j] : back * (places[j] - places[p]));
        skeleton.rest.scales.emplace_back(1);
    }
    return skeleton;
}

/// A walking character without a world.
struct WalkTrial {
    SkeletonData skeleton;
    Walk walk = {};
    MoveIntent intent = {};
    WalkBody body = {};
    WalkState state = {};
    Transform transform = {};
    LocalPose pose = {};

    explicit WalkTrial(const Walk& style = {}, SkeletonData person = make_stick_person())
        : skeleton(std::move(person)), walk(style), body(find_walk_body(skeleton)) {
        intent.velocity = {0, 0, walk.speed};
        step(0);
    }

    void step(float dt) {
        step_walk(walk, intent, body, std::nullopt, dt, state, transform);
        body.targets = find_walk_targets(body, state, transform);
        pose = skeleton.rest;
        apply_walk(skeleton, walk, state, body, pose);
    }
    void run(float seconds, float dt = 1.0f / 60) {
        const int count = static_cast<int>(std::round(seconds / dt));
        for (int i = 0; i < count; ++i) {
            step(dt);
        }
    }

    [[nodiscard]] float leg() const { return leg_length(body); }
    /// In the space of the character.
    [[nodiscard]] JointPlace place(std::uint16_t joint) const {
        return find_place(skeleton, pose, joint);
    }
    [[nodiscard]] Vec3 world(const Vec3& point) const {
        return transform.position + transform.rotation * (transform.scale * point);
    }
    /// A point that at rest is at `offset` from the ground below an ankle.
    [[nodiscard]] Vec3 foot_point(std::size_t side, const Vec3& offset) const {
        const WalkLeg& at = body.legs[side];
        const Quat rest = find_place(skeleton, skeleton.rest, at.foot).rotation;
        const JointPlace foot = place(at.foot);
        return world(foot.position + foot.rotation * (glm::conjugate(rest) * (offset - at.ankle)));
    }
    [[nodiscard]] Vec3 toe(std::size_t side) const {
        return foot_point(side, body.legs[side].ball);
    }
    [[nodiscard]] Vec3 heel(std::size_t side) const {
        return foot_point(side, body.legs[side].heel);
    }
    /// Height of the lower one of heel and ball above where they are in a flat foot.
    [[nodiscard]] float clearance(std::size_t side) const {
        return std::min(heel(side).y, toe(side).y - body.legs[side].ball.y);
    }
    [[nodiscard]] bool is_flying(std::size_t side) const {
        return state.flying == side && state.step < kFlightShare;
    }
    /// Whether the toes do not move: neither in flight nor while the foot rolls off its heel.
    [[nodiscard]] bool is_planted(std::size_t side) const { return state.flying != side; }
    /// Bend of a knee, 0: straight [rad]; negative: the wrong way.
    [[nodiscard]] float knee(std::size_t side) const {
        const WalkLeg& at = body.legs[side];
        const Vec3 hip = place(at.thigh).position;
        const Vec3 middle = place(at.shin).position;
        const Vec3 upper = middle - hip;
        const Vec3 lower = place(at.foot).position - middle;
        const Vec3 hinge = place(body.hips).rotation
                           * glm::conjugate(find_place(skeleton, skeleton.rest, body.hips).rotation)
                           * body.targets.left;
        const Vec3 bend = glm::cross(upper, lower);
        return std::copysign(
            std::atan2(glm::length(bend), glm::dot(upper, lower)), glm::dot(bend, hinge));
    }
};

}  // namespace limn::test

#pragma once

// A person of 20 joints that physics moves, in a world of its own.

#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "systems/animation/ragdoll/ragdoll_rig.h"
#include "systems/update_world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::ragdoll_test {

struct PersonJoint {
    const char* name;
    int parent;
    Vec3 offset;
};

/// 1.75 m high, arms stretched out.
inline SkeletonData make_person() {
    const PersonJoint joints[] = {
        {"Hips", -1, {0, 0.96f, 0}},
        {"Spine", 0, {0, 0.1f, 0}},
        {"Chest", 1, {0, 0.16f, 0}},
        {"Neck", 2, {0, 0.26f, 0}},
        {"Head", 3, {0, 0.08f, 0.01f}},
        {"LeftShoulder", 2, {0.03f, 0.2f, 0}},
        {"LeftArm", 5, {0.16f, 0, 0}},
        {"LeftForeArm", 6, {0.29f, 0, 0}},
        {"LeftHand", 7, {0.26f, 0, 0}},
        {"LeftUpLeg", 0, {0.095f, -0.06f, 0}},
        {"LeftLeg", 9, {0, -0.42f, 0}},
        {"LeftFoot", 10, {0, -0.41f, 0}},
        {"RightShoulder", 2, {-0.03f, 0.2f, 0}},
        {"RightArm", 12, {-0.16f, 0, 0}},
        {"RightForeArm", 13, {-0.29f, 0, 0}},
        {"RightHand", 14, {-0.26f, 0, 0}},
        {"RightUpLeg", 0, {-0.095f, -0.06f, 0}},
        {"RightLeg", 16, {0, -0.42f, 0}},
        {"RightFoot", 17, {0, -0.41f, 0}},
        {"HeadEnd", 4, {0, 0.2f, 0}}};
    SkeletonData skeleton;
    skeleton.name = "person";
    for (const PersonJoint& joint : joints) {
        skeleton.joints.emplace_back(joint.name);
        skeleton.parents.push_back(joint.parent);
        skeleton.rest.translations.push_back(joint.offset);
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1, 1, 1);
    }
    return skeleton;
}

/// Arms lowered; the left one swings to and fro.
inline ClipData make_swing() {
    ClipData clip;
    clip.name = "swing";
    clip.duration = 2;
    ClipSheet sheet;
    sheet.rotating = {6, 13};
    for (int i = 0; i <= 8; ++i) {
        const float angle = 0.8f * std::sin(kPi * static_cast<float>(i) / 4);
        sheet.times.push_back(0.25f * static_cast<float>(i));
        sheet.rotations.push_back(
            rotation_about({0, 0, 1}, -1.2f) * rotation_about({0, 1, 0}, angle));
        sheet.rotations.push_back(rotation_about({0, 0, 1}, 1.2f));
    }
    clip.sheets.push_back(sheet);
    return clip;
}

struct Stage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity person;
    SkeletonData skeleton;

    explicit Stage(
        const Ragdoll& ragdoll = {.active = true}, const Transform& place = {},
        const SkeletonData& body = make_person())
        : skeleton(body) {
        register_all_components();
        Assets assets;
        assets.skeletons.push_back(body);
        assets.clips.push_back(make_swing());
        world.insert_resource(std::move(assets));
        person = world.create(place, Skeleton{{0}}, ragdoll);
    }
    void add_floor(float height = 0) {
        world.create(Transform{.position = {0, height, 0}}, Walkable{});
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    const RagdollState& state() { return world.get<const RagdollState>(person); }
    Ragdoll& ragdoll() { return world.get<Ragdoll>(person); }
    Vec3 joint(std::size_t index) {
        return transform_point(
            world.get<const WorldTransform>(person).world,
            transform_point(world.get<const Pose>(person).joints[index], Vec3(0)));
    }
    /// Height of the lowest point of all capsules.
    float lowest() {
        const RagdollRig rig = make_ragdoll_rig(skeleton);
        float low = INFINITY;
        for (std::size_t i = 0; i < rig.bones.size(); ++i) {
            const RagdollBone& bone = rig.bones[i];
            const Vec3 half = 0.5f * (state().rotations[i] * (bone.to - bone.from));
            low = std::min(low, state().positions[i].y - std::abs(half.y) - bone.radius);
        }
        return low;
    }
    float fastest() {
        float speed = 0;
        for (const Vec3& velocity : state().velocities) {
            speed = std::max(speed, glm::length(velocity));
        }
        return speed;
    }
};

}  // namespace limn::ragdoll_test

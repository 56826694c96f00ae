#include "systems/animation/walk/activity_clip.h"

#include "ecs/base/limb_reach.h"
#include "ecs/base/repeatable_math.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/shoulder_girdle.h"
#include "systems/animation/walk/walk_body.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

// Techniques: char.crowd-script

namespace limn {
namespace {

constexpr std::size_t kKeys = 33;
constexpr std::uint16_t kNone = 0xffff;

/// A person that takes a pose, in the space of the character.
struct Actor {
    const SkeletonData& skeleton;
    WalkBody body;
    Vec3 ahead;
    Vec3 left;
    LocalPose pose = {};

    [[nodiscard]] Quat rotation(std::int32_t joint) const {
        return find_place(skeleton, pose, joint).rotation;
    }
    [[nodiscard]] Vec3 position(std::uint16_t joint) const {
        return find_place(skeleton, pose, joint).position;
    }
    /// Turns a joint, and what hangs from it, in the space of the character.
    void turn(std::uint16_t joint, const Quat& by) {
        if (joint != kNone) {
            const Quat parent = rotation(skeleton.parents[joint]);
            Quat& local = pose.rotations[joint];
            local = normalize_or_identity(glm::conjugate(parent) * by * parent * local);
        }
    }
    /// Turns a joint so that its bone to `child` points there.
    void aim(std::uint16_t joint, std::uint16_t child, const Vec3& direction) {
        const Vec3 from = normalize_or(position(child) - position(joint), {0, -1, 0});
        turn(joint, shortest_arc(from, normalize_or(direction, from)));
    }
    void nod(float angle, float yaw) {
        turn(body.head, rotation_about(Vec3(0, 1, 0), yaw) * rotation_about(left, angle));
    }
    void lean(float angle) {
        if (body.spine != kNone) {
            turn(body.spine, rotation_about(left, angle));
        }
    }
};

/// sin(2 pi cycles phase).
float wave(float phase, float cycles, float offset = 0) {
    const float turns = cycles * phase + offset;
    return repeatable_cos_sin(2 * kPi * (turns - std::floor(turns))).y;
}

/// Of upper arm and forearm, by how far they are out to their side, ahead and up.
struct ArmPose {
    Vec3 upper;
    Vec3 fore;
};

ArmPose mix(const ArmPose& a, const ArmPose& b, float u) {
    return {glm::mix(a.upper, b.upper, u), glm::mix(a.fore, b.fore, u)};
}

void place_arm(Actor& actor, std::size_t i, const ArmPose& wanted) {
    const WalkArm& arm = actor.body.arms[i];
    if (arm.upper == kNone || arm.fore == kNone) {
        return;
    }
    const Vec3 out = i == 0 ? actor.left : -actor.left;
    const auto direction = [&](const Vec3& v) {
        return v.x * out + v.y * actor.ahead + v.z * Vec3(0, 1, 0);
    };
    actor.aim(arm.upper, arm.fore, direction(wanted.upper));
    // The bone of the forearm is known by its direction at rest.
    const Quat turned =
        actor.rotation(arm.fore)
        * glm::conjugate(find_place(actor.skeleton, actor.skeleton.rest, arm.fore).rotation);
    const Vec3 from = turned * arm.fore_way;
    actor.turn(arm.fore, shortest_arc(from, normalize_or(direction(wanted.fore), from)));
    raise_collar(actor.skeleton, {arm.collar, arm.upper, arm.fore}, 1, actor.pose);
}

constexpr ArmPose kHanging = {{0.16f, 0.04f, -1}, {0.1f, 0.28f, -1}};

void stand(Actor& actor, float phase) {
    actor.lean(0.012f * wave(phase, 2));
    actor.nod(0.03f * wave(phase, 2, 0.4f), 0.12f * wave(phase, 1));
    for (std::size_t i = 0; i < 2; ++i) {
        ArmPose arm = kHanging;
        arm.upper.x += 0.012f * wave(phase, 2);
        place_arm(actor, i, arm);
    }
}

void talk(Actor& actor, float phase) {
    actor.lean(0.03f * wave(phase, 1));
    actor.nod(0.07f * wave(phase, 3), 0.14f * wave(phase, 1, 0.3f));
    for (std::size_t i = 0; i < 2; ++i) {
        const float offset = i == 0 ? 0.0f : 0.37f;
        const float raised = std::clamp(0.55f + 0.8f * wave(phase, 1, offset), 0.1f, 1.0f);
        const float beat = wave(phase, 4, offset);
        const ArmPose gesture = {
            {0.2f, 0.22f, -1}, {0.2f + 0.25f * beat, 1, -0.05f + 0.3f * wave(phase, 3, offset)}};
        place_arm(actor, i, mix(kHanging, gesture, raised));
    }
}

void sit(Actor& actor, float phase) {
    const WalkBody& body = actor.body;
    float height = -INFINITY;
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkLeg& leg = body.legs[i];
        const Quat sole = actor.rotation(leg.foot);
        actor.aim(leg.thigh, leg.shin, actor.ahead + (i == 0 ? 0.12f : -0.12f) * actor.left);
        actor.aim(leg.shin, leg.foot, Vec3(0, -1, 0) - 0.05f * actor.ahead);
        actor.turn(leg.foot, sole * glm::conjugate(actor.rotation(leg.foot)));
        height = std::max(height, leg.ankle.y - actor.position(leg.foot).y);
    }
    const std::int32_t above = actor.skeleton.parents[body.hips];
    actor.pose.translations[body.hips] +=
        glm::conjugate(actor.rotation(above)) * Vec3(0, height, 0);
    actor.lean(0.04f + 0.015f * wave(phase, 2));
    actor.nod(0.04f * wave(phase, 2, 0.4f), 0.3f * wave(phase, 1));
    for (std::size_t i = 0; i < 2; ++i) {
        place_arm(actor, i, {{0.16f, 0.3f, -1}, {-0.1f, 1, -0.5f}});
    }
}

void greet(Actor& actor, float phase) {
    stand(actor, phase);
    place_arm(actor, 1, {{0.85f, 0.35f, 0.3f}, {0.15f + 0.5f * wave(phase, 2), 0.25f, 1}});
}

void act(CrowdActivity activity, float phase, Actor& actor) {
    switch (activity) {
    case CrowdActivity::Stand:
        return stand(actor, phase);
    case CrowdActivity::Talk:
        return talk(actor, phase);
    case CrowdActivity::Sit:
        return sit(actor, phase);
    case CrowdActivity::Wave:
        return greet(actor, phase);
    }
}

float activity_duration(CrowdActivity activity) {
    return activity == CrowdActivity::Wave ? 1.2f : activity == CrowdActivity::Talk ? 5.0f : 6.0f;
}

}  // namespace

ClipData make_activity_clip(const SkeletonData& skeleton, CrowdActivity activity) {
    Actor actor = {skeleton, find_walk_body(skeleton), {}, {}};
    const Vec2 heading = repeatable_cos_sin(actor.body.heading);
    actor.ahead = {heading.y, 0, heading.x};
    actor.left = {heading.x, 0, -heading.y};
    ClipData clip;
    clip.name = "activity";
    clip.duration = activity_duration(activity);
    ClipSheet sheet;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        sheet.rotating.push_back(static_cast<std::uint16_t>(j));
    }
    sheet.translating = {actor.body.hips};
    for (std::size_t key = 0; key < kKeys; ++key) {
        const float phase = static_cast<float>(key % (kKeys - 1)) / static_cast<float>(kKeys - 1);
        actor.pose = skeleton.rest;
        if (actor.body.can_walk) {
            act(activity, phase, actor);
        }
        const std::size_t before = sheet.rotations.size();
        for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
            const Quat& q = actor.pose.rotations[j];
            sheet.rotations.push_back(
                key > 0 ? to_same_hemisphere(sheet.rotations[before - actor.pose.size() + j], q)
                        : q);
        }
        sheet.translations.push_back(actor.pose.translations[actor.body.hips]);
        sheet.times.push_back(
            clip.duration * static_cast<float>(key) / static_cast<float>(kKeys - 1));
    }
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

}  // namespace limn

#include "systems/animation/walk/walk_clip.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"

#include <algorithm>
#include <cmath>

// Techniques: char.crowd-script

namespace limn {
namespace {

constexpr float kSettleTime = 8.0f;         // until each cycle is like the last [s]
constexpr float kBakeStep = 1.0f / 120.0f;  // longest [s]

/// Someone who walks straight ahead.
struct BakedWalker {
    const SkeletonData& skeleton;
    const Walk& walk;
    WalkBody body;
    MoveIntent intent = {};
    WalkState state = {};
    Transform transform = {};

    void step(float dt) { step_walk(walk, intent, body, std::nullopt, dt, state, transform); }
    void pose(LocalPose& pose) {
        body.targets = find_walk_targets(body, state, transform);
        pose = skeleton.rest;
        apply_walk(skeleton, walk, state, body, pose);
    }
};

void append_key(float time, const LocalPose& pose, ClipSheet& sheet) {
    const std::size_t before = sheet.rotations.size();
    sheet.times.push_back(time);
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const Quat& q = pose.rotations[j];
        sheet.rotations.push_back(
            before > 0 ? to_same_hemisphere(sheet.rotations[before - pose.size() + j], q) : q);
    }
    sheet.translations.insert(
        sheet.translations.end(), pose.translations.begin(), pose.translations.end());
}

}  // namespace

float walk_clip_speed(const SkeletonData& skeleton, const Walk& walk) {
    const float leg = std::max(leg_length(find_walk_body(skeleton)), 1e-3f);
    return std::min(effective_walk(walk).speed, max_walk_speed(leg));
}

ClipData make_walk_clip(const SkeletonData& skeleton, const Walk& walk, std::size_t keys) {
    LIMN_CHECK(keys >= 2);
    BakedWalker walker = {skeleton, walk, find_walk_body(skeleton)};
    const float leg = std::max(leg_length(walker.body), 1e-3f);
    const float speed = walk_clip_speed(skeleton, walk);
    const Walk style = effective_walk(walk);
    const float cycle = find_stride(style, leg, speed).duration;
    const float left = step_duration(style, 0, cycle);
    const float right = step_duration(style, 1, cycle);
    const float duration = left + right;
    const float key_step = duration / static_cast<float>(keys - 1);
    const auto substeps = static_cast<std::size_t>(std::ceil(key_step / kBakeStep));
    const float dt = key_step / static_cast<float>(substeps);
    walker.intent.velocity = speed * heading_direction(walker.body.heading);
    for (float time = 0; time < kSettleTime; time += dt) {
        walker.step(dt);
    }
    // On to the lift-off of the left foot.
    for (float time = 0; time < 2 * duration && walker.state.flying == 0; time += dt) {
        walker.step(dt);
    }
    for (float time = 0; time < 2 * duration && walker.state.flying != 0; time += dt) {
        walker.step(dt);
    }
    ClipData clip;
    clip.name = "walk";
    clip.duration = duration;
    ClipSheet sheet;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        sheet.rotating.push_back(static_cast<std::uint16_t>(j));
        sheet.translating.push_back(static_cast<std::uint16_t>(j));
    }
    LocalPose pose;
    LocalPose first;
    for (std::size_t key = 0; key + 1 < keys; ++key) {
        walker.pose(pose);
        first = key == 0 ? pose : first;
        append_key(static_cast<float>(key) * key_step, pose, sheet);
        for (std::size_t i = 0; i < substeps; ++i) {
            walker.step(dt);
        }
    }
    append_key(duration, first, sheet);
    clip.sheets.push_back(std::move(sheet));
    clip.events = {{"step", kFlightShare * left}, {"step", left + kFlightShare * right}};
    return clip;
}

}  // namespace limn

#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/components/surface.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/walk/crowd_walk_system.h"
#include "systems/animation/walk/walk_clip.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::crowd_walk_test {

using namespace limn::test;

namespace {

std::vector<Affine> joints_at(const SkeletonData& skeleton, const ClipData& clip, float time) {
    LocalPose scratch;
    std::vector<Affine> joints(skeleton.joints.size());
    evaluate_pose(skeleton, &clip, time, scratch, joints, {});
    return joints;
}

float largest_distance(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    float largest = 0;
    for (std::size_t j = 0; j < a.size(); ++j) {
        largest = std::max(
            largest, glm::distance(transform_point(a[j], Vec3(0)), transform_point(b[j], Vec3(0))));
    }
    return largest;
}

std::vector<Walk> crowd_styles() {
    Walk tired;
    tired.tiredness = 0.7f;
    Walk limping;
    limping.right = {.hip = 0.4f, .knee = 0.3f, .ankle = 0.5f};
    return {{}, tired, limping};
}

}  // namespace

TEST_CASE(
    "walk clip: it is the live walk at its key times to 1e-4, and ends as it begins"
    * technique("char.crowd-script")) {
    constexpr std::size_t kKeys = 25;
    for (const Walk& style : crowd_styles()) {
        WalkTrial trial(style);
        const ClipData clip = make_walk_clip(trial.skeleton, style, kKeys);
        const std::vector<Affine> first = joints_at(trial.skeleton, clip, 0);
        CHECK(check_clip(clip, trial.skeleton.joints.size(), 0).ok());
        CHECK(largest_distance(first, joints_at(trial.skeleton, clip, clip.duration)) < 1e-6f);
        // The live walk is stepped as the clip was, and compared in a later cycle.
        trial.intent.velocity = {0, 0, walk_clip_speed(trial.skeleton, style)};
        const float key_step = clip.duration / (kKeys - 1);
        const float substeps = std::ceil(key_step * 120);
        const float step = key_step / substeps;
        trial.transform = {};
        trial.state = {};
        for (float time = 0; time < 8; time += step) {
            trial.step(step);
        }
        while (trial.state.flying == 0) {
            trial.step(step);
        }
        while (trial.state.flying != 0) {
            trial.step(step);
        }
        float error = 0;
        for (std::size_t key = 0; key < 2 * (kKeys - 1); ++key) {
            std::vector<Affine> live(trial.skeleton.joints.size());
            compute_joint_matrices(trial.skeleton, trial.pose, live);
            const float time = clip.sheets[0].times[key % (kKeys - 1)];
            error = std::max(error, largest_distance(live, joints_at(trial.skeleton, clip, time)));
            for (int i = 0; i < static_cast<int>(substeps); ++i) {
                trial.step(step);
            }
        }
        CHECK(error < 1e-4f);
    }
}

TEST_CASE(
    "walk clip: m keys of n joints are m (1 + 7 n) numbers, feet on the ground move back as the "
    "crowd moves ahead"
    * technique("char.crowd-script")) {
    const SkeletonData skeleton = make_stick_person();
    const ClipData clip = make_walk_clip(skeleton, {}, 33);
    CHECK(clip_size(clip) == 33 * (1 + 7 * skeleton.joints.size()));
    CHECK(clip.events.size() == 2);
    // The left foot, from its landing and roll to the end of the step in which the other one flies.
    const float speed = walk_clip_speed(skeleton, {});
    const WalkBody body = find_walk_body(skeleton);
    float slide = 0;
    Vec3 planted(0);
    for (int i = 0; i <= 20; ++i) {
        const float time = clip.duration * (0.5f + 0.49f * static_cast<float>(i) / 20);
        const auto joints = joints_at(skeleton, clip, time);
        const Vec3 toe =
            transform_point(joints[body.legs[0].toes], Vec3(0)) + Vec3(0, 0, speed * time);
        planted = i == 0 ? toe : planted;
        slide = std::max(slide, glm::distance(toe, planted));
    }
    CHECK(slide < 2e-3f);
}

TEST_CASE("crowd walk: members of a style share a clip, each at its own phase and speed") {
    World world;
    Schedule schedule = make_world_schedule();
    Assets assets;
    assets.skeletons.push_back(make_stick_person());
    world.insert_resource(std::move(assets));
    Walk slow;
    slow.speed = 0.8f;
    const Entity stroll = world.create(Walk{});
    const Entity tired = world.create(slow);
    std::vector<Entity> crowd;
    for (int i = 0; i < 40; ++i) {
        crowd.push_back(world.create(
            Transform{}, Skeleton{{0}},
            CrowdWalk{
                .style = i % 2 == 0 ? stroll : tired,
                .phase = static_cast<float>(i / 4) / 10,
                .speed = i % 2 == 0 ? 0.65f : 0.0f}));
    }
    step_world(world, schedule);
    step_world(world, schedule);
    const auto& clips = world.resource<Assets>().clips;
    CHECK(clips.size() == 2);
    const auto& player = [&](int i) -> const ClipPlayer& {
        return world.get<const ClipPlayer>(crowd[static_cast<std::size_t>(i)]);
    };
    CHECK(player(0).clip == player(2).clip);
    CHECK(player(0).clip != player(1).clip);
    CHECK(player(0).speed == near(0.5).epsilon(1e-3));
    CHECK(player(1).speed == 1);
    CHECK(player(8).time - player(0).time == near(0.2 * clips[0].duration).epsilon(1e-3));
    const auto joints = [&](int i) {
        return world.get<const Pose>(crowd[static_cast<std::size_t>(i)]).joints;
    };
    CHECK(largest_distance(joints(0), joints(2)) == 0);  // the same style and phase
    CHECK(largest_distance(joints(0), joints(8)) > 0.1f);
}

}  // namespace limn::crowd_walk_test

#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace limn::pose_ik_test {

using namespace limn::test;

namespace {

Vec3 position_of(const SkeletonData& skeleton, const LocalPose& pose, std::int32_t joint) {
    return find_place(skeleton, pose, joint).position;
}

/// Five joints of 1 m, of which the third is a hinge about x; a clip turns the second one.
SkeletonData make_arm() {
    SkeletonData skeleton = make_chain(5);
    skeleton.freedoms = {{.joint = 3, .axis = {1, 0, 0}, .min = 0, .max = 2.6f}};
    return skeleton;
}

struct Stage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity character;
    Entity lamp;

    explicit Stage(const IkChain& chain) {
        Assets assets;
        assets.skeletons.push_back(make_arm());
        assets.clips.push_back(make_turn({0, 1, 2}, {-20, 20, -20}, 1));
        world.insert_resource(std::move(assets));
        lamp = world.create(Transform{.position = {1.2f, 3, 0.5f}});
        IkRig rig;
        rig.chains.push_back(chain);
        rig.chains[0].tip = "joint 4";
        rig.chains[0].goal = lamp;
        character = world.create(
            Transform{.position = {0, 1, 0}, .rotation = rotation_about({0, 1, 0}, 0.5f)},
            Skeleton{{0}}, ClipPlayer{.clip = {0}}, rig);
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    Vec3 tip() {
        const Affine& place = world.get<const WorldTransform>(character).world;
        return transform_point(
            place, transform_point(world.get<const Pose>(character).joints[4], Vec3(0)));
    }
    float distance() { return glm::distance(tip(), world.get<const Transform>(lamp).position); }
};

constexpr IkSolver kSolvers[] = {IkSolver::TwoLink, IkSolver::Jacobian, IkSolver::Ccd,
                                 IkSolver::Fabrik,  IkSolver::Penalty,  IkSolver::Hybrid};

std::vector<std::uint64_t> hashes(int threads) {
    set_thread_count(threads);
    std::vector<std::uint64_t> result;
    for (const IkSolver solver : kSolvers) {
        Stage stage({.bones = 3, .solver = solver, .continues = true});
        stage.world.add(
            stage.character, LookAt{.target = stage.lamp, .joints = {{.joint = "joint 4"}}});
        for (int i = 0; i < 20; ++i) {
            stage.step();
            stage.world.get<Transform>(stage.lamp).position.y -= 0.05f;
            result.push_back(state_hash(stage.world));
        }
    }
    set_thread_count(0);
    return result;
}

}  // namespace

TEST_CASE(
    "IK rig: every solver reaches an entity that moves, from a character that is placed in the "
    "world"
    * technique("char.ik-two-link")) {
    for (const IkSolver solver : kSolvers) {
        CAPTURE(static_cast<int>(solver));
        Stage stage(
            {.bones = solver == IkSolver::TwoLink || solver == IkSolver::Hybrid ? 2 : 3,
             .solver = solver,
             .iterations = 64});
        for (int i = 0; i < 30; ++i) {
            stage.step();
            CHECK(stage.distance() < (solver == IkSolver::TwoLink ? 1e-4f : 5e-3f));
            stage.world.get<Transform>(stage.lamp).position.y -= 0.02f;
        }
    }
}

TEST_CASE("IK rig: weight 0, a missing joint, a destroyed goal and NaN leave the animated pose") {
    const auto pose_of = [](const IkChain& chain, const auto& change) {
        Stage stage(chain);
        change(stage);
        stage.step(10);
        return stage.tip();
    };
    const auto nothing = [](Stage&) {};
    const Vec3 animated = pose_of({.weight = 0}, nothing);
    CHECK(animated != pose_of({}, nothing));
    CHECK(animated == pose_of({}, [](Stage& stage) {
              stage.world.get<IkRig>(stage.character).chains[0].tip = "elbow";
          }));
    CHECK(animated == pose_of({}, [](Stage& stage) {
              stage.world.get<IkRig>(stage.character).chains[0].root = "elbow";
          }));
    CHECK(animated == pose_of({}, [](Stage& stage) { stage.world.destroy(stage.lamp); }));
    CHECK(animated == pose_of({}, [](Stage& stage) {
              stage.world.get<Transform>(stage.lamp).position.x = NAN;
          }));
    // Halfway in between for half the weight.
    const Vec3 half = pose_of({.weight = 0.5f}, nothing);
    CHECK(glm::distance(half, animated) > 0.05f);
    CHECK(glm::distance(half, pose_of({}, nothing)) > 0.05f);
}

TEST_CASE(
    "IK rig: a chain of low tone that continues from the last step lags behind its goal, and "
    "arrives"
    * technique("char.ik-weights")) {
    const auto distance_after = [](float tone, int steps) {
        Stage stage(
            {.bones = 3,
             .solver = IkSolver::Jacobian,
             .iterations = 2,
             .tone = tone,
             .continues = true});
        stage.step(steps);
        return stage.distance();
    };
    CHECK(distance_after(0.1f, 10) > 2 * distance_after(1, 10));
    CHECK(distance_after(0.1f, 10) > distance_after(0.1f, 40));
    CHECK(distance_after(0.1f, 400) < 5e-3f);
}

TEST_CASE(
    "IK rig: the same bits on 1, 2, 3 and 7 threads, and from a snapshot"
    * technique("char.ik-iterate")) {
    const std::vector<std::uint64_t> expected = hashes(1);
    CHECK(expected != std::vector<std::uint64_t>(expected.size(), expected[0]));
    for (const int threads : {2, 3, 7}) {
        CHECK(hashes(threads) == expected);
    }
}

TEST_CASE(
    "limb: it reaches in closed form with joints in between, whatever rotates its bones"
    * technique("char.ik-two-link")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 60; ++i) {
        SkeletonData skeleton = make_chain(7);
        skeleton.rest.scales[0] = Vec3(0.5f);
        LocalPose pose = skeleton.rest;
        for (Quat& rotation : pose.rotations) {
            rotation = any_turn(random, 1.5f);
        }
        const LimbJoints limb = find_limb(skeleton, 6, 4);
        CHECK(limb.root == 2);
        CHECK(limb.middle == 4);
        const Vec3 root = position_of(skeleton, pose, 2);
        const float upper = glm::distance(root, position_of(skeleton, pose, 4));
        const float lower =
            glm::distance(position_of(skeleton, pose, 4), position_of(skeleton, pose, 6));
        const float reach =
            std::abs(upper - lower) + random.uniform(0.1f, 0.9f) * 2 * std::min(upper, lower);
        const Vec3 target = root + reach * any_direction(random);
        reach_with_limb(skeleton, limb, {.target = target}, pose);
        CHECK(glm::distance(position_of(skeleton, pose, 6), target) < 5e-6f);
        // With an offset of the point that reaches.
        const Vec3 offset = 0.02f * any_direction(random);
        reach_with_limb(skeleton, limb, {.target = target, .offset = offset}, pose);
        const JointPlace tip = find_place(skeleton, pose, 6);
        CHECK(glm::distance(tip.position + tip.rotation * (tip.scale * offset), target) < 5e-6f);
    }
    CHECK(find_limb(make_chain(3), 1, 4).root == 0);
}

TEST_CASE(
    "limb: the swivel turns the elbow and leaves the wrist" * technique("char.elbow-circle")) {
    const SkeletonData skeleton = make_chain(4);
    const LimbJoints limb = find_limb(skeleton, 3, 2);
    const Vec3 target = {0.6f, 2, 0.8f};
    Vec3 first(0);
    for (int i = 0; i < 8; ++i) {
        LocalPose pose = skeleton.rest;
        const LimbReach reach = {
            .target = target,
            .options = {.pole = {0, 0, -1}, .swivel = 0.7f * static_cast<float>(i)}};
        reach_with_limb(skeleton, limb, reach, pose);
        CHECK(glm::distance(position_of(skeleton, pose, 3), target) < 3e-6f);
        const Vec3 elbow = position_of(skeleton, pose, 2);
        CHECK(glm::distance(elbow, position_of(skeleton, pose, 1)) == near(1));
        first = i == 0 ? elbow : first;
        CHECK((i == 0 || glm::distance(elbow, first) > 0.1f));
    }
    CHECK(first.z < 0.3f);
}

TEST_CASE(
    "reach: at its time the hand is at the target, outside its window the pose is the clip's"
    * technique("char.motion-constrain")) {
    const SkeletonData skeleton = make_arm();
    ReachGoal goal = {.tips = {"joint 4"}, .time = 2, .before = 0.5f, .after = 0.25f};
    const Vec3 target = {1, 2.8f, 0.6f};
    const auto pose_at = [&](double time) {
        LocalPose pose = skeleton.rest;
        pose.rotations[1] = rotation_about({0, 0, 1}, 0.3f * std::sin(static_cast<float>(time)));
        const LocalPose clip = pose;
        apply_reach(skeleton, goal, {target, reach_weight(goal, time), {4}}, pose);
        return std::pair(pose, clip);
    };
    const auto at_time = pose_at(2);
    CHECK(glm::distance(position_of(skeleton, at_time.first, 4), target) < 1e-5f);
    for (const double outside : {0.0, 1.4999, 2.2501, 5.0}) {
        const auto poses = pose_at(outside);
        CHECK(poses.first.rotations == poses.second.rotations);
        CHECK(poses.first.translations == poses.second.translations);
    }
    // In the window it approaches, without jumps.
    float last = INFINITY;
    Vec3 before = position_of(skeleton, pose_at(1.5).first, 4);
    for (int i = 1; i <= 50; ++i) {
        const Vec3 hand = position_of(skeleton, pose_at(1.5 + 0.01 * i).first, 4);
        CHECK(glm::distance(hand, before) < 0.08f);
        CHECK(glm::distance(hand, target) < last + 1e-3f);
        last = glm::distance(hand, target);
        before = hand;
    }
}

TEST_CASE(
    "reach: out of reach, striving stretches the arm toward the target, must moves the root"
    * technique("char.motion-constrain")) {
    const SkeletonData skeleton = make_arm();
    const Vec3 target = {3, 4, 2};
    const ReachState state = {target, 1, {4}};
    LocalPose pose = skeleton.rest;
    apply_reach(skeleton, {.tips = {"joint 4"}}, state, pose);
    const Vec3 shoulder = position_of(skeleton, pose, 2);
    const Vec3 hand = position_of(skeleton, pose, 4);
    CHECK(
        glm::distance(hand, target)
        == near(double(glm::distance(target, shoulder) - 2)).epsilon(1e-4));
    CHECK(glm::distance(hand, shoulder) == near(2).epsilon(1e-4));
    CHECK(pose.translations == skeleton.rest.translations);

    pose = skeleton.rest;
    apply_reach(skeleton, {.tips = {"joint 4"}, .policy = ReachPolicy::Must}, state, pose);
    CHECK(glm::distance(position_of(skeleton, pose, 4), target) < 1e-3f);
    CHECK(glm::distance(pose.translations[0], skeleton.rest.translations[0]) > 0.5f);
    // Within reach it does not move.
    pose = skeleton.rest;
    apply_reach(
        skeleton, {.tips = {"joint 4"}, .policy = ReachPolicy::Must}, {Vec3(0.5f, 3, 0.5f), 1, {4}},
        pose);
    CHECK(glm::distance(pose.translations[0], skeleton.rest.translations[0]) < 1e-5f);
}

TEST_CASE(
    "reach: weights of its window, with hold, period, and without easing"
    * technique("char.motion-constrain")) {
    const ReachGoal goal = {.time = 1, .period = 3, .before = 0.5f, .after = 0.5f, .hold = 0.25f};
    const auto is = [&](double time, double weight) {
        CHECK(double(reach_weight(goal, time)) == near(weight).scale(1));
    };
    is(0.4, 0);
    is(0.625, 0.15625);  // 3 u^2 - 2 u^3
    is(0.75, 0.5);
    is(1, 1);
    is(1.25, 1);
    is(1.5, 0.5);
    is(1.8, 0);
    is(3.75, 0.5);
    is(4, 1);
    is(301, 1);
    const ReachGoal snap = {.time = 1, .before = 0, .after = 0};
    CHECK(reach_weight(snap, 0.999) == 0);
    CHECK(reach_weight(snap, 1) == 1);
    CHECK(reach_weight(snap, 1.001) == 0);
}

TEST_CASE(
    "reach: in a world, a target that jumps in the window is followed smoothly"
    * technique("char.motion-constrain")) {
    Stage stage({.weight = 0});
    stage.world.add(
        stage.character,
        ReachGoal{.tips = {"joint 4"}, .target = stage.lamp, .time = 0.5f, .hold = 9});
    stage.step(60);
    CHECK(stage.distance() < 1e-3f);
    stage.world.get<Transform>(stage.lamp).position += Vec3(-0.4f, 0, 0);
    Vec3 last = stage.tip();
    for (int i = 0; i < 60; ++i) {
        stage.step();
        CHECK(glm::distance(stage.tip(), last) < 0.15f);
        last = stage.tip();
    }
    CHECK(stage.distance() < 1e-3f);
}

TEST_CASE(
    "look at: in a world, the head follows its target with a delay, and a person's by names") {
    Stage stage({.weight = 0});
    stage.world.remove<ClipPlayer>(stage.character);
    stage.world.add(
        stage.character, LookAt{
                             .target = stage.lamp,
                             .joints = {{.joint = "joint 4", .max_yaw = 3.1f, .max_pitch = 1.5f}},
                             .speed = 5});
    const auto angle = [&] {
        const Affine matrix = stage.world.get<const WorldTransform>(stage.character).world
                              * stage.world.get<const Pose>(stage.character).joints[4];
        const Vec3 forward = transform_vector(matrix, {0, 0, 1});
        const Vec3 way =
            stage.world.get<const Transform>(stage.lamp).position - transform_point(matrix, {});
        return std::atan2(glm::length(glm::cross(forward, way)), glm::dot(forward, way));
    };
    stage.step(2);
    CHECK(angle() < 0.01f);
    stage.world.get<Transform>(stage.lamp).position = {-4, 6, 3};
    stage.step(2);
    CHECK(angle() > 0.3f);
    stage.step(120);
    CHECK(angle() < 0.01f);
}

}  // namespace limn::pose_ik_test

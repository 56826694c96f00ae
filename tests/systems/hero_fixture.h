#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/walk.h"
#include "systems/animation/walk/walk_plan.h"
#include "systems/animation/walk/walk_step.h"
#include "tests/systems/motor_fixture.h"
#include "tests/systems/walk_fixture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::test {

inline constexpr CharacterMotor kHeroMotor = {.take_off = 0.1f};

/// A person on a plane, moved by a motor.
struct PoseStage : MotorStage {
    explicit PoseStage(std::vector<MeshData> meshes = {}, const Transform& at = {})
        : MotorStage(std::move(meshes), at, kHeroMotor) {
        world.resource<Assets>().skeletons.push_back(make_stick_person());
        Walk walk;
        walk.moves_root = false;
        world.add(person, Skeleton{{0}});
        world.add(person, walk);
        world.add(person, MotorPose{});
        step(3);
    }
    [[nodiscard]] const MotorPoseState& motion() { return world.get<const MotorPoseState>(person); }
    [[nodiscard]] const WalkState& walk() { return world.get<const WalkState>(person); }
    [[nodiscard]] const WalkBody& body() { return world.get<const WalkBody>(person); }
    [[nodiscard]] Vec3 joint(std::uint16_t joint) {
        return transform_point(
            world.get<const WorldTransform>(person).world,
            transform_point(world.get<const Pose>(person).joints[joint], Vec3(0)));
    }
    [[nodiscard]] float hips_height() { return joint(body().hips).y - feet().y; }
    /// Heel and ball of a foot.
    [[nodiscard]] std::array<Vec3, 2> sole(std::uint32_t side) {
        const WalkLeg& leg = body().legs[side];
        const Affine& ankle = world.get<const Pose>(person).joints[leg.foot];
        const Affine& root = world.get<const WorldTransform>(person).world;
        return {
            transform_point(root, transform_point(ankle, leg.heel - leg.ankle)),
            transform_point(root, transform_point(ankle, leg.ball - leg.ankle))};
    }
    /// Height of the lowest point of both soles above the ground y = 0.
    [[nodiscard]] float clearance() {
        float least = 1e6f;
        for (std::uint32_t i = 0; i < 2; ++i) {
            const std::array<Vec3, 2> points = sole(i);
            least = std::min({least, points[0].y, points[1].y - body().legs[i].ball.y});
        }
        return least;
    }
    void jump() { world.get<MoveIntent>(person).jump = true; }
    /// Until it stands after it has not stood; false: it never did.
    bool run_to_landing() {
        for (int i = 0; i < 600; ++i) {
            const bool was_off = motion().off_ground != 0;
            step();
            if (was_off && motion().off_ground == 0) {
                return true;
            }
        }
        return false;
    }
};

/// The same, walking by motion matching.
struct MatchedStage : PoseStage {
    explicit MatchedStage(std::vector<MeshData> meshes = {}, const MotionMatch& match = {})
        : PoseStage(std::move(meshes)) {
        world.add(person, match);
        step(60);
    }
    [[nodiscard]] const MotionMatchState& match() {
        return world.get<const MotionMatchState>(person);
    }
    [[nodiscard]] bool is_away() { return match().away != 0; }
    /// Whether a foot is on the ground, by what poses it.
    [[nodiscard]] bool is_planted(std::uint32_t side) {
        return is_away() ? motion().off_ground == 0 && flight_progress(walk(), side) >= 1
                         : match().feet[side].planted == 1;
    }
};

}  // namespace limn::test

#pragma once

#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "systems/animation/matching/match_database.h"
#include "systems/update_world.h"
#include "tests/systems/walk_fixture.h"

#include <array>
#include <utility>
#include <vector>

namespace limn::test {

/// The takes of a stick person, made once: they take a while.
inline const std::vector<MatchTake>& stick_takes() {
    static const std::vector<MatchTake> takes = make_match_takes(make_stick_person(), Walk{});
    return takes;
}

/// People in a world who are animated by motion matching.
struct MatchStage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity person{};

    explicit MatchStage(const MotionMatch& match = {}, std::vector<ClipData> clips = {}) {
        register_all_components();
        Assets assets;
        assets.skeletons.push_back(make_stick_person());
        assets.clips = std::move(clips);
        world.insert_resource(std::move(assets));
        person = add(match);
    }
    Entity add(const MotionMatch& match, const Transform& at = {}) {
        return world.create(at, Skeleton{{0}}, match, MoveIntent{});
    }
    void step(int count = 1, float dt = 1.0f / 60) {
        for (int i = 0; i < count; ++i) {
            world.insert_resource(FrameTime{.step = dt});
            step_world(world, schedule);
        }
    }
    void go(const Vec3& velocity, const Vec3& facing = {}) {
        world.get<MoveIntent>(person) = {.velocity = velocity, .facing = facing};
    }
    [[nodiscard]] const MotionMatchState& state() {
        return world.get<const MotionMatchState>(person);
    }
    [[nodiscard]] const Transform& at() { return world.get<const Transform>(person); }
    /// Of a joint, in the world.
    [[nodiscard]] Vec3 joint(std::uint16_t joint) {
        const Affine& matrix = world.get<const Pose>(person).joints[joint];
        return at().position + at().rotation * transform_point(matrix, Vec3(0));
    }
    /// Heel and ball of a foot, in the world.
    [[nodiscard]] std::array<Vec3, 2> foot_points(const WalkLeg& leg) {
        const Affine& ankle = world.get<const Pose>(person).joints[leg.foot];
        const auto point = [&](const Vec3& offset) {
            return at().position + at().rotation * transform_point(ankle, offset - leg.ankle);
        };
        return {point(leg.heel), point(leg.ball)};
    }
    [[nodiscard]] const MatchDatabase& database() {
        return *world.resource<MatchDatabases>().entries.at(0).database;
    }
};

}  // namespace limn::test

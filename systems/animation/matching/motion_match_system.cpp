#include "systems/animation/matching/motion_match_system.h"

#include "ecs/base/log.h"
#include "systems/animation/matching/match_handover.h"
#include "systems/animation/matching/match_step.h"
#include "systems/animation/matching/match_takes.h"
#include "systems/characters/ground_ride.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

// Techniques: char.blend, char.motion-select

namespace limn {

void add_match_states(
    Query<const MotionMatch, With<Skeleton>, Without<MotionMatchState>> states,
    Query<const MotionMatch, With<Skeleton>, Without<MatchPose>> poses,
    Query<const MotionMatch, const MotorPose, const Walk, Without<MatchHandover>> handovers,
    Query<const MotionMatchState, Without<MotionMatch>> left, Commands commands) {
    states.each([&](Entity entity, const MotionMatch& match) {
        MotionMatchState state;
        // So that not all characters search in the same step.
        const float share = 0.618034f * static_cast<float>(entity.index % 4096u);
        state.since_search =
            std::max(finite_or(match.interval, 0.0f), 0.0f) * (share - std::floor(share));
        commands.add(entity, std::move(state));
    });
    poses.each([&](Entity entity, const MotionMatch&) { commands.add(entity, MatchPose{}); });
    handovers.each([&](Entity entity, const MotionMatch&, const MotorPose&, const Walk&) {
        commands.add(entity, MatchHandover{});
    });
    left.each([&](Entity entity, const MotionMatchState&) {
        commands.remove<MotionMatchState>(entity);
        commands.remove<MatchPose>(entity);
        commands.remove<MatchHandover>(entity);
    });
}

void prepare_match_databases(
    Query<const MotionMatch, const Skeleton> characters, Query<const Walk> walks,
    Res<const Assets> assets, Res<MatchDatabases> databases) {
    characters.each([&](const MotionMatch& match, const Skeleton& skeleton) {
        if (skeleton.skeleton.index >= assets->skeletons.size()
            || databases->find(skeleton.skeleton, match) != nullptr) {
            return;
        }
        const SkeletonData& bones = assets->skeletons[skeleton.skeleton.index];
        const Walk* const walk = walks.find<const Walk>(match.walk);
        std::vector<MatchTake> takes;
        if (walk != nullptr || match.clips.empty()) {
            takes = make_match_takes(bones, walk != nullptr ? *walk : Walk{});
        }
        auto made = std::make_shared<const MatchDatabase>(
            make_match_database(bones, *assets, match.clips, std::move(takes), weights_of(match)));
        if (made->rows.count == 0) {
            log_warn(
                "motion match: skeleton {} has no clip longer than 1 s and no legs to walk; it is "
                "not animated",
                bones.name);
        }
        databases->entries.push_back(
            {skeleton.skeleton, match.walk, match.clips, weights_of(match), std::move(made)});
    });
}

void update_motion_matching(
    Query<
        const Skeleton, const MotionMatch, Optional<const MoveIntent>, Optional<const MotorState>,
        Optional<const FootContacts>, Optional<const MotorPoseState>, Optional<const MatchHandover>,
        Optional<WalkState>, MotionMatchState, MatchPose, Transform>
        characters,
    Res<const Assets> assets, Res<const MatchDatabases> databases,
    OptionalRes<const FrameTime> time) {
    const float step = time ? time->step : 0.0f;
    characters.par_each([&, step](
                            const Skeleton& skeleton, const MotionMatch& match,
                            const MoveIntent* wanted, const MotorState* motor,
                            const FootContacts* contacts, const MotorPoseState* motor_pose,
                            const MatchHandover* shown, WalkState* walk, MotionMatchState& state,
                            MatchPose& pose, Transform& transform) {
        if (motor != nullptr) {
            carry_match(motor->ride, contacts, state);
        }
        if (motor != nullptr && walk != nullptr) {
            carry_walk(motor->ride, contacts, *walk);
        }
        const MatchDatabase* const database = databases->find(skeleton.skeleton, match);
        if (database == nullptr || database->rows.count == 0) {
            state.away = 1;  // the walk and the motor pose it
            return;
        }
        const MatchContext context = {
            *assets, assets->skeletons[skeleton.skeleton.index], *database, match, motor};
        const MoveIntent intent = wanted != nullptr ? *wanted : MoveIntent{};
        if (motor != nullptr && motor_pose != nullptr && shown != nullptr && walk != nullptr) {
            const bool away =
                is_more_than_walking(*motor, *motor_pose, database->body, state.away != 0);
            if (away && state.away == 0) {
                leave_motion_match(context, transform, step, state, *walk);
            } else if (!away && state.away != 0) {
                enter_motion_match(context, intent, *shown, step, transform, state);
            }
            state.away = away ? 1 : 0;
            if (away) {
                return;
            }
        }
        step_motion_match(context, intent, step, state, transform);
        find_match_pose(context, state, transform, pose.pose);
        pose.turning = database->turning;
        pose.moving = database->moving;
    });
}

}  // namespace limn

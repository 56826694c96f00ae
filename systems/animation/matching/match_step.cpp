#include "systems/animation/matching/match_step.h"

#include "ecs/base/rotation.h"
#include "systems/animation/graph/inertial_offset.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/matching/match_feet.h"
#include "systems/animation/matching/match_root.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

// Techniques: char.blend, char.motion-select

namespace limn {
namespace {

constexpr float kForecastStep = 1.0f / 30;       // of the wanted path [s]
constexpr float kVelocitySpan = 1.0f / 1000.0f;  // over which velocities are measured [s]
constexpr float kLongestStep = 10.0f;            // what is longer is left out [s]
constexpr float kShortestInterval = 1.0f / 120;  // between searches [s]
constexpr float kSearchEarly = 1e-3f;            // by which a search may come too early [s]
constexpr float kGainSpan = 0.1f;                // over which accelerations are measured [s]
constexpr float kSameFrame = 0.25f;              // ahead: nearer ones are no reason to jump [s]
constexpr float kRecent = 1.0f;                  // in which a clip is not played again [s]
constexpr float kGoodEnough = 0.02f;             // squared distance that needs no better frame
constexpr float kClipLeft = 0.07f;               // of a clip that is over [s]
constexpr float kShortestPlay = 0.25f;           // of a clip, before another one is better [s]
constexpr float kRootBlend = 0.3f;               // of a blend, in which the root follows the clip
constexpr float kAnyWay = 0.05f;                 // slower ones stop [m/s]
constexpr float kSteerResponse = 0.15f;          // [s]
constexpr float kSteerSpeed = 0.4f;              // above it, a character can be steered [m/s]
constexpr float kContactGap = 0.05f;             // in which a foot is not lifted [s]
constexpr float kFootReach = 0.3f;               // of a planted foot off the clip's [leg lengths]
constexpr float kMoved = 0.5f;                   // of a root that was placed elsewhere [m]

float heading_of(const MatchContext& context, const Quat& rotation) {
    const float heading = context.database.body.heading;
    const Vec3 ahead = rotation * Vec3(std::sin(heading), 0, std::cos(heading));
    return std::atan2(ahead.x, ahead.z);
}

/// Part of an initial velocity's way after a time: the velocity fades like 1 - s^2 (3 - 2 s) [s].
float fading_way(float duration, float time) {
    if (!(duration > 0)) {
        return 0;
    }
    const float s = std::clamp(time / duration, 0.0f, 1.0f);
    return duration * s * (1 - s * s * (1 - 0.5f * s));
}

float fading_share(float duration, float time) {
    const float s = duration > 0 ? std::clamp(time / duration, 0.0f, 1.0f) : 1.0f;
    return 1 - s * s * (3 - 2 * s);
}

Vec3 level(const Vec3& v) {
    return {v.x, 0, v.z};
}

const MatchClip& playing(const MatchContext& context, const MotionMatchState& state) {
    return context.database.clips[state.clip];
}

/// Whether a clip ends so soon that another one has to play.
bool is_over(const MatchContext& context, const MotionMatchState& state) {
    return state.time > playing(context, state).duration - kClipLeft;
}

/// Whether it has just begun. Beginnings of turns that were played again and again would not turn.
bool has_just_begun(const MotionMatchState& state) {
    return state.blending != 0 && state.clock < kShortestPlay - kSearchEarly;
}

/// For how long the root keeps its velocity [s].
float root_blend(const MatchContext& context) {
    return kRootBlend * context.match.blend;
}

/// How fast a clip moves its root: way per time in the space of the root, and turn [m/s], [rad/s].
GroundMove root_rate(const MatchClip& clip, float time) {
    const float from = std::clamp(time, 0.0f, std::max(clip.duration - kMatchStep, 0.0f));
    const GroundMove move = compose(inverse(root_of(clip, from)), root_of(clip, from + kMatchStep));
    return {move.way / kMatchStep, move.yaw / kMatchStep};
}

bool touches(const MatchClip& clip, std::size_t foot, float time) {
    const auto& contacts = clip.contacts[foot];
    return std::any_of(contacts.begin(), contacts.end(), [time](const ClipContact& contact) {
        return time >= contact.begin && time <= contact.end;
    });
}

/// The clip's pose, or what it was `earlier` [s] before.
void sample_clip_pose(
    const MatchContext& context, const MotionMatchState& state, float earlier, LocalPose& pose) {
    pose = context.skeleton.rest;
    const float time = std::max(state.time - state.pace * earlier, 0.0f);
    sample_match_pose(context.database, context.assets, {state.clip, time}, pose);
}

void apply_offsets(
    const MatchContext& context, const MotionMatchState& state, float clock, LocalPose& pose) {
    const MatchDatabase& database = context.database;
    const float blend = context.match.blend;
    for (std::size_t i = 0; i < std::min(state.turns.size(), database.turning.size()); ++i) {
        Quat& rotation = pose.rotations[database.turning[i]];
        rotation = apply_turn(state.turns[i], rotation, blend, clock);
    }
    for (std::size_t i = 0; i < std::min(state.shifts.size(), database.moving.size()); ++i) {
        Vec3& translation = pose.translations[database.moving[i]];
        translation = apply_shift(state.shifts[i], translation, blend, clock);
    }
}

/// The displayed pose before the feet are placed, or what it was `earlier` [s] ago.
void sample_shown(
    const MatchContext& context, const MotionMatchState& state, float earlier, LocalPose& pose) {
    sample_clip_pose(context, state, earlier, pose);
    if (state.blending != 0) {
        apply_offsets(context, state, state.clock - earlier, pose);
    }
}

/// `pose`: the clip's; `shown`: the displayed one, which has the hips.
FootAim find_aim(
    const MatchContext& context, const MotionMatchState& state, std::size_t foot,
    const LocalPose& pose, const LocalPose& shown) {
    const MatchClip& clip = playing(context, state);
    const WalkLeg& leg = context.database.body.legs[foot];
    const Vec3 heel = heel_offset(context.skeleton, leg) - ball_offset(context.skeleton, leg);
    // A foot on the ground stays there if it has to be there soon.
    const bool contact =
        touches(clip, foot, state.time)
        || (state.feet[foot].planted == 1 && touches(clip, foot, state.time + kContactGap));
    return {
        find_foot(context.skeleton, leg, pose),
        root_of(clip, state.time),
        heel,
        leg.ball.y,
        contact,
        contact,
        find_place(context.skeleton, shown, leg.thigh).position,
        ball_offset(context.skeleton, leg),
        leg.length};
}

/// How the foot of the clip that plays moves, in the world.
FootRate aim_rate(
    const MatchContext& context, const MotionMatchState& state, std::size_t foot,
    const Transform& transform) {
    thread_local LocalPose pose;
    const MatchClip& clip = playing(context, state);
    const GroundMove back = inverse(root_of(clip, state.time));
    std::array<FootPoint, 2> points{};
    for (std::size_t i = 0; i < 2; ++i) {
        const float earlier = state.pace * static_cast<float>(i) * kVelocitySpan;
        const float time = std::max(state.time - earlier, 0.0f);
        pose = context.skeleton.rest;
        sample_match_pose(context.database, context.assets, {state.clip, time}, pose);
        const FootPoint local = find_foot(context.skeleton, context.database.body.legs[foot], pose);
        const GroundMove root = compose(back, root_of(clip, time));
        const GroundMove at = compose(root, {{local.place.x, local.place.z}, 0});
        points[i].place = {at.way.x, local.place.y, at.way.y};
        points[i].rotation = rotation_about({0, 1, 0}, root.yaw) * local.rotation;
    }
    return rate_between(points[1], points[0], kVelocitySpan, transform);
}

void end_blend(MotionMatchState& state) {
    state.blending = 0;
    state.clock = 0;
    state.drift = Vec2(0);
    state.drift_turn = 0;
    state.turns = {};
    state.shifts = {};
}

/// Offsets of the displayed pose from that of the next place.
void capture_pose(const MatchContext& context, const MatchPlace& next, MotionMatchState& state) {
    thread_local LocalPose shown;
    thread_local LocalPose shown_earlier;
    thread_local LocalPose target;
    thread_local LocalPose target_earlier;
    sample_shown(context, state, 0, shown);
    sample_shown(context, state, kVelocitySpan, shown_earlier);
    const GroundMove rate = root_rate(playing(context, state), state.time);
    const float left = state.blending != 0 ? fading_share(root_blend(context), state.clock) : 0;
    const Vec2 way = state.pace * rate.way + left * state.drift;
    const float turn = state.pace * rate.yaw + left * state.drift_turn;
    state.clip = next.clip;
    state.time = next.time;
    sample_clip_pose(context, state, 0, target);
    sample_clip_pose(context, state, kVelocitySpan, target_earlier);
    const GroundMove next_rate = root_rate(playing(context, state), state.time);
    end_blend(state);
    for (const std::uint16_t j : context.database.turning) {
        state.turns.push_back(inertial_turn(
            shown.rotations[j], shown_earlier.rotations[j], target.rotations[j],
            target_earlier.rotations[j], kVelocitySpan));
    }
    for (const std::uint16_t j : context.database.moving) {
        state.shifts.push_back(inertial_shift(
            shown.translations[j], shown_earlier.translations[j], target.translations[j],
            target_earlier.translations[j], kVelocitySpan));
    }
    state.drift = way - state.pace * next_rate.way;
    state.drift_turn = turn - state.pace * next_rate.yaw;
    state.blending = 1;
}

void place_feet(const MatchContext& context, const Transform& transform, MotionMatchState& state) {
    thread_local LocalPose pose;
    sample_clip_pose(context, state, 0, pose);
    for (std::size_t i = 0; i < 2 && context.database.body.can_walk; ++i) {
        place_foot(find_aim(context, state, i, pose, pose), transform, state.feet[i]);
    }
}

void begin_transition(
    const MatchContext& context, const MatchPlace& next, const Transform& transform,
    MotionMatchState& state) {
    ++state.transitions;
    if (!(context.match.blend > 0)) {
        end_blend(state);
        state.clip = next.clip;
        state.time = next.time;
        state.cut = 1;
        place_feet(context, transform, state);
        return;
    }
    capture_pose(context, next, state);
    thread_local LocalPose pose;
    sample_clip_pose(context, state, 0, pose);
    for (std::size_t i = 0; i < 2 && context.database.body.can_walk; ++i) {
        FootAim aim = find_aim(context, state, i, pose, pose);
        aim.contact = aim.contact && state.feet[i].planted == 1;  // otherwise it has to land first
        capture_foot(aim, transform, aim_rate(context, state, i, transform), state.feet[i]);
    }
}

MatchWish find_wish(const MatchContext& context, const MoveIntent& intent) {
    MatchWish wish;
    const Vec2 velocity(intent.velocity.x, intent.velocity.z);
    const Vec2 facing(intent.facing.x, intent.facing.z);
    wish.velocity =
        is_finite(intent.velocity) ? glm::clamp(velocity, Vec2(-1e3f), Vec2(1e3f)) : Vec2(0);
    if (context.motor != nullptr) {  // nobody wants to walk into a wall
        const Vec2 wall(context.motor->wall.x, context.motor->wall.z);
        wish.velocity -= std::min(glm::dot(wish.velocity, wall), 0.0f) * wall;
    }
    wish.facing = is_finite(intent.facing) ? facing : Vec2(0);
    wish.response = std::max(finite_or(context.match.response, 0.22f), 0.02f);
    wish.acceleration = std::max(finite_or(context.match.acceleration, 3.0f), 0.1f);
    wish.turn_speed = std::max(finite_or(context.match.turn_speed, 2.2f), 0.05f);
    return wish;
}

/// How the root moves now. What its velocity tends to follows from how the clip changes it, so that
/// a path which goes on as in the clip is wanted as long as nothing else is.
MatchRoot current_root(
    const MatchContext& context, const MotionMatchState& state, const Transform& transform) {
    const MatchClip& clip = playing(context, state);
    const float latest = std::max(clip.duration - kGainSpan, kGainSpan);
    const float time = std::clamp(state.time, kGainSpan, latest);
    const GroundMove back = inverse(root_of(clip, time));
    const Vec2 sum = compose(back, root_of(clip, time + kGainSpan)).way
                     + compose(back, root_of(clip, time - kGainSpan)).way;
    const float response = find_wish(context, {}).response;
    const Vec3 gain = transform.rotation * Vec3(sum.x, 0, sum.y)
                      * (uniform_scale(transform) * response * square(state.pace / kGainSpan));
    return {
        {transform.position.x, transform.position.z},
        heading_of(context, transform.rotation),
        state.velocity,
        state.velocity + Vec2(gain.x, gain.z),
        state.turn};
}

/// A number of a row, not normalized.
float number_of(const MatchDatabase& database, const MatchRow& row, std::size_t k) {
    return database.scale[k] > 0 ? row[k] / database.scale[k] + database.mean[k] : 0.0f;
}

/// Turn toward the wanted path that the clip does not make [rad/s].
float find_steering(const MatchContext& context, const MatchRow& query, const MatchRow& played) {
    const MatchDatabase& database = context.database;
    const auto heading = [&](const MatchRow& row) {
        return std::atan2(
            number_of(database, row, kMatchPath + 6), number_of(database, row, kMatchPath + 7));
    };
    const float angle = std::remainder(heading(query) - heading(played), 2 * kPi);
    const float time = static_cast<float>(kMatchAhead[1]) * kMatchStep;
    const float most = std::max(context.match.steer, 0.0f);
    return std::clamp(angle / time, -most, most);
}

/// The pace at which the clip goes as far as is wanted.
float find_pace(const MatchContext& context, const MatchRow& query, const MatchRow& played) {
    const MatchDatabase& database = context.database;
    const auto way = [&](const MatchRow& row) {
        return std::hypot(
            number_of(database, row, kMatchPath + 4), number_of(database, row, kMatchPath + 5));
    };
    const float most = std::clamp(finite_or(context.match.pace, 0.0f), 0.0f, 0.5f);
    const float far = way(played);
    return far > 0 ? std::clamp(way(query) / far, 1 - most, 1 + most) : 1.0f;
}

/// Rows of a clip from one time to another.
MatchSkip rows_between(const MatchClip& clip, float from, float to) {
    const auto row = [&](float time) {
        const float last = static_cast<float>(clip.rows);
        return static_cast<std::uint32_t>(
            clip.first_row
            + static_cast<std::size_t>(std::clamp(std::ceil(time / kMatchStep), 0.0f, last)));
    };
    return {row(from), row(to)};
}

void search(
    const MatchContext& context, const MoveIntent& intent, const Transform& transform,
    MotionMatchState& state) {
    const MatchDatabase& database = context.database;
    const MatchRow query = make_match_query(context, intent, state, transform);
    const bool first = state.started == 0;
    const bool goes_on = !first && !is_over(context, state);
    const float cost = row_distance(database.frame_at({state.clip, state.time}), query);
    const float better = std::clamp(finite_or(context.match.better, 0.1f), 0.0f, 1.0f);
    const float limit = cost > kGoodEnough ? cost * (1 - better) : 0.0f;
    // What has just played is left out, or it may begin again and again.
    const MatchSkip recent =
        first
            ? MatchSkip{}
            : rows_between(playing(context, state), state.time - kRecent, state.time + kSameFrame);
    const RowMatch found =
        find_nearest_row_boxes(database.rows, query, goes_on ? limit : INFINITY, recent);
    state.cost = found.row != kNoMatch ? found.distance : cost;
    if (found.row != kNoMatch) {
        MatchPlace next = database.place_of(found.row);
        next.time = std::max(next.time, kVelocitySpan);  // before it there has to be a pose
        if (first) {
            state.clip = next.clip;
            state.time = next.time;
        } else {
            begin_transition(context, next, transform, state);
        }
    }
    const bool can_steer = glm::length(state.velocity) > kSteerSpeed;
    const MatchRow& played = database.frame_at({state.clip, state.time});
    state.steer_aim = can_steer ? find_steering(context, query, played) : 0.0f;
    state.pace_aim = can_steer ? find_pace(context, query, played) : 1.0f;
}

/// How the character moves in the next `dt`, in its own space.
GroundMove next_move(const MatchContext& context, const MotionMatchState& state, float dt) {
    const MatchClip& clip = playing(context, state);
    const float end = std::min(state.time + state.pace * dt, clip.duration);
    GroundMove move = compose(inverse(root_of(clip, state.time)), root_of(clip, end));
    if (state.blending != 0) {
        const float blend = root_blend(context);
        const float way = fading_way(blend, state.clock + dt) - fading_way(blend, state.clock);
        move.way += way * state.drift;
        move.yaw += way * state.drift_turn;
    }
    move.yaw += state.steering * dt;
    return move;
}

void move_root(const GroundMove& move, float dt, Transform& transform, MotionMatchState& state) {
    const Vec3 way =
        transform.rotation * (uniform_scale(transform) * Vec3(move.way.x, 0, move.way.y));
    transform.position += way;
    if (move.yaw != 0) {
        transform.rotation =
            normalize_or_identity(transform.rotation * rotation_about({0, 1, 0}, move.yaw));
    }
    state.velocity = Vec2(way.x, way.z) / dt;
    state.turn = move.yaw / dt;
}

/// The motor has moved the root; feet go up and down with it, as it climbs.
void follow_motor(const MotorState& motor, const Transform& transform, MotionMatchState& state) {
    const float climbed = transform.position.y - state.root.y;
    for (MatchFoot& foot : state.feet) {
        foot.place.y += climbed;
        foot.aim.y += climbed;
    }
    state.velocity = {motor.velocity.x, motor.velocity.z};
    state.turn = state.drive_turn;
}

/// Moves ahead in the clip, and the character with it.
void advance(const MatchContext& context, float dt, Transform& transform, MotionMatchState& state) {
    const float share = 1 - std::exp(-dt / kSteerResponse);
    state.steering += share * (state.steer_aim - state.steering);
    if (context.motor == nullptr) {
        move_root(next_move(context, state, dt), dt, transform, state);
    }
    state.time = std::min(state.time + state.pace * dt, playing(context, state).duration);
    state.pace += share * (state.pace_aim - state.pace);
    state.clock += state.blending != 0 ? dt : 0.0f;
    thread_local LocalPose pose;
    thread_local LocalPose shown;
    sample_clip_pose(context, state, 0, pose);
    shown = pose;
    if (state.blending != 0) {
        apply_offsets(context, state, state.clock, shown);
    }
    const float reach = kFootReach * leg_length(context.database.body) * uniform_scale(transform);
    for (std::size_t i = 0; i < 2 && context.database.body.can_walk; ++i) {
        step_foot(
            find_aim(context, state, i, pose, shown), transform, context.match.blend, reach, dt,
            state.feet[i]);
    }
    if (state.blending != 0 && state.clock >= context.match.blend) {
        end_blend(state);
    }
}

bool is_usable(const Transform& transform) {
    const Quat& q = transform.rotation;
    return is_finite(transform.position) && std::isfinite(q.w + q.x + q.y + q.z)
           && is_finite(transform.scale);
}

}  // namespace

MatchRow make_match_query(
    const MatchContext& context, const MoveIntent& intent, const MotionMatchState& state,
    const Transform& transform) {
    const MatchDatabase& database = context.database;
    MatchRow query = database.frame_at({state.clip, state.time});
    MatchRoot root = current_root(context, state, transform);
    const Vec2 start = root.place;
    const float heading = root.heading;
    const float yaw = heading - database.body.heading;
    const float size = 1 / uniform_scale(transform);
    const MatchWish wish = find_wish(context, intent);
    std::size_t step = 0;
    for (std::size_t k = 0; k < kMatchAhead.size(); ++k) {
        for (; step < kMatchAhead[k]; ++step) {
            step_match_root(wish, kForecastStep, root);
        }
        const Vec2 way = size * compose({{0, 0}, -yaw}, {root.place - start, 0}).way;
        const float turn = root.heading - heading;
        const std::array<float, 4> numbers = {way.x, way.y, std::sin(turn), std::cos(turn)};
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const std::size_t at = kMatchPath + 4 * k + i;
            query[at] = (numbers[i] - database.mean[at]) * database.scale[at];
        }
    }
    return query;
}

void find_match_pose(
    const MatchContext& context, const MotionMatchState& state, const Transform& transform,
    LocalPose& pose) {
    sample_shown(context, state, 0, pose);
    apply_match_feet(context.skeleton, context.database.body, state.feet, transform, pose);
}

void step_motion_match(
    const MatchContext& context, const MoveIntent& intent, float dt, MotionMatchState& state,
    Transform& transform) {
    if (context.database.rows.count == 0 || !is_usable(transform)) {
        return;
    }
    state.cut = 0;
    if (state.started == 0 || state.clip >= context.database.clips.size()) {
        state.started = 0;
        state.clip = 0;
        state.time = 0;
        search(context, intent, transform, state);
        state.started = 1;
        state.root = transform.position;
        place_feet(context, transform, state);
    }
    if (glm::distance(state.root, transform.position) > kMoved) {
        end_blend(state);
        state.velocity = Vec2(0);
        place_feet(context, transform, state);
    }
    if (context.motor != nullptr) {
        follow_motor(*context.motor, transform, state);
    }
    const float interval = std::max(finite_or(context.match.interval, 0.1f), kShortestInterval);
    const bool goes = glm::length(find_wish(context, intent).velocity) > kAnyWay;
    float left = std::isfinite(dt) ? std::clamp(dt, 0.0f, kLongestStep) : 0.0f;
    while (left > 0) {
        const bool is_time =
            state.since_search >= interval - kSearchEarly && !(goes && has_just_begun(state));
        if (is_time || is_over(context, state)) {
            state.since_search = 0;
            search(context, intent, transform, state);
        }
        const float part = left < interval + kSearchEarly ? left : interval;
        advance(context, part, transform, state);
        state.since_search += part;
        left -= part;
    }
    state.root = transform.position;
    if (context.motor != nullptr && dt > 0) {
        const GroundMove move = next_move(context, state, dt);
        state.drive = uniform_scale(transform) * move.way / dt;
        state.drive_turn = move.yaw / dt;
    }
}

void enter_motion_match(
    const MatchContext& context, const MoveIntent& intent, const MatchHandover& shown, float dt,
    const Transform& transform, MotionMatchState& state) {
    const MatchDatabase& database = context.database;
    const std::uint32_t transitions = state.transitions + 1;
    state = {};
    if (database.rows.count == 0 || context.motor == nullptr || !is_usable(transform)
        || shown.joints.size() != context.skeleton.joints.size() || !(dt > 0)) {
        return;  // begins with the next step
    }
    state.transitions = transitions;
    state.root = transform.position;
    state.velocity = {context.motor->velocity.x, context.motor->velocity.z};
    MatchRow query = make_match_query(context, intent, state, transform);
    const Vec3 moves = glm::conjugate(transform.rotation) * level(context.motor->velocity)
                       / uniform_scale(transform);
    const auto set = [&](std::size_t first, const Vec3& numbers) {
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t at = first + static_cast<std::size_t>(axis);
            query[at] = (numbers[axis] - database.mean[at]) * database.scale[at];
        }
    };
    const auto rate = [&](const HandoverJoint& joint) {
        return moves + (joint.place - joint.last_place) / dt;
    };
    for (std::size_t i = 0; i < 2; ++i) {
        set(kMatchFeet + 3 * i, shown.feet[i].place);
        set(kMatchFeet + 6 + 3 * i, rate(shown.feet[i]));
    }
    set(kMatchFeet + 12, rate(shown.joints[database.body.hips]));
    const RowMatch found = find_nearest_row_boxes(database.rows, query, INFINITY, MatchSkip{});
    if (found.row == kNoMatch) {
        return;
    }
    const MatchPlace place = database.place_of(found.row);
    state.clip = place.clip;
    state.time = std::max(place.time, kVelocitySpan);
    state.cost = found.distance;
    state.started = 1;
    state.blending = context.match.blend > 0 ? 1 : 0;
    const GroundMove clip_rate = root_rate(playing(context, state), state.time);
    state.drift = Vec2(moves.x, moves.z) - clip_rate.way;
    state.drift_turn = -clip_rate.yaw;
    thread_local LocalPose pose;
    sample_clip_pose(context, state, 0, pose);
    for (std::size_t i = 0; i < 2 && database.body.can_walk; ++i) {
        const HandoverJoint& joint = shown.feet[i];
        const auto in_world = [&](const Vec3& ankle, const Quat& rotation) {
            const Vec3 ball =
                ankle + rotation * ball_offset(context.skeleton, database.body.legs[i]);
            return FootPoint{
                transform.position + transform.rotation * (uniform_scale(transform) * ball),
                transform.rotation * rotation};
        };
        const FootPoint now = in_world(joint.place, joint.rotation);
        const FootPoint last = in_world(joint.last_place, joint.last_rotation);
        MatchFoot& foot = state.feet[i];
        foot.velocity = level(context.motor->velocity) + (now.place - last.place) / dt;
        foot.spin = 2.0f
                    * log_rotation(to_same_hemisphere(
                        Quat(1, 0, 0, 0), now.rotation * glm::conjugate(last.rotation)))
                    / dt;
        // The root has moved on since the pose was shown, the foot by its own velocity.
        foot.place = now.place + dt * (foot.velocity - level(context.motor->velocity));
        foot.rotation = normalize_or_identity(exp_rotation(0.5f * dt * foot.spin) * now.rotation);
        foot.hold = 1;
        capture_foot(
            find_aim(context, state, i, pose, pose), transform,
            aim_rate(context, state, i, transform), foot);
    }
}

void apply_match_pose(const MatchPose& match, LocalPose& pose) {
    if (match.pose.size() != pose.size()) {
        return;
    }
    for (const std::uint16_t j : match.turning) {
        pose.rotations[j] = match.pose.rotations[j];
    }
    for (const std::uint16_t j : match.moving) {
        pose.translations[j] = match.pose.translations[j];
    }
}

}  // namespace limn

#include "systems/animation/matching/match_feet.h"

#include "ecs/base/rotation.h"
#include "systems/animation/graph/inertial_offset.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

// Techniques: char.blend

namespace limn {
namespace {

constexpr float kLongestLeg = 0.99f;    // of a leg, which never is quite straight
constexpr float kLegSoftness = 0.006f;  // [leg lengths]
constexpr float kHoldTime = 0.1f;       // in which a foot begins or ends to pull [s]
constexpr float kKneeAhead = 0.6f;      // pull on knees, forward [leg lengths]
constexpr float kHipsEase = 0.01f;      // over which hips begin to sink [leg lengths]
constexpr std::uint32_t kPlanted = 1;   // of MatchFoot::planted
constexpr std::uint32_t kPulledOff = 2;
constexpr float kArc = 0.25f;           // height of a way over the ground [way]
constexpr float kHighestArc = 0.12f;    // [leg lengths]
constexpr float kDeepestSink = 0.04f;   // of the hips above a foot [leg lengths]
constexpr float kLandingSink = 0.004f;  // likewise, where a foot lands
constexpr float kLandingHeight =
    0.02f;                             // above the clip's foot, below which one lands [leg lengths]
constexpr float kMaxFootRate = 20.0f;  // of an offset [m/s]
constexpr float kMaxFootSpin = 60.0f;  // [rad/s]

float yaw_of(const Quat& rotation) {
    return 2 * std::atan2(rotation.y, rotation.w);
}

Quat about_up(float yaw) {
    return rotation_about({0, 1, 0}, yaw);
}

/// Faster ones are no motion but a jump, and are dropped.
Vec3 limited(const Vec3& rate, float most) {
    return is_finite(rate) && glm::length(rate) < most ? rate : Vec3(0);
}

/// The clip's foot in the space of the parent.
FootPoint point_in(const FootPoint& local, const Transform& at) {
    return {
        at.position + at.rotation * (uniform_scale(at) * local.place),
        at.rotation * local.rotation};
}

Vec3 turn_between(const Quat& from, const Quat& to) {
    return 2.0f * log_rotation(to_same_hemisphere(Quat(1, 0, 0, 0), to * glm::conjugate(from)));
}

/// From the rotation of the clip's foot in its root's space to that of a planted one.
Quat anchored(const FootAim& aim, float anchor_yaw) {
    return about_up(anchor_yaw + aim.root.yaw) * aim.local.rotation;
}

/// The lower one of heel and ball, from the ball.
Vec3 find_pivot(const FootAim& aim, const Quat& rotation) {
    const Vec3 heel = rotation * aim.heel;
    return heel.y < -aim.sole ? aim.heel : Vec3(0);
}

/// By how much a foot has to be raised for ball and heel not to be below the ground, or below where
/// the clip has them [m].
float find_lift(
    const FootAim& aim, const Transform& at, const FootPoint& target, const FootPoint& shown) {
    const float scale = uniform_scale(at);
    const float ground = at.position.y;
    const auto heel = [&](const FootPoint& foot) {
        return foot.place.y + scale * (foot.rotation * aim.heel).y;
    };
    const float ball = std::min(ground + scale * aim.sole, target.place.y);
    return std::max({0.0f, ball - shown.place.y, std::min(ground, heel(target)) - heel(shown)});
}

/// By how much hips have to sink for a leg to reach an ankle [m]; < 0: not at all.
float needed_sink(const Vec3& hip, const Vec3& ankle, float leg) {
    const Vec3 way = hip - ankle;
    const float most = kLongestLeg * leg;
    const float flat = way.x * way.x + way.z * way.z;
    return way.y - std::sqrt(std::max(most * most - flat, square(0.3f * most)));
}

/// Height on the arc of what is left of a way, smooth at both ends: 0 .. 1.
float arc_share(const Vec3& left, const Vec3& whole) {
    const float part =
        glm::length(Vec2(left.x, left.z)) / std::max(glm::length(Vec2(whole.x, whole.z)), 1e-4f);
    const float s = std::clamp(part, 0.0f, 1.0f);
    return 16 * square(s * (1 - s));
}

/// Whether a foot is too far off for its leg. The hips sink for one that stands; one that lands
/// lets them sink by no more than the clip's own foot does.
bool is_stretched(const FootAim& aim, const Transform& at, bool stands, const MatchFoot& foot) {
    const Quat back = glm::conjugate(at.rotation);
    const Vec3 ball = back * (foot.place - at.position) / uniform_scale(at);
    const Vec3 ankle = ball - back * (foot.rotation * aim.ball);
    const Vec3 own = aim.local.place - aim.local.rotation * aim.ball;
    const float landing = std::clamp(
        needed_sink(aim.hip, own, aim.leg) + 0.5f * kLandingSink * aim.leg, -kHipsEase * aim.leg,
        kLandingSink * aim.leg);
    return needed_sink(aim.hip, ankle, aim.leg) > (stands ? kDeepestSink * aim.leg : landing);
}

}  // namespace

Vec3 ball_offset(const SkeletonData& skeleton, const WalkLeg& leg) {
    return leg.toes < skeleton.joints.size() ? skeleton.rest.translations[leg.toes] : Vec3(0);
}

Vec3 heel_offset(const SkeletonData& skeleton, const WalkLeg& leg) {
    const Quat rest = find_place(skeleton, skeleton.rest, leg.foot).rotation;
    return glm::conjugate(rest) * (leg.heel - leg.ankle);
}

FootPoint find_foot(const SkeletonData& skeleton, const WalkLeg& leg, const LocalPose& pose) {
    const JointPlace ankle = find_place(skeleton, pose, leg.foot);
    return {ankle.position + ankle.rotation * ball_offset(skeleton, leg), ankle.rotation};
}

void place_foot(const FootAim& aim, const Transform& at, MatchFoot& foot) {
    foot = {};
    const FootPoint target = point_in(aim.local, at);
    foot.place = foot.aim = target.place;
    foot.rotation = target.rotation;
    foot.hold = aim.contact ? 1.0f : 0.0f;
    capture_foot(aim, at, {}, foot);
}

FootRate rate_between(const FootPoint& from, const FootPoint& to, float dt, const Transform& at) {
    return {
        at.rotation * (uniform_scale(at) * (to.place - from.place)) / dt,
        at.rotation * (turn_between(from.rotation, to.rotation) / dt)};
}

void capture_foot(const FootAim& aim, const Transform& at, const FootRate& rate, MatchFoot& foot) {
    foot.clock = 0;
    foot.planted = aim.contact ? kPlanted : 0;
    FootPoint target = point_in(aim.local, at);
    if (aim.contact) {
        // The heading stays as long as the contact does.
        const Quat level = about_up(yaw_of(at.rotation)) * aim.local.rotation;
        const float yaw = yaw_of(at.rotation) + turn_between(level, foot.rotation).y;
        foot.anchor_yaw = yaw - aim.root.yaw;
        target.rotation = anchored(aim, foot.anchor_yaw);
    }
    foot.shift.offset = foot.place - target.place;
    foot.shift.rate = Vec3(0);
    foot.turn.offset = turn_between(target.rotation, foot.rotation);
    foot.turn.rate = Vec3(0);
    if (!aim.contact) {
        foot.shift.rate = limited(foot.velocity - rate.velocity, kMaxFootRate);
        foot.turn.rate = limited(foot.spin - rate.spin, kMaxFootSpin);
    }
    // On its way to the foot of the clip it does not drag along the ground.
    const float way = glm::length(Vec2(foot.shift.offset.x, foot.shift.offset.z));
    const float highest = kHighestArc * aim.leg * uniform_scale(at);
    foot.arc = !aim.contact ? std::min(kArc * way, highest) : 0.0f;
    foot.aim = point_in(aim.local, at).place;
}

void step_foot(
    const FootAim& aim, const Transform& at, float blend, float reach, float dt, MatchFoot& foot) {
    const Vec3 aim_place = point_in(aim.local, at).place;
    // The root's own corrections are in it: a foot that leaves the ground takes them up.
    const FootRate rate = {dt > 0 ? (aim_place - foot.aim) / dt : Vec3(0), foot.spin};
    FootAim now = aim;
    const bool was_planted = foot.planted == kPlanted;
    const float far =
        glm::distance(Vec2(foot.place.x, foot.place.z), Vec2(aim_place.x, aim_place.z));
    if (foot.planted == kPulledOff && (!aim.stands || foot.clock >= blend)) {
        foot.planted = 0;
    }
    // A foot lands where its leg reaches, so that the hips do not drop.
    const bool pulled = far > reach || is_stretched(aim, at, was_planted, foot);
    now.contact = aim.contact && foot.planted != kPulledOff && !pulled;
    const auto show = [&] {
        FootPoint target = point_in(aim.local, at);
        if (was_planted) {
            target.rotation = anchored(aim, foot.anchor_yaw);
        }
        const Vec3 turn = inertial_vector(foot.turn, blend, foot.clock);
        const Quat rotation = normalize_or_identity(exp_rotation(0.5f * turn) * target.rotation);
        const Vec3 shift = inertial_vector(foot.shift, blend, foot.clock);
        Vec3 place = target.place + shift;
        place.y += foot.arc * arc_share(shift, foot.shift.offset);
        if (was_planted) {  // rolls over a point that stays
            const Vec3 pivot = uniform_scale(at) * find_pivot(aim, foot.rotation);
            const Vec3 rolled = foot.place + foot.rotation * pivot - rotation * pivot;
            place = {rolled.x, place.y, rolled.z};
        }
        place.y += find_lift(aim, at, target, {place, rotation});
        if (dt > 0) {
            foot.velocity = (place - foot.place) / dt;
            foot.spin = turn_between(foot.rotation, rotation) / dt;
        }
        foot.place = place;
        foot.rotation = rotation;
    };
    foot.clock = std::min(foot.clock + dt, 1e3f);
    foot.hold = std::clamp(foot.hold + (was_planted ? dt : -dt) / kHoldTime, 0.0f, 1.0f);
    show();
    // It comes down before it stands.
    const float up = foot.place.y - aim_place.y;
    now.contact = now.contact && (was_planted || up < kLandingHeight * aim.leg * uniform_scale(at));
    if (was_planted != now.contact) {
        capture_foot(now, at, rate, foot);
        foot.planted = aim.contact && pulled ? kPulledOff : foot.planted;
    }
    foot.aim = aim_place;
}

void apply_match_feet(
    const SkeletonData& skeleton, const WalkBody& body, const std::array<MatchFoot, 2>& feet,
    const Transform& at, LocalPose& pose) {
    if (!body.can_walk) {
        return;
    }
    const Quat back = glm::conjugate(at.rotation);
    const float inverse_scale = 1 / uniform_scale(at);
    std::array<Vec3, 2> ankles{};
    std::array<Quat, 2> rotations{};
    float sink = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkLeg& leg = body.legs[i];
        rotations[i] = back * feet[i].rotation;
        ankles[i] = inverse_scale * (back * (feet[i].place - at.position))
                    - rotations[i] * ball_offset(skeleton, leg);
        const Vec3 hip = find_place(skeleton, pose, leg.thigh).position;
        // Smooth where it begins: the hips do not jerk as a leg gets straight.
        const float over = needed_sink(hip, ankles[i], leg.length);
        const float ease = kHipsEase * leg.length;
        const float needed = over > ease    ? over
                             : over > -ease ? square(over + ease) / (4 * ease)
                                            : 0.0f;
        const float hold = feet[i].hold * feet[i].hold * (3 - 2 * feet[i].hold);
        sink = std::max(sink, hold * needed);
    }
    pose.translations[0].y -= sink;
    const Quat hips = find_place(skeleton, pose, body.hips).rotation
                      * glm::conjugate(find_place(skeleton, skeleton.rest, body.hips).rotation);
    const Vec3 ahead = hips * Vec3(std::sin(body.heading), 0, std::cos(body.heading));
    const Vec3 hinge = glm::cross(hips * Vec3(0, 1, 0), ahead);
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkLeg& leg = body.legs[i];
        // As it is bent, but forward where it is nearly straight.
        const Vec3 hip = find_place(skeleton, pose, leg.thigh).position;
        const Vec3 knee = find_place(skeleton, pose, leg.shin).position;
        const Vec3 ankle = find_place(skeleton, pose, leg.foot).position;
        const Vec3 pole = knee - 0.5f * (hip + ankle) + kKneeAhead * leg.length * ahead;
        const LimbReach reach = {
            .target = ankles[i],
            .options = {.pole = pole, .hinge = hinge, .softness = kLegSoftness * leg.length}};
        reach_with_limb(skeleton, {leg.thigh, leg.shin, leg.foot}, reach, pose);
        set_joint_rotation(skeleton, leg.foot, rotations[i], 1, pose);
    }
}

}  // namespace limn

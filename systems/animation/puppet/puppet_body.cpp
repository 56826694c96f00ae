#include "systems/animation/puppet/puppet_body.h"

#include "ecs/base/rotation.h"
#include "ecs/components/body_measures.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: char.puppetry

namespace limn {
namespace {

constexpr std::uint16_t kNoPuppetJoint = 0xffff;
constexpr float kPlantSpeed = 0.25f;   // below it a foot is planted [leg lengths/s]
constexpr float kPlantHeight = 0.06f;  // and below it above where it stands [leg lengths]
constexpr float kRelease = 1.6f;       // of both, until it is not any more
constexpr float kFade = 0.08f;         // time constant of corrections [s]
constexpr float kMaxReach = 0.997f;    // of a leg

Vec3 position(const std::vector<Affine>& joints, std::uint16_t joint) {
    return transform_point(joints[joint], Vec3(0));
}

Mat3 matrix_axes(const Affine& a) {
    return {
        Vec3(a.row[0].x, a.row[1].x, a.row[2].x), Vec3(a.row[0].y, a.row[1].y, a.row[2].y),
        Vec3(a.row[0].z, a.row[1].z, a.row[2].z)};
}

PuppetLimb find_parts(const BodyJoints& body, const std::array<BodyPart, 4>& parts) {
    const PuppetLimb limb = {body[parts[0]], body[parts[1]], body[parts[2]], body[parts[3]]};
    return std::max({limb.root, limb.middle, limb.tip}) == kNoPuppetJoint ? PuppetLimb{} : limb;
}

std::array<std::uint16_t, 2> find_hips(const BodySize& size) {
    const std::uint16_t left = size.joints[BodyPart::LeftThigh];
    const std::uint16_t right = size.joints[BodyPart::RightThigh];
    return std::max(left, right) == kNoPuppetJoint ? std::array{size.root, size.root}
                                                   : std::array{left, right};
}

/// Moves the body root by `offset`, in the space of the puppet.
void move_body(const SkeletonData& skeleton, const Vec3& offset, PuppetBody& body) {
    const std::int32_t parent = skeleton.parents[body.root];
    Vec3 local = offset;
    if (parent >= 0) {
        local = glm::inverse(matrix_axes(body.matrices[static_cast<std::size_t>(parent)])) * offset;
    }
    body.pose.translations[body.root] += local;
    compute_joint_matrices(skeleton, body.pose, body.matrices);
}

/// By how much a hip is too high for its foot to reach the target.
float find_drop(const PuppetBody& body, const PuppetLimb& leg, const Vec3& target) {
    const Vec3 hip = position(body.matrices, leg.root);
    const Vec3 knee = position(body.matrices, leg.middle);
    const Vec3 ankle = position(body.matrices, leg.tip);
    const float length = kMaxReach * (glm::distance(hip, knee) + glm::distance(knee, ankle));
    const Vec3 way = hip - target;
    const float across2 = way.x * way.x + way.z * way.z;
    return std::max(way.y - std::sqrt(std::max(length * length - across2, 0.0f)), 0.0f);
}

/// Whether the performer's foot is planted: slow and low, with hysteresis. `foot.last` is kept.
bool is_planted(
    const PuppetBody& body, const Vec3& point, float height, float step, PuppetFoot& foot,
    bool is_first) {
    const float speed = is_first || !(step > 0) ? 0.0f : glm::distance(point, foot.last) / step;
    foot.last = point;
    const float slack = body.leg * (foot.planted ? kRelease : 1.0f);
    return speed < kPlantSpeed * slack && height < body.standing + kPlantHeight * slack;
}

}  // namespace

void measure_puppet(const SkeletonData& performer, const SkeletonData& puppet, PuppetBody& body) {
    const BodySize from(performer);
    const BodySize to(puppet);
    body.map = make_body_map(from, to);
    body.shift = find_body_shift(from, to, body.map.scale);
    body.thighs = find_hips(from);
    body.hips = find_hips(to);
    body.root = to.root;
    body.left = find_left(puppet, to.joints);
    body.leg = from.leg;
    body.joints = {
        kNoPuppetJoint,
        from.joints[BodyPart::LeftFoot],
        from.joints[BodyPart::RightFoot],
        from.joints[BodyPart::LeftToes],
        from.joints[BodyPart::RightToes],
        from.joints[BodyPart::LeftHand],
        from.joints[BodyPart::RightHand]};
    body.standing = 0;
    for (std::size_t i = 1; i <= 2; ++i) {
        const std::uint16_t foot =
            body.joints[i + 2] != kNoPuppetJoint ? body.joints[i + 2] : body.joints[i];
        body.standing += foot != kNoPuppetJoint ? 0.5f * from.rest_position(foot).y : 0.0f;
    }
    using enum BodyPart;
    body.legs = {
        find_parts(to.joints, {LeftThigh, LeftShin, LeftFoot, LeftToes}),
        find_parts(to.joints, {RightThigh, RightShin, RightFoot, RightToes})};
    body.arms = {
        find_parts(to.joints, {LeftUpperArm, LeftForearm, LeftHand, LeftHand}),
        find_parts(to.joints, {RightUpperArm, RightForearm, RightHand, RightHand})};
    body.pose = puppet.rest;
    body.matrices.resize(puppet.joints.size());
    body.turns.assign(performer.joints.size(), Quat(1, 0, 0, 0));
}

void read_performer(
    const PuppetBody& body, std::span<const Affine> joints, std::span<Quat> turns,
    std::array<Vec3, 7>& points) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
        turns[j] = extract_rotation(matrix_axes(joints[j])).value_or(turns[j]);
    }
    points[0] = 0.5f
                * (transform_point(joints[body.thighs[0]], Vec3(0))
                   + transform_point(joints[body.thighs[1]], Vec3(0)));
    for (std::size_t i = 1; i < points.size(); ++i) {
        points[i] = body.joints[i] == kNoPuppetJoint
                        ? points[0]
                        : transform_point(joints[body.joints[i]], Vec3(0));
    }
}

void pose_puppet(
    const SkeletonData& puppet, std::span<const Quat> turns, const std::array<Vec3, 7>& points,
    float hands, PuppetBody& body) {
    body.pose.translations = puppet.rest.translations;
    map_body_turns(body.map, puppet, turns, body.outer, body.pose.rotations);
    compute_joint_matrices(puppet, body.pose, body.matrices);
    const Vec3 middle =
        0.5f * (position(body.matrices, body.hips[0]) + position(body.matrices, body.hips[1]));
    move_body(puppet, body.map.scale * points[0] + body.shift - middle, body);
    for (std::size_t i = 0; hands > 0 && i < 2; ++i) {
        const PuppetLimb& arm = body.arms[i];
        const auto point = static_cast<std::size_t>(PuppetPoint::Hands) + i;
        if (arm.tip == kNoPuppetJoint || body.joints[point] == kNoPuppetJoint) {
            continue;
        }
        const Vec3 wanted = body.map.scale * points[point] + body.shift;
        const Vec3 found = position(body.matrices, arm.tip);
        reach_with_limb(
            puppet, {arm.root, arm.middle, arm.tip},
            {.target = glm::mix(found, wanted, hands), .options = {.hinge = {0, 1, 0}}}, body.pose);
    }
    compute_joint_matrices(puppet, body.pose, body.matrices);
}

void pin_puppet(
    const SkeletonData& puppet, const Transform& performer, const Transform& transform, float step,
    PuppetState& state, PuppetBody& body) {
    const Affine performer_world =
        affine_from(performer.position, performer.rotation, performer.scale);
    const Affine world = affine_from(transform.position, transform.rotation, transform.scale);
    const Mat3 back = glm::inverse(matrix_axes(world));
    const float remains = std::exp(-step / kFade);
    std::array<Vec3, 2> targets = {};
    float drop = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const PuppetLimb& leg = body.legs[i];
        if (leg.tip == kNoPuppetJoint || body.joints[i + 1] == kNoPuppetJoint) {
            continue;
        }
        PuppetFoot& foot = state.feet[i];
        const std::size_t point = body.joints[i + 3] != kNoPuppetJoint ? i + 3 : i + 1;
        const bool planted = is_planted(
            body, transform_point(performer_world, state.points[point]), state.points[point].y,
            step, foot, !state.started);
        const std::uint16_t toes = leg.toes != kNoPuppetJoint ? leg.toes : leg.tip;
        const Vec3 at = transform_point(world, position(body.matrices, toes));
        if (planted && !foot.planted) {
            foot.pin = at + foot.offset;
        }
        foot.planted = planted;
        foot.offset = planted ? foot.pin - at : remains * foot.offset;
        targets[i] = position(body.matrices, leg.tip) + back * foot.offset;
        drop = std::max(drop, find_drop(body, leg, targets[i]));
    }
    state.drop = std::max(drop, remains * state.drop);
    if (state.drop > 0) {
        move_body(puppet, {0, -state.drop, 0}, body);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const PuppetLimb& leg = body.legs[i];
        const bool is_moved = state.drop > 0 || state.feet[i].offset != Vec3(0);
        if (leg.tip != kNoPuppetJoint && body.joints[i + 1] != kNoPuppetJoint && is_moved) {
            const Quat sole = find_place(puppet, body.pose, leg.tip).rotation;
            const Quat thigh = find_place(puppet, body.pose, leg.root).rotation;
            const Vec3 hinge = thigh * glm::conjugate(body.map.target_rest[leg.root]) * body.left;
            reach_with_limb(
                puppet, {leg.root, leg.middle, leg.tip},
                {.target = targets[i], .options = {.hinge = hinge}}, body.pose);
            set_joint_rotation(puppet, leg.tip, sole, 1, body.pose);
        }
    }
    compute_joint_matrices(puppet, body.pose, body.matrices);
}

}  // namespace limn

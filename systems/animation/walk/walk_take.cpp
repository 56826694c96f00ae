#include "systems/animation/walk/walk_take.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_route.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

// Techniques: char.walk-control, char.walk-cycle

namespace limn {
namespace {

constexpr float kTakeSettle = 8.0f;         // until each cycle is like the last [s]
constexpr float kStandTime = 0.5f;          // after it has arrived [s]
constexpr float kTakeStep = 1.0f / 120.0f;  // longest [s]
constexpr float kFlatPitch = 1e-5f;         // pitch of a foot that stands flat [rad]
constexpr std::uint16_t kNoTrack = 0xffff;

/// Someone who walks along the course.
struct TakeWalker {
    const SkeletonData& skeleton;
    const Walk& walk;
    const WalkCourse& course;
    WalkRoute route = {};
    WalkBody body = {};
    MoveIntent intent = {};
    WalkState state = {};
    WalkRouteState passed = {};
    Transform transform = {};
    float time = 0;
    float heading = 0;  ///< along an arc [rad]

    void step(float dt) {
        if (!course.points.empty()) {
            intent.velocity = follow_route(route, walk, state, transform.position, dt, passed);
        } else if (course.standing) {
            intent.velocity = pace() * heading_direction(body.heading + course.turn * time);
        } else {
            move(dt);
        }
        step_walk(walk, intent, body, std::nullopt, dt, state, transform);
        time += dt;
    }

    [[nodiscard]] float pace() const {
        return course.pace > 0 ? course.pace : effective_walk(walk).speed;
    }

    /// Exactly along the arc of the course.
    void move(float dt) {
        const float turn = course.turn * dt;
        transform.position += pace() * dt * heading_direction(heading + 0.5f * turn);
        heading += turn;
        transform.rotation = rotation_about({0, 1, 0}, heading - body.heading);
    }

    /// With the hips where they are in the world that the character began in.
    void pose(const Transform& begin, LocalPose& pose) {
        body.targets = find_walk_targets(body, state, transform);
        pose = skeleton.rest;
        apply_walk(skeleton, walk, state, body, pose);
        const Quat back = glm::conjugate(begin.rotation);
        const Quat turn = back * transform.rotation;
        const JointPlace hips = find_place(skeleton, pose, body.hips);
        const JointPlace above = find_place(skeleton, pose, skeleton.parents[body.hips]);
        const Vec3 place = back * (transform.position - begin.position) + turn * hips.position;
        pose.translations[body.hips] = (glm::conjugate(above.rotation) * (place - above.position))
                                       / glm::max(glm::abs(above.scale), Vec3(1e-6f));
        pose.rotations[body.hips] =
            normalize_or_identity(glm::conjugate(above.rotation) * (turn * hips.rotation));
    }
};

/// Turns what joints do at each key into contacts.
struct ContactTrack {
    std::uint16_t joint = kNoTrack;
    std::optional<float> since;

    void mark(bool is_planted, float time, ClipData& clip) {
        if (joint == kNoTrack) {
            return;
        }
        if (is_planted && !since) {
            since = time;
        }
        if (!is_planted && since) {
            // The key before is the last one at which it was planted.
            clip.contacts.push_back({joint, *since, std::max(last, *since)});
            since.reset();
        }
        last = time;
    }
    void finish(ClipData& clip) {
        if (joint != kNoTrack && since) {
            clip.contacts.push_back({joint, *since, last});
        }
    }

    float last = 0.0f;  ///< time of the key before [s]
};

struct FootTracks {
    ContactTrack foot;
    ContactTrack toes;
    bool was_planted = true;

    void mark(const WalkState& state, std::uint32_t side, float time, ClipData& clip) {
        const bool is_planted = flight_progress(state, side) >= 1;
        const float pitch = state.feet[side].pitch;
        toes.mark(is_planted && pitch <= kFlatPitch, time, clip);
        foot.mark(is_planted && std::abs(pitch) <= kFlatPitch, time, clip);
        if (is_planted && !was_planted) {
            clip.events.push_back({"step", time});
        }
        was_planted = is_planted;
    }
};

ClipSheet
make_sheet(const SkeletonData& skeleton, const std::vector<LocalPose>& poses, float rate) {
    ClipSheet sheet;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        sheet.rotating.push_back(static_cast<std::uint16_t>(j));
        sheet.translating.push_back(static_cast<std::uint16_t>(j));
    }
    for (std::size_t key = 0; key < poses.size(); ++key) {
        const LocalPose& pose = poses[key];
        sheet.times.push_back(static_cast<float>(key) / rate);
        for (std::size_t j = 0; j < pose.size(); ++j) {
            const Quat& q = pose.rotations[j];
            const std::size_t before = sheet.rotations.size() - pose.size();
            sheet.rotations.push_back(key > 0 ? to_same_hemisphere(sheet.rotations[before], q) : q);
        }
        sheet.translations.insert(
            sheet.translations.end(), pose.translations.begin(), pose.translations.end());
    }
    drop_still_joints(skeleton, sheet);
    return sheet;
}

/// Keeps the joints that have another value than at rest in some key.
template <typename T>
void drop_still(
    const std::vector<T>& rest, std::vector<std::uint16_t>& joints, std::vector<T>& values) {
    const std::size_t row = joints.size();
    std::vector<std::uint16_t> kept;
    std::vector<std::size_t> columns;
    for (std::size_t k = 0; k < row; ++k) {
        bool moves = false;
        for (std::size_t i = k; i < values.size(); i += row) {
            moves = moves || values[i] != rest[joints[k]];
        }
        if (moves) {
            kept.push_back(joints[k]);
            columns.push_back(k);
        }
    }
    std::vector<T> remaining;
    for (std::size_t first = 0; row > 0 && first < values.size(); first += row) {
        for (const std::size_t k : columns) {
            remaining.push_back(values[first + k]);
        }
    }
    joints = std::move(kept);
    values = std::move(remaining);
}

}  // namespace

void drop_still_joints(const SkeletonData& skeleton, ClipSheet& sheet) {
    drop_still(skeleton.rest.rotations, sheet.rotating, sheet.rotations);
    drop_still(skeleton.rest.translations, sheet.translating, sheet.translations);
}

ClipData make_walk_take(
    const SkeletonData& skeleton, const Walk& walk, const WalkCourse& course, float seconds,
    float rate) {
    LIMN_CHECK(rate > 0 && seconds >= 0);
    ClipData clip;
    clip.name = "walk";
    Walk style = walk;
    style.moves_root = course.standing || !course.points.empty();
    TakeWalker walker = {.skeleton = skeleton, .walk = style, .course = course};
    walker.body = find_walk_body(skeleton);
    if (!walker.body.can_walk) {
        return clip;
    }
    walker.heading = walker.body.heading;
    walker.route = {.points = course.points, .loop = false};
    const auto substeps = static_cast<int>(std::ceil(1.0f / (rate * kTakeStep) - 1e-3f));
    const float dt = 1.0f / (rate * static_cast<float>(std::max(substeps, 1)));
    const bool is_settled = course.points.empty() && !course.standing;
    walker.step(0);
    while (is_settled && walker.time < kTakeSettle) {
        walker.step(dt);
    }
    const Transform begin = walker.transform;
    std::array<FootTracks, 2> tracks;
    for (std::size_t i = 0; i < 2; ++i) {
        tracks[i].foot.joint = walker.body.legs[i].foot;
        tracks[i].toes.joint = walker.body.legs[i].toes;
    }
    const float longest = seconds > 0 ? seconds : kMaxWalkTake;
    const auto keys = static_cast<std::size_t>(
        std::min(std::round(longest * rate) + 1, static_cast<float>(kMaxWalkKeys)));
    std::vector<LocalPose> poses;
    float stood = 0;
    for (std::size_t key = 0; key < keys && (seconds > 0 || stood < kStandTime); ++key) {
        const float time = static_cast<float>(key) / rate;
        walker.pose(begin, poses.emplace_back());
        for (std::uint32_t i = 0; i < 2; ++i) {
            tracks[i].mark(walker.state, i, time, clip);
        }
        clip.duration = time;
        for (int i = 0; i < substeps; ++i) {
            walker.step(dt);
        }
        const bool is_there =
            has_arrived(walker.route, walker.state, walker.transform.position, walker.passed);
        stood = is_there ? stood + 1 / rate : 0.0f;
    }
    for (FootTracks& track : tracks) {
        track.foot.finish(clip);
        track.toes.finish(clip);
    }
    std::ranges::stable_sort(clip.contacts, {}, &ClipContact::begin);
    clip.sheets.push_back(make_sheet(skeleton, poses, rate));
    return clip;
}

}  // namespace limn

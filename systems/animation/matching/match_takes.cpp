#include "systems/animation/matching/match_takes.h"

#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/matching/match_root.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// Techniques: char.motion-select

namespace limn {
namespace {

constexpr std::uint16_t kNoJoint = 0xffff;
constexpr float kShortestTake = 1.2f;  // [s]
constexpr float kLowestHips = 0.79f;   // of their height at rest
constexpr float kJerk = 0.14f;         // second difference of places at 60 Hz [leg lengths]

/// One line of the card.
struct Cue {
    float time = 1.0f;   ///< [s]
    float speed = 0.0f;  ///< [m/s]
    float turn = 0.0f;   ///< of the wanted direction, at once [deg]
    float curve = 0.0f;  ///< of the wanted direction [rad/s]
    float aside = 0.0f;  ///< with `faces`: the way, from where it faces [deg]
    bool faces = false;  ///< faces the wanted direction, whatever the way
};

/// Starts, stops, corners and curves at a speed.
void add_speed(float speed, std::vector<Cue>& card) {
    const float go = 1.3f + 0.45f * speed;  // time to be that fast [s]
    const float halt = 0.9f + 0.5f * speed;
    card.push_back({1.3f, 0});
    card.push_back({go, speed});
    for (const float turn : {90.0f, -90.0f, 175.0f, -175.0f}) {
        card.push_back({halt, 0});
        card.push_back({go, speed, turn});
    }
    for (const float turn : {45.0f, -45.0f, 90.0f, -90.0f, 135.0f, -135.0f, 178.0f, -178.0f}) {
        card.push_back({1.2f + 0.4f * speed, speed, turn});
    }
    for (const float curve : {0.4f, -0.4f, 1.0f, -1.0f, 1.8f, -1.8f}) {
        card.push_back({2.0f, speed, 0, curve * std::min(1.0f, 2 / speed)});
    }
    // Stops in all phases of a step.
    for (const float later : {0.0f, 0.09f, 0.18f, 0.27f, 0.36f, 0.45f}) {
        card.push_back({go + later, speed});
        card.push_back({halt, 0});
    }
    card.push_back({0.5f, 0});
}

std::vector<Cue> make_card(float walk, float jog, float run) {
    std::vector<Cue> card;
    for (const float speed : {walk, jog, run}) {
        add_speed(speed, card);
    }
    // Up and down, in other phases of a step each time.
    for (const float more : {0.0f, 0.13f, 0.29f}) {
        for (const float speed :
             {walk, run, walk, jog, run, jog, 0.5f * walk, walk, run, 0.0f, jog}) {
            card.push_back({2.3f + more, speed});
        }
        card.push_back({2.6f + more, 0});
    }
    for (const float turn : {45.0f, -45.0f, 90.0f, -90.0f, 175.0f, -175.0f}) {
        card.push_back({1.7f, 0, turn, 0, 0, true});
    }
    for (const float aside : {90.0f, -90.0f, 180.0f, 45.0f, -45.0f}) {
        card.push_back({2.0f, 0.7f * walk, 0, 0, aside, true});
        card.push_back({1.2f, 0, 0, 0, 0, true});
    }
    card.push_back({2.5f, 0});
    return card;
}

/// A person who performs.
struct Performer {
    const SkeletonData& skeleton;
    Walk walk;
    WalkBody body;
    MatchRoot root = {};
    WalkState state = {};
    Transform transform = {};
    float direction = 0;  ///< wanted [rad]

    void step(const Cue& cue, float dt) {
        direction += cue.curve * dt;
        const float way = direction + radians(cue.aside);
        MatchWish wish;
        wish.velocity = cue.speed * Vec2(std::sin(way), std::cos(way));
        if (cue.faces) {
            wish.facing = {std::sin(direction), std::cos(direction)};
        }
        step_match_root(wish, dt, root);
        transform.position = {root.place.x, 0, root.place.y};
        transform.rotation = rotation_about({0, 1, 0}, root.heading - body.heading);
        step_walk(walk, {}, body, std::nullopt, dt, state, transform);
    }
    void pose(LocalPose& pose) {
        body.targets = find_walk_targets(body, state, transform);
        pose = skeleton.rest;
        apply_walk(skeleton, walk, state, body, pose);
    }
};

std::vector<std::uint16_t> walking_joints(const WalkBody& body) {
    std::vector<std::uint16_t> joints = {0, body.hips, body.spine, body.chest, body.head};
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkLeg& leg = body.legs[i];
        const WalkArm& arm = body.arms[i];
        joints.insert(joints.end(), {leg.thigh, leg.shin, leg.foot, leg.toes});
        joints.insert(joints.end(), {arm.upper, arm.fore});
    }
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
    joints.erase(std::find(joints.begin(), joints.end(), kNoJoint), joints.end());
    return joints;
}

/// Writes clips while the performer goes on.
class Recorder {
  public:
    Recorder(const WalkBody& body, MatchTake& take) : take_(take), sheet_(take.clip.sheets[0]) {
        sheet_.rotating = walking_joints(body);
        sheet_.translating = {0};
        if (body.hips != 0) {
            sheet_.translating.push_back(body.hips);
        }
    }

    void record(const Performer& performer, LocalPose& pose) {
        const auto key = static_cast<float>(sheet_.times.size());
        const Transform& at = performer.transform;
        const float yaw = performer.root.heading - performer.body.heading;
        pose.translations[0] = at.position + at.rotation * pose.translations[0];
        pose.rotations[0] = at.rotation * pose.rotations[0];
        const std::size_t joints = sheet_.rotating.size();
        for (std::size_t i = 0; i < joints; ++i) {
            const Quat& q = pose.rotations[sheet_.rotating[i]];
            const std::size_t count = sheet_.rotations.size();
            sheet_.rotations.push_back(
                count >= joints ? to_same_hemisphere(sheet_.rotations[count - joints], q) : q);
        }
        for (const std::uint16_t joint : sheet_.translating) {
            sheet_.translations.push_back(pose.translations[joint]);
        }
        const float time = key * kTakeKey;
        sheet_.times.push_back(time);
        take_.clip.duration = time;
        take_.root.push_back({{at.position.x, at.position.z}, yaw});
        for (std::uint32_t foot = 0; foot < 2; ++foot) {
            record_contact(performer, foot, time);
        }
    }

    void finish() {
        auto& contacts = take_.clip.contacts;
        std::stable_sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
            return a.begin < b.begin;
        });
    }

  private:
    void record_contact(const Performer& performer, std::uint32_t foot, float time) {
        const bool planted = flight_progress(performer.state, foot) >= 1;
        auto& contacts = take_.clip.contacts;
        if (planted && !planted_[foot]) {
            open_[foot] = contacts.size();
            contacts.push_back({performer.body.legs[foot].foot, time, time});
        }
        if (planted) {
            contacts[open_[foot]].end = time;
        }
        planted_[foot] = planted;
    }

    MatchTake& take_;
    ClipSheet& sheet_;
    std::array<bool, 2> planted_ = {};
    std::array<std::size_t, 2> open_ = {};
};

/// Frames that an actor would repeat: hips that sink, joints that jerk.
std::vector<bool>
find_mistakes(const SkeletonData& skeleton, const WalkBody& body, const MatchTake& take) {
    const std::vector<float>& times = take.clip.sheets[0].times;
    std::vector<bool> bad(times.size(), false);
    const std::size_t joints = skeleton.joints.size();
    std::array<std::vector<Affine>, 3> last;  // this key's and the two before
    LocalPose pose;
    for (std::size_t key = 0; key < times.size(); ++key) {
        sample_pose(skeleton, &take.clip, times[key], pose, {});
        std::rotate(last.begin(), last.begin() + 2, last.end());
        last[0].resize(joints);
        compute_joint_matrices(skeleton, pose, last[0]);
        const auto place = [&](std::size_t which, std::size_t j) {
            return transform_point(last[which][j], Vec3(0));
        };
        bad[key] = place(0, body.hips).y < kLowestHips * body.hips_place.y;
        for (std::size_t j = 0; j < joints && key > 1 && !bad[key]; ++j) {
            const Vec3 change = place(0, j) - 2.0f * place(1, j) + place(2, j);
            bad[key] = glm::length(change) > kJerk * leg_length(body);
        }
    }
    return bad;
}

/// The keys first <= i < last as a take of its own.
MatchTake copy_keys(const MatchTake& take, std::size_t first, std::size_t last) {
    const ClipSheet& from = take.clip.sheets[0];
    MatchTake part;
    part.clip.name = take.clip.name;
    ClipSheet& sheet = part.clip.sheets.emplace_back();
    sheet.rotating = from.rotating;
    sheet.translating = from.translating;
    const auto copy = [&](const auto& list, std::size_t width, auto& to) {
        const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first * width);
        to.assign(begin, begin + static_cast<std::ptrdiff_t>((last - first) * width));
    };
    copy(from.times, 1, sheet.times);
    copy(from.rotations, from.rotating.size(), sheet.rotations);
    copy(from.translations, from.translating.size(), sheet.translations);
    copy(take.root, 1, part.root);
    const float start = sheet.times.front();
    for (float& time : sheet.times) {
        time -= start;
    }
    part.clip.duration = sheet.times.back();
    for (ClipContact contact : take.clip.contacts) {
        contact.begin = std::max(contact.begin - start, 0.0f);
        contact.end = std::min(contact.end - start, part.clip.duration);
        if (contact.begin <= contact.end) {
            part.clip.contacts.push_back(contact);
        }
    }
    return part;
}

/// What is left between mistakes.
std::vector<MatchTake>
cut_take(const SkeletonData& skeleton, const WalkBody& body, const MatchTake& take) {
    const std::vector<bool> bad = find_mistakes(skeleton, body, take);
    std::vector<MatchTake> parts;
    std::size_t first = 0;
    for (std::size_t key = 0; key <= bad.size(); ++key) {
        if (key < bad.size() && !bad[key]) {
            continue;
        }
        if (key > first && static_cast<float>(key - first) * kTakeKey > kShortestTake) {
            parts.push_back(copy_keys(take, first, key));
        }
        first = key + 1;
    }
    return parts;
}

}  // namespace

std::vector<MatchTake> make_match_takes(const SkeletonData& skeleton, const Walk& walk) {
    MatchTake take;
    take.clip.name = "take";
    Performer performer = {skeleton, walk, find_walk_body(skeleton)};
    if (!performer.body.can_walk) {
        return {};
    }
    performer.walk.moves_root = false;
    take.clip.sheets.emplace_back();
    const float leg = leg_length(performer.body);
    const float fastest = max_walk_speed(leg);
    const float speed = std::min(effective_walk(walk).speed, fastest);
    performer.root.heading = performer.direction = performer.body.heading;
    Recorder recorder(performer.body, take);
    LocalPose pose;
    performer.step({}, 0);
    for (const Cue& cue : make_card(speed, 1.25f * fastest, 1.85f * fastest)) {
        performer.direction += radians(cue.turn);
        const auto keys = static_cast<int>(std::lround(cue.time / kTakeKey));
        for (int key = 0; key < keys; ++key) {
            performer.pose(pose);
            recorder.record(performer, pose);
            performer.step(cue, kTakeKey);
        }
    }
    recorder.finish();
    return cut_take(skeleton, performer.body, take);
}

}  // namespace limn

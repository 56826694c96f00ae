#include "content/make/models/creature_gait.h"

#include "content/models/fox_model.h"
#include "ecs/base/foot_flight.h"
#include "ecs/base/rotation.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr int kKeys = fox::kGaitKeys;

// Angles are measured from straight down, positive toward +z [rad]; pitches rotate about +x,
// positive from forward to down.

/// In the plane of symmetry: z, y.
using Point = Vec2;

using enum CreatureJoint;

Point in_plane(CreatureJoint joint) {
    const Vec3 position = creature_joint(joint);
    return {position.z, position.y};
}

Point turned(const Point& p, float pitch) {
    const float s = std::sin(pitch);
    const float c = std::cos(pitch);
    return {p.y * s + p.x * c, p.y * c - p.x * s};
}

Point hanging(float angle) {
    return {std::sin(angle), -std::cos(angle)};
}

float angle_of(const Point& direction) {
    return std::atan2(direction.x, -direction.y);
}

float wave(float phase) {
    return std::sin(2.0f * kPi * phase);
}

/// `phase` wrapped to 0 .. 1.
float wrapped(float phase) {
    return phase - std::floor(phase);
}

/// A joint of the posed trunk.
struct PosedJoint {
    Point position;
    float pitch = 0.0f;
};

PosedJoint after(const PosedJoint& parent, CreatureJoint from, CreatureJoint to, float pitch) {
    return {parent.position + turned(in_plane(to) - in_plane(from), parent.pitch), pitch};
}

struct Trunk {
    PosedJoint hips;
    PosedJoint spine;
    PosedJoint chest;
};

Trunk pose_trunk(const Gait& gait, float phase) {
    // A run bends most in the suspension phase: legs gathered, then stretched.
    const float bend = gait.flex * std::cos(2.0f * kPi * (phase - 0.92f));
    const float up = gait.bob * std::cos(2.0f * kPi * gait.bobs * (phase - gait.top)) - gait.drop;
    Trunk trunk;
    trunk.hips = {in_plane(Hips) + Point(0, up), -bend};
    trunk.spine = after(trunk.hips, Hips, Spine, 0.2f * bend);
    trunk.chest = after(trunk.spine, Spine, Chest, 0.7f * bend);
    return trunk;
}

/// Position of the foot, and the angle of the last bone before smoothing.
struct FootPath {
    Point position;
    float slope = 0.0f;
    float pitch = 0.0f;
};

FootPath foot_at(const Gait& gait, Leg leg, float phase) {
    const fox::LegInfo& info = fox::kLegInfos[static_cast<std::size_t>(leg)];
    const float half_step = 0.5f * gait.duty * gait.stride;
    const float height = in_plane(info.joints[3]).y;
    if (gait.duty >= 1.0f) {
        const Point rest = in_plane(info.joints[3]);
        return {rest, angle_of(rest - in_plane(info.joints[2])), 0};
    }
    if (const float stand = stance_progress(gait, leg, phase); stand >= 0.0f) {
        return {
            {info.center + half_step * (1.0f - 2.0f * stand), height},
            glm::mix(info.set_down, info.push_off, stand),
            0};
    }
    // In the air: from back to front, matching the speed of the ground at both ends.
    const float air = 1.0f - gait.duty;
    const float since = wrapped(phase - gait.touchdown[static_cast<std::size_t>(leg)]);
    const float s = (since - gait.duty) / air;
    const float slope = -gait.stride * air;
    const float s2 = s * s;
    const float s3 = s2 * s;
    const float z = info.center - half_step + slope * (s3 - 2.0f * s2 + s)
                    + 2.0f * half_step * (3.0f * s2 - 2.0f * s3) + slope * (s3 - s2);
    FootPath path;
    path.position = {z, height + 0.5f * gait.lift * flight_height(s)};
    path.slope = glm::mix(info.push_off, info.set_down, glm::smoothstep(0.2f, 1.0f, s))
                 + info.fold * square(std::sin(kPi * std::pow(s, 0.8f)));
    path.pitch = 1.5f * std::sin(kPi * s) * (1.0f - s);
    return path;
}

/// Smoothed angles of the last bone over a cycle. The foot path is unchanged.
std::array<float, kKeys> smooth_slopes(const Gait& gait, Leg leg) {
    std::array<float, kKeys> slopes{};
    for (int key = 0; key < kKeys; ++key) {
        slopes[key] = foot_at(gait, leg, static_cast<float>(key) / kKeys).slope;
    }
    for (int round = 0; round < 3; ++round) {
        const std::array<float, kKeys> before = slopes;
        for (int key = 0; key < kKeys; ++key) {
            slopes[key] = 0.25f * before[(key + kKeys - 1) % kKeys] + 0.5f * before[key]
                          + 0.25f * before[(key + 1) % kKeys];
        }
    }
    return slopes;
}

using Pitches = std::array<float, kCreatureJoints>;

float& of(Pitches& pitches, CreatureJoint joint) {
    return pitches[static_cast<std::size_t>(joint)];
}

/// Solves the pitches of a leg for the given foot position.
void solve_leg(const fox::LegInfo& leg, const Trunk& trunk, FootPath foot, Pitches& pitches) {
    const PosedJoint& parent = leg.parent == Chest ? trunk.chest : trunk.hips;
    const Point top = after(parent, leg.parent, leg.joints[0], 0).position;
    Point rest[4];
    for (int i = 0; i < 4; ++i) {
        rest[i] = in_plane(leg.joints[i]);
    }
    const float upper = glm::distance(rest[0], rest[1]);
    const float middle = glm::distance(rest[1], rest[2]);
    const float last = glm::distance(rest[2], rest[3]);

    // If out of reach of the two upper bones, the last one rotates toward the body.
    const float straight = angle_of(foot.position - top);
    const float longest = 0.995f * (upper + middle);
    Point ankle = foot.position - last * hanging(foot.slope);
    for (int i = 1; i <= 16 && glm::distance(top, ankle) > longest; ++i) {
        const float slope = glm::mix(foot.slope, straight, static_cast<float>(i) / 16.0f);
        ankle = foot.position - last * hanging(slope);
    }
    const float far =
        glm::clamp(glm::distance(top, ankle), std::abs(upper - middle) * 1.01f, longest);
    const float cosine = (upper * upper + far * far - middle * middle) / (2.0f * upper * far);
    const float first =
        angle_of(ankle - top) + leg.bend * std::acos(glm::clamp(cosine, -1.0f, 1.0f));
    const Point knee = top + upper * hanging(first);
    of(pitches, leg.joints[0]) = angle_of(rest[1] - rest[0]) - first;
    of(pitches, leg.joints[1]) = angle_of(rest[2] - rest[1]) - angle_of(ankle - knee);
    of(pitches, leg.joints[2]) = angle_of(rest[3] - rest[2]) - angle_of(foot.position - ankle);
    of(pitches, leg.joints[3]) = foot.pitch;
}

/// Yaw of the neck, the head and the tail.
float yaw_at(const Gait& gait, CreatureJoint joint, float phase) {
    switch (joint) {
    case Tail:
        return gait.tail * wave(phase);
    case TailTip:
        return gait.tail * wave(phase - 0.15f);
    case Neck:
    case Head:
        return gait.stride > 0 ? 0.0f : 0.16f * wave(phase) + 0.1f * wave(2.0f * phase + 0.1f);
    default:
        return 0.0f;
    }
}

float blink_at(const Gait& gait, float phase) {
    const float when = (gait.stride > 0 ? 24.0f : 15.0f) / kKeys;  // on a key, since it is short
    const float width = 0.16f / gait.period;
    const bool has_blink = gait.period > 0.6f;  // the cycle of a run is too short for one
    return has_blink ? std::max(1.0f - std::abs(phase - when) / width, 0.0f) : 0.0f;
}

/// The pitch of every joint relative to the world.
Pitches pitches_at(
    const Gait& gait, const Trunk& trunk, const std::array<std::array<float, kKeys>, kLegs>& slopes,
    int key) {
    const float phase = static_cast<float>(key) / kKeys;
    Pitches pitches{};
    of(pitches, Hips) = trunk.hips.pitch;
    of(pitches, Spine) = trunk.spine.pitch;
    of(pitches, Chest) = trunk.chest.pitch;
    const float nod = gait.stride > 0 ? 0.05f * wave(gait.bobs * phase) : 0.03f * wave(phase);
    of(pitches, Neck) = gait.crouch + 0.4f * trunk.chest.pitch + nod;
    of(pitches, Head) = 0.15f * gait.crouch + 0.1f * trunk.chest.pitch - nod;
    of(pitches, Jaw) = of(pitches, Head) + (gait.period < 0.6f ? 0.16f : 0.0f);
    const float streaming = gait.period < 0.6f ? -0.3f : 0.1f;
    of(pitches, Tail) = streaming + 0.5f * trunk.hips.pitch + 0.05f * wave(gait.bobs * phase);
    of(pitches, TailTip) = 1.2f * of(pitches, Tail) - 0.08f * wave(gait.bobs * phase - 0.2f);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
        FootPath foot = foot_at(gait, static_cast<Leg>(leg), phase);
        foot.slope = slopes[leg][static_cast<std::size_t>(key % kKeys)];
        solve_leg(fox::kLegInfos[leg], trunk, foot, pitches);
    }
    return pitches;
}

/// Stances of the feet in a clip.
std::vector<ClipContact> stances_of(const Gait& gait) {
    std::vector<ClipContact> contacts;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
        const auto foot = static_cast<std::uint16_t>(fox::kLegInfos[leg].joints[3]);
        const float begin = gait.duty < 1.0f ? gait.touchdown[leg] : 0.0f;
        const float end = begin + std::min(gait.duty, 1.0f);
        contacts.push_back({foot, begin * gait.period, std::min(end, 1.0f) * gait.period});
        if (end > 1.0f) {
            contacts.push_back({foot, 0.0f, (end - 1.0f) * gait.period});
        }
    }
    std::ranges::stable_sort(contacts, {}, &ClipContact::begin);
    return contacts;
}

}  // namespace

std::span<const Gait> creature_gaits() {
    return fox::kGaits;
}

float stance_progress(const Gait& gait, Leg leg, float phase) {
    const float since = wrapped(phase - gait.touchdown[static_cast<std::size_t>(leg)]);
    return since < gait.duty || gait.duty >= 1.0f ? since / gait.duty : -1.0f;
}

ClipData make_gait_clip(const Gait& gait, float scale) {
    ClipData clip;
    clip.name = gait.name;
    clip.duration = gait.period;
    clip.contacts = stances_of(gait);
    ClipSheet& sheet = clip.sheets.emplace_back();
    sheet.translating = {static_cast<std::uint16_t>(Hips)};
    sheet.morphing = {0, 1};
    for (std::uint16_t joint = 0; joint < kCreatureJoints; ++joint) {
        sheet.rotating.push_back(joint);
    }
    std::array<std::array<float, kKeys>, kLegs> slopes;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
        slopes[leg] = smooth_slopes(gait, static_cast<Leg>(leg));
    }
    for (int key = 0; key <= kKeys; ++key) {
        const float phase = static_cast<float>(key % kKeys) / kKeys;
        sheet.times.push_back(gait.period * static_cast<float>(key) / kKeys);
        const Trunk trunk = pose_trunk(gait, phase);
        const Pitches pitches = pitches_at(gait, trunk, slopes, key % kKeys);
        for (std::size_t joint = 0; joint < kCreatureJoints; ++joint) {
            const std::int32_t parent = creature_parent(static_cast<CreatureJoint>(joint));
            const float above = parent < 0 ? 0.0f : pitches[static_cast<std::size_t>(parent)];
            const float yaw = yaw_at(gait, static_cast<CreatureJoint>(joint), phase);
            sheet.rotations.push_back(
                rotation_about({0, 1, 0}, yaw) * rotation_about({1, 0, 0}, pitches[joint] - above));
        }
        sheet.translations.push_back(scale * Vec3(0, trunk.hips.position.y, trunk.hips.position.x));
        sheet.weights.push_back(blink_at(gait, phase));
        sheet.weights.push_back(
            0.5f - 0.5f * std::cos(2.0f * kPi * static_cast<float>(gait.breaths) * phase));
    }
    return clip;
}

}  // namespace limn

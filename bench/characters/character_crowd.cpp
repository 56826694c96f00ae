#include "bench/characters/character_crowd.h"

#include "ecs/base/check.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace limn::bench {
namespace {

constexpr std::size_t kFrames = 61;
constexpr float kRate = 30.0f;

ScalarClip make_scalar_clip(const SkeletonData& skeleton, const ClipData& clip) {
    ScalarClip scalar;
    scalar.joints = skeleton.joints.size();
    scalar.frames = kFrames;
    scalar.rate = kRate;
    LocalPose pose = skeleton.rest;
    for (std::size_t f = 0; f < kFrames; ++f) {
        sample_clip(clip, static_cast<float>(f) / kRate, pose, {});
        for (std::size_t j = 0; j < scalar.joints; ++j) {
            const Quat& q = pose.rotations[j];
            scalar.rotations.insert(scalar.rotations.end(), {q.x, q.y, q.z, q.w});
            const Vec3& t = pose.translations[j];
            scalar.translations.insert(scalar.translations.end(), {t.x, t.y, t.z});
        }
    }
    return scalar;
}

}  // namespace

SkeletonData make_bench_skeleton(std::size_t joints) {
    // Parent of each of the first 24: hips, spine, neck, head, two arms, two legs; then fingers, on
    // both hands in turns, three joints each.
    constexpr std::int32_t kParents[] = {-1, 0,  1, 2,  3,  4,  3, 6,  7,  8,  3,  10,
                                         11, 12, 0, 14, 15, 16, 0, 18, 19, 20, 17, 21};
    constexpr float kLengths[] = {0,     0.1f,  0.15f, 0.15f, 0.2f,  0.12f, 0.15f, 0.12f,
                                  0.28f, 0.25f, 0.15f, 0.12f, 0.28f, 0.25f, 0.1f,  0.42f,
                                  0.42f, 0.12f, 0.1f,  0.42f, 0.42f, 0.12f, 0.1f,  0.1f};
    constexpr std::int32_t kHands[] = {9, 13};
    SkeletonData skeleton;
    skeleton.name = "bench";
    for (std::size_t i = 0; i < joints; ++i) {
        const bool is_finger = i >= std::size(kParents);
        const std::size_t finger = i - std::size(kParents);
        skeleton.joints.push_back("joint " + std::to_string(i));
        skeleton.parents.push_back(
            !is_finger        ? kParents[i]
            : finger % 3 == 0 ? kHands[finger / 3 % 2]
                              : static_cast<std::int32_t>(i) - 1);
        const float down = i >= 14 && i < 24 ? -1.0f : 1.0f;
        const float side = i >= 6 && i < 10 ? 1.0f : i >= 10 && i < 14 ? -1.0f : 0.0f;
        const float length = is_finger ? 0.03f : kLengths[i];
        skeleton.rest.translations.push_back(
            side != 0 ? Vec3(side * length, 0, 0.01f) : Vec3(0.01f, down * length, 0));
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1);
    }
    skeleton.rest.translations[0] = {0, 0.95f, 0};
    return skeleton;
}

ClipData make_bench_clip(const SkeletonData& skeleton, std::uint64_t seed) {
    Random random(seed, 0, name_hash("bench clip"), 0);
    const std::size_t joints = skeleton.joints.size();
    ClipData clip;
    clip.name = "bench";
    clip.duration = static_cast<float>(kFrames - 1) / kRate;
    ClipSheet& sheet = clip.sheets.emplace_back();
    sheet.translating = {0};
    std::vector<Quat> bases;
    std::vector<Vec3> axes[2];
    std::vector<float> phases;
    for (std::size_t j = 0; j < joints; ++j) {
        sheet.rotating.push_back(static_cast<std::uint16_t>(j));
        bases.push_back(rotation_about(random.direction(), random.uniform(0.0f, 1.0f)));
        for (std::vector<Vec3>& axis : axes) {
            axis.push_back(random.direction());
        }
        phases.push_back(random.uniform(0.0f, 2.0f * kPi));
    }
    for (std::size_t f = 0; f < kFrames; ++f) {
        const float time = static_cast<float>(f) / kRate;
        sheet.times.push_back(time);
        for (std::size_t j = 0; j < joints; ++j) {
            const float turn = kPi * time;  // of a period of two seconds
            const float size = j == 0 ? 0.1f : 0.35f;
            sheet.rotations.push_back(
                bases[j] * rotation_about(axes[0][j], size * std::sin(turn + phases[j]))
                * rotation_about(axes[1][j], 0.1f * std::sin(3 * turn + 2 * phases[j])));
        }
        sheet.translations.push_back(
            {0.05f * std::sin(kPi * time), 0.95f + 0.03f * std::sin(2 * kPi * time), 1.4f * time});
    }
    for (std::size_t i = joints; i < sheet.rotations.size(); ++i) {
        sheet.rotations[i] = to_same_hemisphere(sheet.rotations[i - joints], sheet.rotations[i]);
    }
    return clip;
}

BenchCrowd::BenchCrowd(std::size_t joints, std::size_t count)
    : skeleton(make_bench_skeleton(joints)), rig(make_crowd_rig(skeleton)) {
    Random random(1, 0, name_hash("bench crowd"), 0);
    for (std::uint64_t i = 0; i < kBenchClips; ++i) {
        const ClipData clip = make_bench_clip(skeleton, i);
        Result<CrowdClip> packed = make_crowd_clip(skeleton, clip, scale_limits(skeleton));
        LIMN_CHECK(packed);
        clips.push_back(*std::move(packed));
        scalar_clips.push_back(make_scalar_clip(skeleton, clip));
    }
    for (std::size_t j = 0; j < joints; ++j) {
        bind.push_back(
            affine_from(random.direction(), rotation_about(random.direction(), 0.5f), Vec3(1)));
    }
    const float end = clips[0].duration;
    for (std::size_t i = 0; i < count; ++i) {
        members.push_back(
            {random.word() % kBenchClips, random.word() % kBenchClips, random.uniform(0.0f, end),
             random.uniform(0.0f, end), random.uniform()});
    }
    matrices.resize(count * joints);
}

std::vector<CrowdCharacter> BenchCrowd::characters() {
    std::vector<CrowdCharacter> all;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Member& member = members[i];
        all.push_back(
            {&clips[member.clip], member.time, &clips[member.next], member.next_time, member.weight,
             matrices_of(i)});
    }
    return all;
}

void pose_by_hand(BenchCrowd& crowd, std::vector<float>& buffer) {
    const std::size_t joints = crowd.joints();
    buffer.resize(joints * 33);
    float* const qa = buffer.data();
    float* const qb = qa + 4 * joints;
    float* const ta = qb + 4 * joints;
    float* const tb = ta + 3 * joints;
    float* const model = tb + 3 * joints;
    for (std::size_t i = 0; i < crowd.members.size(); ++i) {
        const BenchCrowd::Member& member = crowd.members[i];
        sample_scalar(crowd.scalar_clips[member.clip], member.time, qa, ta);
        sample_scalar(crowd.scalar_clips[member.next], member.next_time, qb, tb);
        blend_scalar(qa, ta, qb, tb, member.weight, joints, qa, ta);
        multiply_scalar(crowd.skeleton.parents.data(), qa, ta, joints, model);
        skin_scalar(model, &crowd.bind[0].row[0].x, joints, &crowd.matrices_of(i)->row[0].x);
    }
}

}  // namespace limn::bench

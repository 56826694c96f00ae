#pragma once

#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/skeleton.h"
#include "systems/animation/crowd_clip.h"
#include "systems/animation/pose_chain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::test {

/// A random tree of joints about a decimeter apart, up to a dozen deep.
inline SkeletonData make_tree(std::size_t joints, std::uint64_t seed) {
    Random random(seed, 0, name_hash("tree"), 0);
    SkeletonData skeleton;
    skeleton.name = "tree";
    for (std::size_t i = 0; i < joints; ++i) {
        skeleton.joints.push_back("joint " + std::to_string(i));
        const std::size_t back = random.below(6) + 1;
        skeleton.parents.push_back(i == 0 ? -1 : static_cast<std::int32_t>(i - std::min(back, i)));
        skeleton.rest.translations.push_back(0.12f * random.direction());
        skeleton.rest.rotations.push_back(
            rotation_about(random.direction(), random.uniform(0.0f, 3.0f)));
        skeleton.rest.scales.emplace_back(1);
    }
    return skeleton;
}

/// Two seconds of smooth motion at 30 keys a second: all joints turn, or three of eight, and the
/// root moves.
inline ClipData
make_motion(const SkeletonData& skeleton, std::uint64_t seed, bool all_joints = false) {
    Random random(seed, 0, name_hash("motion"), 0);
    ClipData clip;
    clip.name = "motion";
    clip.duration = 2.0f;
    ClipSheet sheet;
    for (std::size_t key = 0; key <= 60; ++key) {
        sheet.times.push_back(static_cast<float>(key) / 30.0f);
    }
    sheet.translating = {0};
    std::vector<Vec3> axes;
    std::vector<float> phases;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        if (all_joints || j % 8 < 3) {
            sheet.rotating.push_back(static_cast<std::uint16_t>(j));
            axes.push_back(random.direction());
            phases.push_back(random.uniform(0.0f, 6.0f));
        }
    }
    for (const float time : sheet.times) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            // The first joint turns around once.
            const float angle = i == 0 ? kPi * time : 0.3f * std::sin(kPi * time + phases[i]);
            const Quat& rest = skeleton.rest.rotations[sheet.rotating[i]];
            sheet.rotations.push_back(rest * rotation_about(axes[i], angle));
        }
        sheet.translations.push_back({0.1f * std::sin(kPi * time), 0.9f, 1.3f * time});
    }
    const std::size_t width = sheet.rotating.size();
    for (std::size_t i = width; i < sheet.rotations.size(); ++i) {
        sheet.rotations[i] = to_same_hemisphere(sheet.rotations[i - width], sheet.rotations[i]);
    }
    clip.sheets.push_back(sheet);
    return clip;
}

inline bool same_bits(const Affine& a, const Affine& b) {
    return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2];
}

/// Characters at random times of three clips, every other one blending into another.
struct TestCrowd {
    SkeletonData skeleton;
    CrowdRig rig;
    std::vector<ClipData> sources;
    std::vector<CrowdClip> clips;
    std::vector<CrowdCharacter> characters;
    std::vector<std::vector<Affine>> joints;

    TestCrowd(std::size_t joint_count, std::size_t count)
        : skeleton(make_tree(joint_count, joint_count)), rig(make_crowd_rig(skeleton)),
          joints(count, std::vector<Affine>(joint_count)) {
        for (std::uint64_t i = 0; i < 3; ++i) {
            sources.push_back(make_motion(skeleton, i));
            Result<CrowdClip> clip =
                make_crowd_clip(skeleton, sources.back(), scale_limits(skeleton));
            clips.push_back(clip ? *std::move(clip) : CrowdClip{});
        }
        Random random(count, 0, name_hash("crowd"), 0);
        for (std::size_t i = 0; i < count; ++i) {
            characters.push_back(
                {&clips[i % 3], random.uniform(0.0f, 2.0f),
                 i % 2 == 0 ? &clips[(i + 1) % 3] : nullptr, random.uniform(0.0f, 2.0f),
                 random.uniform(), joints[i].data()});
        }
    }
};

}  // namespace limn::test

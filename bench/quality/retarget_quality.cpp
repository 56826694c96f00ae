#include "bench/oracles/walker_motion.h"
#include "bench/quality/characters_quality.h"
#include "bench/quality/quality_scene.h"
#include "content/bake/motion/body_retarget.h"
#include "content/load/motion/bone_figure.h"
#include "content/load/motion/bvh_export.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/components/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

// Techniques: char.bvh-format, char.retarget-body

namespace limn::retarget_quality {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr BodyPart kEffectors[] = {BodyPart::LeftHand,  BodyPart::RightHand, BodyPart::LeftFoot,
                                   BodyPart::RightFoot, BodyPart::LeftToes,  BodyPart::RightToes,
                                   BodyPart::Head};

using DPositions = std::vector<std::vector<glm::dvec3>>;  // of all joints, by key

/// Kinematics in double precision at the keys of the clip.
DPositions exact_positions(const SkeletonData& skeleton, const ClipData& clip) {
    DPositions positions;
    const ClipSheet& sheet = clip.sheets[0];
    for (std::size_t key = 0; key < sheet.times.size(); ++key) {
        std::vector<glm::dquat> turns(
            skeleton.rest.rotations.begin(), skeleton.rest.rotations.end());
        std::vector<glm::dvec3> shifts(
            skeleton.rest.translations.begin(), skeleton.rest.translations.end());
        for (std::size_t i = 0; i < sheet.rotating.size(); ++i) {
            turns[sheet.rotating[i]] = sheet.rotations[key * sheet.rotating.size() + i];
        }
        for (std::size_t i = 0; i < sheet.translating.size(); ++i) {
            shifts[sheet.translating[i]] = sheet.translations[key * sheet.translating.size() + i];
        }
        std::vector<glm::dquat> rotations;
        std::vector<glm::dvec3>& row = positions.emplace_back();
        for (std::size_t j = 0; j < turns.size(); ++j) {
            const std::int32_t parent = skeleton.parents[j];
            const auto p = static_cast<std::size_t>(std::max(parent, 0));
            const glm::dquat outer = parent < 0 ? glm::dquat(1, 0, 0, 0) : rotations[p];
            const glm::dvec3 origin = parent < 0 ? glm::dvec3(0) : row[p];
            row.push_back(origin + outer * shifts[j]);
            rotations.push_back(outer * glm::normalize(turns[j]));
        }
    }
    return positions;
}

/// Largest distance between the effectors of two bodies, of all keys [mm].
double effector_error(
    const SkeletonData& source, const DPositions& expected, const SkeletonData& target,
    const DPositions& found) {
    const BodyJoints from = find_body_joints(source);
    const BodyJoints to = find_body_joints(target);
    double largest = 0;
    for (std::size_t key = 0; key < expected.size(); ++key) {
        for (const BodyPart part : kEffectors) {
            largest =
                std::max(largest, glm::distance(expected[key][from[part]], found[key][to[part]]));
        }
    }
    return 1000 * largest;
}

/// Longest way of an ankle from where its plant begins, of all plants [mm].
double
slide_of(const SkeletonData& skeleton, const ClipData& clip, const oracle::RecordedWalk& walk) {
    const BodyJoints source = find_body_joints(walk.motion.skeleton);
    const BodyJoints body = find_body_joints(skeleton);
    const DPositions positions = exact_positions(skeleton, clip);
    const std::vector<float>& times = clip.sheets[0].times;
    double largest = 0;
    for (const ClipContact& plant : walk.plants) {
        const bool is_left = plant.joint == source[BodyPart::LeftFoot];
        const std::uint16_t foot = body[is_left ? BodyPart::LeftFoot : BodyPart::RightFoot];
        std::size_t first = times.size();
        for (std::size_t key = 0; key < times.size(); ++key) {
            if (times[key] > plant.begin - 1e-3f && times[key] < plant.end + 1e-3f) {
                first = std::min(first, key);
                largest =
                    std::max(largest, glm::distance(positions[key][foot], positions[first][foot]));
            }
        }
    }
    return 1000 * largest;
}

/// An image of the bones at `time` from the side.
ColorImage draw_bones(HeadlessRenderer& headless, const SkeletonMotion& motion, float time) {
    const GltfScene figure = make_motion_scene("walker", motion);
    const LocalPose pose = sample_motion(figure.skeleton, figure.clips[0], time);
    const std::vector<Affine> joints = find_frame_joints(
        figure.skeleton, {1, pose.size(), pose.translations, pose.rotations, pose.scales}, 0);
    QualityScene scene;
    add_daylight(scene);
    for (std::size_t m = 0; m < figure.meshes.size(); ++m) {
        MeshData mesh = figure.meshes[m];
        mesh.bounds = {};
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const std::uint16_t joint = mesh.skin.joints[v];
            const Affine moved =
                joints[figure.skins[0].joints[joint]] * figure.skins[0].joint_from_mesh[joint];
            mesh.positions[v] = transform_point(moved, mesh.positions[v]);
            mesh.normals[v] = normalize_or(transform_vector(moved, mesh.normals[v]), {0, 1, 0});
            grow(mesh.bounds, mesh.positions[v]);
        }
        mesh.skin = {};
        scene.place(scene.add(std::move(mesh)), scene.add(figure.materials[m]), Affine{});
    }
    const Vec3 hips = transform_point(joints[1], Vec3(0));
    const RenderView view = quality_view(
        hips + Vec3(1.9f, 0.2f, 1.2f), hips - Vec3(0, 0.05f, 0), kWidth, kHeight, 0.75f);
    return displayed(scene.radiance(headless, view, 4));
}

ClipData
retargeted(const oracle::RecordedWalk& walk, const SkeletonData& target, bool pins = true) {
    SkeletonMotion source = walk.motion;
    source.clip.contacts = walk.plants;
    RetargetOptions options;
    options.pin_feet = pins;
    return retarget_motion(source, target, options).value();
}

Status measure_retarget(HeadlessRenderer& headless, QualityReport& report) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const SkeletonData& source = walk.motion.skeleton;
    const DPositions expected = exact_positions(source, walk.motion.clip);
    const auto error_on = [&](const SkeletonData& target) {
        return effector_error(
            source, expected, target, exact_positions(target, retargeted(walk, target)));
    };
    report.at_most("end effectors on an identical body", error_on(source), 0.01, "mm");
    const SkeletonData other = oracle::make_walker(
        {.arms = radians(50.0f),
         .has_bone_axes = true,
         .sides = {"left_", "right_"},
         .limbs = {"thigh", "shin", "ankle", "toe", "upperarm", "lowerarm", "wrist"}});
    report.at_most(
        "end effectors on an equal body with other names and axes, in an A-pose", error_on(other),
        10, "mm");
    SkeletonData large = source;
    for (Vec3& t : large.rest.translations) {
        t *= 1.7f;
    }
    DPositions scaled = expected;
    for (auto& row : scaled) {
        for (glm::dvec3& p : row) {
            p *= static_cast<double>(1.7f);
        }
    }
    report.at_most(
        "end effectors on a body 1.7 times as large",
        effector_error(source, scaled, large, exact_positions(large, retargeted(walk, large))),
        0.02, "mm");
    const SkeletonData short_shins =
        oracle::make_walker({.thigh = 0.5f, .shin = 0.3f, .ankle = 0.06f});
    const SkeletonData long_thighs = oracle::make_walker({.thigh = 0.66f, .shin = 0.22f});
    report.at_most(
        "slide of planted feet, shins 30 % shorter",
        slide_of(short_shins, retargeted(walk, short_shins), walk), 1, "mm");
    report.at_most(
        "slide of planted feet, half as long shins, longer thighs",
        slide_of(long_thighs, retargeted(walk, long_thighs), walk), 1, "mm");
    report.inform(
        "the same without pins", slide_of(long_thighs, retargeted(walk, long_thighs, false), walk),
        "mm");

    const BvhFile file = make_bvh_file(walk.motion, 60);
    const SkeletonMotion again =
        LIMN_TRY(make_bvh_motion(file, "walk", {.scale = 0.01f, .up = BvhUp::Y}));
    report.at_most(
        "end effectors after writing and reading BVH",
        effector_error(
            source, expected, again.skeleton, exact_positions(again.skeleton, again.clip)),
        0.01, "mm");

    QualityImage image;
    image.title = "a walk on an A-pose with other axes, and where it was recorded";
    image.effect = draw_bones(headless, {other, retargeted(walk, other)}, 1.3f);
    image.oracle = draw_bones(headless, walk.motion, 1.3f);
    report.at_least(
        "image of the equal body against the recorded one", psnr(image.effect, image.oracle), 30,
        "dB");
    report.images.push_back(std::move(image));
    report.images.push_back(
        {"the same walk on legs of 0.66 + 0.22 m",
         draw_bones(headless, {long_thighs, retargeted(walk, long_thighs)}, 1.3f)});
    return Done{};
}

const RegisterCharacterPart kRetargetPart("retarget", measure_retarget);

}  // namespace
}  // namespace limn::retarget_quality

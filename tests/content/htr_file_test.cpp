#include "content/bake/motion/skeleton_motion.h"
#include "content/load/motion/bvh_motion.h"
#include "content/load/motion/htr_file.h"
#include "ecs/base/rng.h"
#include "systems/animation/clip_sampling.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <string>
#include <vector>

namespace limn::htr_file_test {
namespace {

std::vector<Affine> joints_at(const SkeletonMotion& motion, float time) {
    LocalPose pose = motion.skeleton.rest;
    sample_clip(motion.clip, time, pose, {});
    std::vector<Affine> matrices(pose.size());
    compute_joint_matrices(motion.skeleton, pose, matrices);
    return matrices;
}

Vec3 position(const Affine& matrix) {
    return transform_point(matrix, Vec3(0));
}

/// Three bones with random rotations, as BVH.
BvhFile make_bvh() {
    using enum BvhChannel;
    Random random(3, 1, 4, 1);
    BvhFile bvh;
    bvh.joints = {
        {"Hips",
         -1,
         {0, 0, 0},
         false,
         0,
         {Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation}},
        {"Spine", 0, {0, 200, 10}, false, 6, {Zrotation, Xrotation, Yrotation}},
        {"Arm", 1, {150, 30, 0}, false, 9, {Zrotation, Xrotation, Yrotation}}};
    bvh.frame_time = 0.02f;
    bvh.frames = 5;
    for (std::size_t i = 0; i < 12 * bvh.frames; ++i) {
        bvh.values.push_back(300 * (random.uniform() - 0.5f));
    }
    return bvh;
}

/// The same as HTR, with a scale of the spine.
std::string write_htr(const BvhFile& bvh, float spine_scale) {
    std::string text = "#Comment\n[Header]\nFileType htr\nNumSegments 3\nNumFrames 5\n"
                       "DataFrameRate 50\nEulerRotationOrder ZXY\nCalibrationUnits mm\n"
                       "RotationUnits Degrees\nGlobalAxisofGravity Y\n"
                       "[SegmentNames&Hierarchy]\nHips GLOBAL\nSpine\tHips # back\nArm Spine\n"
                       "[BasePosition]\n";
    for (const BvhJoint& joint : bvh.joints) {
        text += joint.name;
        for (int axis = 0; axis < 3; ++axis) {
            text += " " + std::to_string(joint.offset[axis]);
        }
        text += " 0 0 0 100\n";
    }
    for (const BvhJoint& joint : bvh.joints) {
        text += "[" + joint.name + "]\n";
        for (std::size_t f = 0; f < bvh.frames; ++f) {
            const float* const row = bvh.values.data() + 12 * f + joint.first_value;
            const bool is_root = joint.parent < 0;
            const float* const turn = is_root ? row + 3 : row;
            text += std::to_string(f + 1);
            for (int axis = 0; axis < 3; ++axis) {
                text += " " + std::to_string(is_root ? row[axis] : 0.0f);
            }
            text += " " + std::to_string(turn[1]) + " " + std::to_string(turn[2]) + " "
                    + std::to_string(turn[0]) + " "
                    + std::to_string(joint.name == "Spine" ? spine_scale : 1.0f) + "\n";
        }
    }
    return text + "[EndOfFile]\nnothing here is read\n";
}

SkeletonMotion read(const std::string& text) {
    const Result<SkeletonMotion> motion = parse_htr(text, "take.htr");
    REQUIRE_MESSAGE(motion.ok(), (motion ? "" : motion.error().message));
    return *motion;
}

std::string error_with(const std::string& from, const std::string& to) {
    std::string text = write_htr(make_bvh(), 1);
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
    const Result<SkeletonMotion> motion = parse_htr(text, "take.htr");
    return motion ? "none" : motion.error().message;
}

}  // namespace

TEST_CASE(
    "HTR file: with all scales 1 it has the poses of the equal BVH file"
    * technique("char.htr-format")) {
    const BvhFile bvh = make_bvh();
    const SkeletonMotion expected =
        *make_bvh_motion(bvh, "take", {.scale = 0.001f, .up = BvhUp::Y});
    const SkeletonMotion found = read(write_htr(bvh, 1));
    CHECK(found.skeleton.joints == expected.skeleton.joints);
    CHECK(found.skeleton.parents == expected.skeleton.parents);
    CHECK(found.clip.duration == expected.clip.duration);
    for (const float time : {0.0f, 0.03f, 0.08f}) {
        const std::vector<Affine> a = joints_at(found, time);
        const std::vector<Affine> b = joints_at(expected, time);
        for (std::size_t j = 0; j < 3; ++j) {
            for (int row = 0; row < 3; ++row) {
                CHECK(glm::distance(a[j].row[row], b[j].row[row]) < 2e-6f);
            }
        }
    }
}

TEST_CASE(
    "HTR file: a scale multiplies the offsets of children and the skin"
    * technique("char.htr-format")) {
    const std::vector<Affine> plain = joints_at(read(write_htr(make_bvh(), 1)), 0.04f);
    const std::vector<Affine> scaled = joints_at(read(write_htr(make_bvh(), 1.5f)), 0.04f);
    CHECK(glm::distance(position(scaled[1]), position(plain[1])) < 1e-6f);
    const Vec3 arm = position(plain[2]) - position(plain[1]);
    CHECK(glm::distance(position(scaled[2]) - position(scaled[1]), 1.5f * arm) < 1e-5f);
    const Vec3 skin = transform_vector(plain[1], {0.1f, 0, 0});
    CHECK(glm::distance(transform_vector(scaled[1], {0.1f, 0, 0}), 1.5f * skin) < 1e-6f);
}

TEST_CASE(
    "HTR file: errors have the line, what was found and what was expected"
    * technique("char.htr-format")) {
    CHECK(error_with("Spine\tHips", "Spine\tHip")
              .starts_with("take.htr:13: found the parent \"Hip\""));
    CHECK(
        error_with("Hips GLOBAL", "Hips Arm")
        == "take.htr: found parents in a cycle, expected a tree below GLOBAL");
    CHECK(
        error_with("Arm Spine", "Spine Hips").find("found the segment \"Spine\" again")
        != std::string::npos);
    CHECK(error_with("ZXY", "ZXX").starts_with("take.htr:7: EulerRotationOrder: found \"ZXX\""));
    CHECK(
        error_with("DataFrameRate 50", "DataFrameRate 0").starts_with("take.htr:6: DataFrameRate"));
    CHECK(error_with("CalibrationUnits mm", "CalibrationUnits ell").starts_with("take.htr:8:"));
    CHECK(error_with("[Arm]", "[Leg]").find("found the section \"Leg\"") != std::string::npos);
    CHECK(
        error_with("\n2 ", "\n3 ").find("found frame \"3\" of \"Hips\", expected 2")
        != std::string::npos);
    CHECK(
        error_with("0 0 0 100", "0 0 x 100").find("found \"x\" as number 6") != std::string::npos);
    CHECK(error_with("0 0 0 100", "0 0 0").find("found nothing as number 7") != std::string::npos);
    CHECK(
        error_with("[BasePosition]\nHips 0", "[BasePosition]\nHip 0").find("expected a segment")
        != std::string::npos);
    CHECK(
        error_with("[EndOfFile]\n", "6 0 0 0 0 0 0 1\n[EndOfFile]\n")
            .find("found 6 frames of \"Arm\", expected 5")
        != std::string::npos);
    CHECK(!parse_htr("", "take.htr").ok());
    CHECK(
        parse_htr("walk\n", "take.htr").error().message
        == "take.htr:1: found \"walk\", expected [Header]");
}

}  // namespace limn::htr_file_test

#include "bench/oracles/walker_motion.h"
#include "content/bake/motion/body_retarget.h"
#include "content/load/motion/bvh_motion.h"
#include "ecs/base/limb_reach.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::body_retarget_test {

using test::near;

namespace {

SkeletonData scaled(SkeletonData skeleton, float factor) {
    for (Vec3& t : skeleton.rest.translations) {
        t *= factor;
    }
    return skeleton;
}

ClipData retargeted(
    const SkeletonMotion& source, const SkeletonData& target, const RetargetOptions& options = {},
    RetargetReport* report = nullptr) {
    const Result<ClipData> clip = retarget_motion(source, target, options, report);
    REQUIRE_MESSAGE(clip.ok(), (clip ? "" : clip.error().message));
    CHECK(check_clip(*clip, target.joints.size(), 0).ok());
    return *clip;
}

/// Positions of all joints in all frames at 60 per second.
std::vector<std::vector<Vec3>> positions_of(const SkeletonMotion& motion) {
    const MotionFrames frames = sample_frames(motion, 60);
    std::vector<std::vector<Vec3>> positions;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        std::vector<Vec3>& row = positions.emplace_back();
        for (const Affine& joint : find_frame_joints(motion.skeleton, frames, f)) {
            row.push_back(transform_point(joint, Vec3(0)));
        }
    }
    return positions;
}

float largest_difference(
    const std::vector<std::vector<Vec3>>& a, const std::vector<std::vector<Vec3>>& b,
    float factor = 1) {
    REQUIRE(a.size() == b.size());
    float largest = 0;
    for (std::size_t f = 0; f < a.size(); ++f) {
        REQUIRE(a[f].size() == b[f].size());
        for (std::size_t j = 0; j < a[f].size(); ++j) {
            largest = std::max(largest, glm::distance(factor * a[f][j], b[f][j]));
        }
    }
    return largest;
}

/// Longest way of an ankle during the plants of the walk, of the leg's length.
float slide_of(
    const ClipData& clip, const SkeletonData& skeleton, const oracle::RecordedWalk& walk) {
    const BodyJoints source = find_body_joints(walk.motion.skeleton);
    const BodyJoints body = find_body_joints(skeleton);
    std::vector<ClipContact> plants = walk.plants;
    for (ClipContact& plant : plants) {
        const bool is_left = plant.joint == source[BodyPart::LeftFoot];
        plant.joint = body[is_left ? BodyPart::LeftFoot : BodyPart::RightFoot];
    }
    const MotionFrames frames = sample_frames({skeleton, clip}, 60);
    return find_slide(skeleton, frames, plants) / find_leg_length(skeleton, body);
}

const oracle::WalkerShape kShortShins = {.thigh = 0.5f, .shin = 0.3f, .ankle = 0.06f};

}  // namespace

TEST_CASE(
    "two links: the tip meets a target in reach, straight or folded, and points at others"
    * technique("char.retarget-body")) {
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 root = random.direction();
        const Vec3 middle = root + (0.2f + random.uniform()) * random.direction();
        const Vec3 along = i % 3 == 0 ? glm::normalize(middle - root) : random.direction();
        const Vec3 tip = middle + (0.2f + random.uniform()) * along;
        const float a = glm::distance(root, middle);
        const float b = glm::distance(middle, tip);
        const float range = (1.3f * random.uniform()) * (a + b);
        const Vec3 aim = random.direction();
        const Vec3 hinge = any_perpendicular(glm::normalize(middle - root));
        const TwoLinkTurns turns =
            reach_with_two_links(root, middle, tip, root + range * aim, hinge);
        const Vec3 new_middle = root + turns.root * (middle - root);
        const Vec3 new_tip = new_middle + turns.root * (turns.middle * (tip - middle));
        const float reach = std::clamp(range, std::abs(a - b), a + b);
        CHECK(glm::distance(new_tip, root + reach * aim) < 1e-3f);
        CHECK(glm::distance(new_middle, root) == near(a));
        CHECK(glm::distance(new_tip, new_middle) == near(b));
    }
    CHECK(reach_with_two_links({}, {}, {}, {1, 0, 0}, {1, 0, 0}).root == Quat(1, 0, 0, 0));
}

TEST_CASE("two links: a straight leg bends its knee forward" * technique("char.retarget-body")) {
    const TwoLinkTurns turns =
        reach_with_two_links({0, 1, 0}, {0, 0.5f, 0}, {0, 0, 0}, {0, 0.2f, 0}, {1, 0, 0});
    CHECK((turns.root * Vec3(0, -0.5f, 0)).z > 0.1f);
}

TEST_CASE(
    "body retarget: an identical skeleton gets the identical clip"
    * technique("char.retarget-body")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker({.has_bone_axes = true}));
    walk.motion.clip.contacts = {// of a foot that does move
                                 {walk.plants[0].joint, 0, walk.motion.clip.duration}};
    const ClipData clip = retargeted(walk.motion, walk.motion.skeleton);
    CHECK(
        largest_difference(positions_of(walk.motion), positions_of({walk.motion.skeleton, clip}))
        < 2e-6f);
    for (const float time : {0.0f, 0.513f, 1.7f}) {
        const LocalPose a = sample_motion(walk.motion.skeleton, walk.motion.clip, time);
        const LocalPose b = sample_motion(walk.motion.skeleton, clip, time);
        for (std::size_t j = 0; j < a.size(); ++j) {
            CHECK(std::abs(glm::dot(a.rotations[j], b.rotations[j])) > 1 - 1e-6f);
            CHECK(glm::distance(a.translations[j], b.translations[j]) < 2e-6f);
        }
    }
}

TEST_CASE(
    "body retarget: on a larger copy all positions are larger" * technique("char.retarget-body")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    for (const float factor : {0.4f, 2.5f}) {
        const SkeletonData target = scaled(walk.motion.skeleton, factor);
        RetargetReport report;
        const ClipData clip = retargeted(walk.motion, target, {}, &report);
        CHECK(report.scale == near(static_cast<double>(factor)));
        CHECK(
            largest_difference(positions_of(walk.motion), positions_of({target, clip}), factor)
            < 1e-5f * factor);
    }
}

TEST_CASE(
    "body retarget: planted feet stay, and slide without inverse kinematics"
    * technique("char.retarget-body")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const SkeletonData target = oracle::make_walker(kShortShins);
    RetargetReport report;
    const ClipData clip = retargeted(walk.motion, target, {}, &report);
    CHECK(report.contacts >= 6);
    CHECK(report.slide_before > 0.01f);
    CHECK(report.slide < 1e-3f * 0.8f);
    walk.motion.clip.contacts = walk.plants;
    const ClipData known = retargeted(walk.motion, target);
    CHECK(slide_of(known, target, walk) < 1e-3f);
    const ClipData control = retargeted(walk.motion, target, {.pin_feet = false});
    CHECK(slide_of(control, target, walk) > 1e-2f);
}

TEST_CASE(
    "body retarget: feet stand on the ground with ankles of their own height"
    * technique("char.retarget-body")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    walk.motion.clip.contacts = walk.plants;
    for (const float ankle : {0.05f, 0.14f}) {
        oracle::WalkerShape shape = kShortShins;
        shape.ankle = ankle;
        const SkeletonData target = oracle::make_walker(shape);
        const ClipData clip = retargeted(walk.motion, target);
        const std::uint16_t foot = find_body_joints(target)[BodyPart::LeftFoot];
        const LocalPose pose = sample_motion(target, clip, 1.3f);
        std::vector<Affine> joints;
        const MotionFrames frames = {
            1, target.joints.size(), pose.translations, pose.rotations, pose.scales};
        CHECK(
            transform_point(find_frame_joints(target, frames, 0)[foot], Vec3(0)).y
            == near(static_cast<double>(ankle)).epsilon(0.02).scale(1));
    }
}

TEST_CASE(
    "body retarget: a recording with its hips at the origin stands on the ground"
    * technique("char.retarget-body")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const SkeletonData target = oracle::make_walker(kShortShins);
    const ClipData expected = retargeted(walk.motion, target);
    // Rest and motion lower, then the rest pose alone, as most BVH files have it.
    const Vec3 down(0, -walk.motion.skeleton.rest.translations[0].y, 0);
    walk.motion.skeleton.rest.translations[0] += down;
    for (const bool moves : {true, false}) {
        SkeletonMotion lower = walk.motion;
        for (Vec3& t : lower.clip.sheets[0].translations) {
            t += moves ? down : Vec3(0);
        }
        CHECK(
            largest_difference(
                positions_of({target, expected}), positions_of({target, retargeted(lower, target)}))
            < 0.02f);  // the soles, which no joint shows, are 2 cm below the toes
        const ClipData same = retargeted(lower, lower.skeleton);
        CHECK(
            largest_difference(positions_of(lower), positions_of({lower.skeleton, same})) < 3e-6f);
    }
}

TEST_CASE(
    "body retarget: where the leg is too short the hips are lowered"
    * technique("char.retarget-body")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    walk.motion.clip.contacts = walk.plants;
    // Feet that stay on the ground for longer than they were: the hips go on.
    for (ClipContact& contact : walk.motion.clip.contacts) {
        contact.end = std::min(contact.end + 0.25f, walk.motion.clip.duration);
    }
    const SkeletonData target = oracle::make_walker({.thigh = 0.6f, .shin = 0.28f});
    RetargetReport report;
    const ClipData clip = retargeted(walk.motion, target, {}, &report);
    CHECK(report.lowered > 0.005f);
    CHECK(report.slide < 1e-3f * 0.88f);
    CHECK(slide_of(clip, target, walk) < 1e-3f);
    const MotionFrames frames = sample_frames({target, clip}, 60);
    const std::vector<Vec3> hips = joint_path(target, frames, 0);
    for (std::size_t f = 2; f < hips.size(); ++f) {  // no jerk
        CHECK(glm::length(hips[f] - 2.0f * hips[f - 1] + hips[f - 2]) < 4e-3f);
    }
}

TEST_CASE(
    "body retarget: names, axes and rest poses of other programs give the same motion"
    * technique("char.retarget-body")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const auto expected = positions_of(walk.motion);
    const BodyJoints from = find_body_joints(walk.motion.skeleton);
    const oracle::WalkerShape shapes[] = {
        {.has_bone_axes = true},
        {.arms = radians(50.0f)},
        {.arms = radians(50.0f), .has_bone_axes = true},
        {.sides = {"left_", "right_"},
         .limbs = {"thigh", "shin", "ankle", "toe", "upperarm", "lowerarm", "wrist"}}};
    for (const oracle::WalkerShape& shape : shapes) {
        const SkeletonData target = oracle::make_walker(shape);
        const BodyJoints to = find_body_joints(target);
        const auto found = positions_of({target, retargeted(walk.motion, target)});
        for (const BodyPart part :
             {BodyPart::LeftHand, BodyPart::RightHand, BodyPart::LeftFoot, BodyPart::RightToes,
              BodyPart::Head}) {
            REQUIRE(to.has(part));
            float largest = 0;
            for (std::size_t f = 0; f < expected.size(); ++f) {
                largest =
                    std::max(largest, glm::distance(expected[f][from[part]], found[f][to[part]]));
            }
            CHECK(largest < 2e-3f);
        }
    }
}

TEST_CASE(
    "body retarget: a back with more joints bends as much" * technique("char.retarget-body")) {
    SkeletonMotion bow;
    bow.skeleton = oracle::make_walker({.back = 2});
    ClipSheet sheet;
    sheet.times = {0, 1};
    sheet.rotating = {1, 2};
    const Quat bent = rotation_about({1, 0, 0}, 0.4f);
    sheet.rotations = {Quat(1, 0, 0, 0), Quat(1, 0, 0, 0), bent, bent};
    bow.clip = {.name = "bow", .duration = 1, .sheets = {sheet}};
    const SkeletonData target = oracle::make_walker({.back = 5});
    const ClipData clip = retargeted(bow, target);
    const LocalPose pose = sample_motion(target, clip, 1);
    const std::vector<Quat> rotations = find_frame_rotations(target, pose.rotations);
    const std::uint16_t head = find_body_joints(target)[BodyPart::Head];
    CHECK(axis_angle(rotations[head]).angle == near(0.8).epsilon(1e-3));
    for (std::size_t j = 2; j <= 5; ++j) {
        CHECK(axis_angle(pose.rotations[j]).angle == near(0.1).epsilon(1e-3));
    }
}

TEST_CASE(
    "body retarget: hands may follow their way instead of the angles"
    * technique("char.retarget-body")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    SkeletonData target = walk.motion.skeleton;
    const BodyJoints body = find_body_joints(target);
    for (const BodyPart part : {BodyPart::LeftForearm, BodyPart::LeftHand}) {
        target.rest.translations[body[part]] *= 1.2f;
    }
    const auto expected = positions_of(walk.motion);
    for (const float importance : {0.0f, 1.0f}) {
        const auto found =
            positions_of({target, retargeted(walk.motion, target, {.hands = importance})});
        const std::uint16_t hand = body[BodyPart::LeftHand];
        const float off = glm::distance(expected[40][hand], found[40][hand]);
        CHECK((importance > 0 ? off < 2e-3f : off > 0.05f));
    }
}

TEST_CASE(
    "body retarget: skeletons without common joints fail with one line"
    * technique("char.retarget-body")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    SkeletonData chair;
    chair.joints = {"seat", "leg a", "leg b"};
    chair.parents = {-1, 0, 0};
    chair.rest.translations.assign(3, Vec3(0, 1, 0));
    chair.rest.rotations.assign(3, Quat(1, 0, 0, 0));
    chair.rest.scales.assign(3, Vec3(1));
    const Result<ClipData> clip = retarget_motion(walk.motion, chair);
    REQUIRE(!clip.ok());
    const std::string& message = clip.error().message;
    CHECK(message.starts_with("found no joints that correspond between Hips, "));
    CHECK(
        message.find(" ... and seat, leg a, leg b, expected equal names or parts of a body such as "
                     "LeftUpLeg or thigh.L")
        != std::string::npos);
    chair.joints[0] = "Hips";  // which alone would only be moved
    const Result<ClipData> one = retarget_motion(walk.motion, chair);
    REQUIRE(!one.ok());
    CHECK(one.error().message.starts_with("found only one joint that corresponds between"));
}

TEST_CASE(
    "body retarget: bones without length, legs without feet and clips without keys are finite"
    * technique("char.retarget-body")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker(), 1);
    const auto check_finite = [&](const SkeletonMotion& source, const SkeletonData& target) {
        const ClipData clip = retargeted(source, target, {.hands = 0.5f});
        for (const auto& row : positions_of({target, clip})) {
            for (const Vec3& p : row) {
                CHECK(is_finite(p));
            }
        }
    };
    SkeletonData flat = walk.motion.skeleton;
    for (std::size_t j = 1; j < flat.joints.size(); ++j) {
        flat.rest.translations[j] *= j % 2 == 0 ? 0.0f : 1.0f;
    }
    check_finite(walk.motion, flat);
    check_finite({flat, walk.motion.clip}, walk.motion.skeleton);
    SkeletonData point = flat;
    point.rest.translations.assign(flat.joints.size(), Vec3(0));
    check_finite(walk.motion, point);
    check_finite({point, walk.motion.clip}, walk.motion.skeleton);
    SkeletonData footless = walk.motion.skeleton;
    for (std::string& name : footless.joints) {
        name = name.find("Foot") != std::string::npos ? "stump" + name.substr(0, 1) : name;
    }
    check_finite(walk.motion, footless);
    SkeletonMotion still = walk.motion;
    still.clip.sheets.clear();
    check_finite(still, oracle::make_walker(kShortShins));
}

TEST_CASE(
    "body retarget: the walk of MakeHuman walks on other bodies without sliding"
    * technique("char.retarget-body")) {
    const auto path = test::shared_asset("makehuman/bvh/walk1.bvh");
    if (!path) {
        return;
    }
    SkeletonMotion walk = *load_bvh_motion(*path, {.rate = 60});
    MotionFrames frames = sample_frames(walk, 60);
    CHECK(add_travel(walk.skeleton, frames) > 0.3f);
    walk.clip = make_frames_clip(walk.skeleton, frames, walk.clip);
    for (const oracle::WalkerShape& shape :
         {oracle::WalkerShape{}, kShortShins, oracle::WalkerShape{.has_bone_axes = true}}) {
        const SkeletonData target = oracle::make_walker(shape);
        RetargetReport report;
        const ClipData clip = retargeted(walk, target, {}, &report);
        CHECK(report.joints >= 17);
        CHECK(report.slide <= 1e-3f);
        CAPTURE(report.slide_before);
        CHECK(report.contacts > 0);
    }
}

}  // namespace limn::body_retarget_test

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/shoulder_girdle.h"
#include "systems/animation/walk/activity_clip.h"
#include "tests/near.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::shoulder_girdle_test {

using namespace limn::test;

namespace {

/// The stick person with collar bones; its arms rest `below` the horizontal [rad].
SkeletonData make_person_with_collars(float below, bool has_bone_axes) {
    const SkeletonData plain = make_stick_person(1, has_bone_axes);
    SkeletonData skeleton;
    skeleton.name = plain.name;
    std::vector<std::int32_t> moved;
    std::vector<JointPlace> places;
    const auto add = [&](const std::string& name, std::int32_t parent, const JointPlace& place) {
        skeleton.joints.push_back(name);
        skeleton.parents.push_back(parent);
        const JointPlace above =
            parent < 0 ? JointPlace{} : places[static_cast<std::size_t>(parent)];
        const Quat back = glm::conjugate(above.rotation);
        skeleton.rest.translations.push_back(back * (place.position - above.position));
        skeleton.rest.rotations.push_back(back * place.rotation);
        skeleton.rest.scales.emplace_back(1);
        places.push_back(place);
        return static_cast<std::int32_t>(places.size()) - 1;
    };
    for (std::size_t j = 0; j < plain.joints.size(); ++j) {
        const std::string& name = plain.joints[j];
        JointPlace place = find_place(plain, plain.rest, static_cast<std::int32_t>(j));
        std::int32_t parent =
            plain.parents[j] < 0 ? -1 : moved[static_cast<std::size_t>(plain.parents[j])];
        const float side = place.position.x > 0 ? 1.0f : -1.0f;
        const Vec3 socket = {0.19f * side, 1.4f, 0};
        if (name.ends_with("Arm") && !name.ends_with("ForeArm")) {
            parent =
                add((side > 0 ? "Left" : "Right") + std::string("Shoulder"), parent,
                    {{0.03f * side, 1.42f, 0.02f}, place.rotation});
        }
        if (name.find("Arm") != std::string::npos || name.ends_with("Hand")) {
            const Quat down = rotation_about({0, 0, -side}, below);
            place.position = socket + down * (place.position - socket);
        }
        moved.push_back(add(name, parent, place));
    }
    return skeleton;
}

std::uint16_t joint_of(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    REQUIRE(found != skeleton.joints.end());
    return static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

Vec3 place_of(const SkeletonData& skeleton, const LocalPose& pose, const std::string& name) {
    return find_place(skeleton, pose, joint_of(skeleton, name)).position;
}

/// By how much the line from collar bone to shoulder is steeper than at rest [rad].
float collar_rise(const SkeletonData& skeleton, const LocalPose& pose, const std::string& side) {
    const auto slope = [&](const LocalPose& p) {
        const Vec3 bone =
            place_of(skeleton, p, side + "Arm") - place_of(skeleton, p, side + "Shoulder");
        return std::atan2(bone.y, std::hypot(bone.x, bone.z));
    };
    return slope(pose) - slope(skeleton.rest);
}

/// The direction of an upper arm raised in a plane that is turned forward from the side.
Vec3 raised_way(float elevation, float forward, float side) {
    return std::sin(elevation) * Vec3(side * std::cos(forward), 0, std::sin(forward))
           - std::cos(elevation) * Vec3(0, 1, 0);
}

}  // namespace

TEST_CASE(
    "shoulder: the girdle takes a third of what an arm is raised beyond 30 degrees, or beyond "
    "rest, "
    "without a kink"
    * technique("char.motion-constrain")) {
    CHECK(girdle_turn(radians(5.0f), 0) == near(0));
    CHECK(girdle_turn(radians(90.0f), radians(10.0f)) == near(radians(20.0)));
    CHECK(girdle_turn(radians(150.0f), radians(10.0f)) == near(radians(40.0)));
    CHECK(girdle_turn(radians(150.0f), radians(45.0f)) == near(radians(35.0)));
    CHECK(girdle_turn(radians(150.0f), radians(90.0f)) == near(radians(20.0)));
    float slope = 0;
    for (float e = 0.001f; e < kPi; e += 0.001f) {
        const float next = (girdle_turn(e, 0) - girdle_turn(e - 0.001f, 0)) / 0.001f;
        CHECK(next > slope - 2e-3f);
        CHECK(std::abs(next - slope) < 4e-3f);
        slope = next;
    }
    CHECK(slope == near(1.0 / 3).epsilon(1e-3));
}

TEST_CASE(
    "shoulder: the collar bone rises with the arm in every plane, the arm keeps its direction and "
    "the other side stays, for any rest pose and however the trunk leans"
    * technique("char.motion-constrain")) {
    for (const float below : {0.0f, kPi / 4, 1.2f}) {
        for (const bool has_bone_axes : {false, true}) {
            const SkeletonData skeleton = make_person_with_collars(below, has_bone_axes);
            const float rest = kPi / 2 - below;
            for (const float elevation : {0.2f, 1.0f, kPi / 2, radians(150.0f)}) {
                for (const float forward : {0.0f, 0.6f, 1.4f}) {
                    for (const float lean : {0.0f, 1.3f}) {
                        CAPTURE(below);
                        CAPTURE(elevation);
                        CAPTURE(forward);
                        LocalPose pose = skeleton.rest;
                        const std::uint16_t arm = joint_of(skeleton, "LeftArm");
                        const std::uint16_t fore = joint_of(skeleton, "LeftForeArm");
                        const Vec3 way = raised_way(elevation, forward, 1);
                        const Vec3 resting = raised_way(rest, 0, 1);
                        set_joint_rotation(
                            skeleton, arm,
                            rotation_between(resting, way)
                                * find_place(skeleton, skeleton.rest, arm).rotation,
                            1, pose);
                        raise_collar(skeleton, {find_collar(skeleton, arm), arm, fore}, 1, pose);
                        const float rise = collar_rise(skeleton, pose, "Left");
                        CHECK(rise == near(double(girdle_turn(elevation, rest))).epsilon(1e-4));
                        CHECK(std::abs(collar_rise(skeleton, pose, "Right")) < 1e-5f);
                        const Vec3 now = glm::normalize(
                            place_of(skeleton, pose, "LeftForeArm")
                            - place_of(skeleton, pose, "LeftArm"));
                        CHECK(glm::distance(now, way) < 1e-5f);
                        // A trunk that leans with everything on it changes nothing.
                        LocalPose leaning = pose;
                        leaning.rotations[0] =
                            rotation_about({1, 0.3f, 0}, lean) * pose.rotations[0];
                        LocalPose again = leaning;
                        again.rotations[find_collar(skeleton, arm)] =
                            skeleton.rest.rotations[find_collar(skeleton, arm)];
                        set_joint_rotation(
                            skeleton, arm, find_place(skeleton, leaning, arm).rotation, 1, again);
                        raise_collar(skeleton, {find_collar(skeleton, arm), arm, fore}, 1, again);
                        for (std::size_t j = 0; j < again.size(); ++j) {
                            CHECK(
                                std::abs(glm::dot(again.rotations[j], leaning.rotations[j]))
                                > 1 - 1e-5f);
                        }
                    }
                }
            }
        }
    }
}

TEST_CASE(
    "shoulder: a hand that reaches up arrives, with its collar bone raised by its arm"
    * technique("char.motion-constrain")) {
    const SkeletonData skeleton = make_person_with_collars(kPi / 4, false);
    const std::uint16_t arm = joint_of(skeleton, "RightArm");
    const LimbJoints limb = {
        arm, joint_of(skeleton, "RightForeArm"), joint_of(skeleton, "RightHand")};
    const std::uint16_t collar = find_collar(skeleton, arm);
    REQUIRE(collar == joint_of(skeleton, "RightShoulder"));
    for (const Vec3& target : {Vec3(-0.35f, 1.8f, 0.15f), Vec3(-0.6f, 1.5f, 0.2f)}) {
        LocalPose pose = skeleton.rest;
        reach_with_arm(skeleton, collar, limb, {.target = target}, pose);
        CHECK(glm::distance(place_of(skeleton, pose, "RightHand"), target) < 1e-5f);
        const Vec3 way =
            place_of(skeleton, pose, "RightForeArm") - place_of(skeleton, pose, "RightArm");
        const float elevation = std::atan2(std::hypot(way.x, way.z), -way.y);
        const float wanted = girdle_turn(elevation, kPi / 4);
        CHECK(wanted > 0.15f);
        CHECK(std::abs(collar_rise(skeleton, pose, "Right") - wanted) < 0.07f);
        LocalPose none = skeleton.rest;
        reach_with_arm(skeleton, collar, limb, {.target = target, .weight = 0}, none);
        for (std::size_t j = 0; j < none.size(); ++j) {
            CHECK(std::abs(glm::dot(none.rotations[j], skeleton.rest.rotations[j])) > 1 - 1e-6f);
        }
    }
    CHECK(find_collar(skeleton, joint_of(skeleton, "LeftLeg")) == 0xffff);
}

TEST_CASE("shoulder: who waves raises the collar bone of that arm, the other one hangs") {
    const SkeletonData skeleton = make_person_with_collars(kPi / 4, false);
    const ClipData clip = make_activity_clip(skeleton, CrowdActivity::Wave);
    const ClipSheet& sheet = clip.sheets.front();
    LocalPose pose = skeleton.rest;
    for (std::size_t i = 0; i < sheet.rotating.size(); ++i) {
        pose.rotations[sheet.rotating[i]] = sheet.rotations[i];
    }
    const Vec3 way =
        place_of(skeleton, pose, "RightForeArm") - place_of(skeleton, pose, "RightArm");
    const float elevation = std::atan2(std::hypot(way.x, way.z), -way.y);
    CHECK(elevation > radians(90.0f));
    CHECK(
        collar_rise(skeleton, pose, "Right")
        == near(double(girdle_turn(elevation, kPi / 4))).epsilon(0.03));
    CHECK(std::abs(collar_rise(skeleton, pose, "Left")) < 0.01f);
}

}  // namespace limn::shoulder_girdle_test

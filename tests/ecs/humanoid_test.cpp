#include "ecs/components/humanoid.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <string>
#include <utility>

namespace limn::humanoid_test {

namespace {

using enum BodyPart;

/// Each joint with the index of its parent.
using Joints = std::initializer_list<std::pair<const char*, std::int32_t>>;

SkeletonData make_skeleton(Joints joints) {
    SkeletonData skeleton;
    for (const auto& [name, parent] : joints) {
        skeleton.joints.emplace_back(name);
        skeleton.parents.push_back(parent);
        skeleton.rest.translations.emplace_back(0, 1, 0);
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1, 1, 1);
    }
    return skeleton;
}

std::string joint_of(const SkeletonData& skeleton, BodyPart part) {
    const BodyJoints body = find_body_joints(skeleton);
    return body.has(part) ? skeleton.joints[body[part]] : "";
}

}  // namespace

TEST_CASE("The parts of a body are found by the names that Mixamo gives its joints") {
    const SkeletonData body = make_skeleton(
        {{"mixamorig:Hips", -1},
         {"mixamorig:Spine", 0},
         {"mixamorig:Spine1", 1},
         {"mixamorig:Spine2", 2},
         {"mixamorig:Neck", 3},
         {"mixamorig:Head", 4},
         {"mixamorig:LeftShoulder", 3},
         {"mixamorig:LeftArm", 6},
         {"mixamorig:LeftForeArm", 7},
         {"mixamorig:LeftHand", 8},
         {"mixamorig:RightUpLeg", 0},
         {"mixamorig:RightLeg", 10},
         {"mixamorig:RightFoot", 11},
         {"mixamorig:RightToeBase", 12}});
    CHECK(joint_of(body, Hips) == "mixamorig:Hips");
    CHECK(joint_of(body, Spine) == "mixamorig:Spine");
    CHECK(joint_of(body, Chest) == "mixamorig:Spine2");
    CHECK(joint_of(body, LeftShoulder) == "mixamorig:LeftShoulder");
    CHECK(joint_of(body, LeftUpperArm) == "mixamorig:LeftArm");
    CHECK(joint_of(body, LeftForearm) == "mixamorig:LeftForeArm");
    CHECK(joint_of(body, RightThigh) == "mixamorig:RightUpLeg");
    CHECK(joint_of(body, RightShin) == "mixamorig:RightLeg");
    CHECK(joint_of(body, RightToes) == "mixamorig:RightToeBase");
    CHECK(joint_of(body, LeftThigh) == "");
}

TEST_CASE("A shoulder beside a collar is the upper arm, a hip with a side the thigh") {
    const SkeletonData body = make_skeleton(
        {{"Hips", -1},
         {"LeftHip", 0},
         {"LeftKnee", 1},
         {"LeftAnkle", 2},
         {"Chest", 0},
         {"LeftCollar", 4},
         {"LeftShoulder", 5},
         {"LeftElbow", 6},
         {"LeftWrist", 7}});
    CHECK(joint_of(body, Hips) == "Hips");
    CHECK(joint_of(body, LeftThigh) == "LeftHip");
    CHECK(joint_of(body, LeftShin) == "LeftKnee");
    CHECK(joint_of(body, LeftFoot) == "LeftAnkle");
    CHECK(joint_of(body, LeftShoulder) == "LeftCollar");
    CHECK(joint_of(body, LeftUpperArm) == "LeftShoulder");
    CHECK(joint_of(body, LeftHand) == "LeftWrist");
    CHECK(joint_of(body, Chest) == "Chest");
}

TEST_CASE("Sides are letters in the joints of Blender, VRM and MakeHuman") {
    const SkeletonData blender = make_skeleton({{"hips", -1}, {"thigh.L", 0}, {"thigh.R", 0}});
    CHECK(joint_of(blender, LeftThigh) == "thigh.L");
    CHECK(joint_of(blender, RightThigh) == "thigh.R");

    const SkeletonData vrm = make_skeleton(
        {{"J_Bip_C_Hips", -1}, {"J_Bip_C_Spine", 0}, {"J_Bip_C_Head", 1}, {"J_Bip_R_UpperLeg", 0}});
    CHECK(joint_of(vrm, Hips) == "J_Bip_C_Hips");
    CHECK(joint_of(vrm, Head) == "J_Bip_C_Head");
    CHECK(joint_of(vrm, RightThigh) == "J_Bip_R_UpperLeg");

    const SkeletonData makehuman = make_skeleton(
        {{"root", -1},
         {"spine05", 0},
         {"spine01", 1},
         {"neck01", 2},
         {"head", 3},
         {"__Clavicle_L", 2},
         {"clavicle.L", 5},
         {"shoulder01.L", 6},
         {"upperarm01.L", 7},
         {"upperarm02.L", 8},
         {"pelvis.L", 0},
         {"upperleg01.L", 10}});
    CHECK(joint_of(makehuman, Hips) == "root");
    CHECK(joint_of(makehuman, Spine) == "spine05");
    CHECK(joint_of(makehuman, Chest) == "spine01");
    CHECK(joint_of(makehuman, LeftShoulder) == "clavicle.L");
    CHECK(joint_of(makehuman, LeftUpperArm) == "upperarm01.L");
    CHECK(joint_of(makehuman, LeftThigh) == "upperleg01.L");
}

TEST_CASE("A skeleton of another creature has no parts but a root") {
    const SkeletonData fish = make_skeleton({{"body", -1}, {"fin", 0}, {"tail", 1}});
    const BodyJoints found = find_body_joints(fish);
    for (const std::uint16_t joint : found.joints) {
        CHECK(joint == BodyJoints::kNoJoint);
    }
    CHECK_FALSE(find_body_joints(SkeletonData{}).has(Hips));
}

}  // namespace limn::humanoid_test

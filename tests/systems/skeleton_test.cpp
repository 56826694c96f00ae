#include "ecs/components/skeleton.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace limn::skeleton_test {

using namespace limn::test;

namespace {

template <typename Break>
std::string skeleton_error(Break&& break_it) {
    SkeletonData skeleton = make_chain(4);
    break_it(skeleton);
    const Status status = check_skeleton(skeleton);
    return status ? "" : status.error().message;
}

template <typename Break>
std::string clip_error(Break&& break_it) {
    ClipData clip = make_turn({0, 1, 2}, {0, 10, 20}, 1);
    break_it(clip.sheets[0]);
    const Status status = check_clip(clip, 2, 1);
    return status ? "" : status.error().message;
}

template <typename Break>
std::string skin_error(Break&& break_it) {
    SkinData skin{"skin", {0, 1}, {Affine{}, Affine{}}};
    break_it(skin);
    const Status status = check_skin(skin, 2);
    return status ? "" : status.error().message;
}

}  // namespace

TEST_CASE("skeleton: cycles, second roots and children before parents are rejected") {
    CHECK(skeleton_error([](SkeletonData&) {}) == "");
    CHECK(skeleton_error([](SkeletonData& s) { s = {}; }) == "skeleton : no joints");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.parents[2] = 2; })
        == "skeleton chain: joint 2 (joint 2) has the parent 2, expected an earlier joint");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.parents[1] = 3; })
        == "skeleton chain: joint 1 (joint 1) has the parent 3, expected an earlier joint");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.parents[2] = -1; })
        == "skeleton chain: joint 2 (joint 2) has the parent -1, expected an earlier joint");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.parents[0] = 0; })
        == "skeleton chain: joint 0 (joint 0) has the parent 0, expected -1, it is the root");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.rest.scales.pop_back(); })
        == "skeleton chain: arrays of different lengths for 4 joints");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.rest.rotations[3] = Quat(0, 0, 0, 0); })
        == "skeleton chain: joint 3 (joint 3) has an invalid rest transform");
    CHECK(
        skeleton_error([](SkeletonData& s) { s.rest.translations[1].y = NAN; })
        == "skeleton chain: joint 1 (joint 1) has an invalid rest transform");
    CHECK(skeleton_error([](SkeletonData& s) { s.rest.scales[1].y = INFINITY; }) != "");
}

TEST_CASE(
    "skeleton: a clip with unsorted keys, wrong lengths or unknown joints is rejected with its "
    "location"
    * technique("char.clip-layout")) {
    CHECK(clip_error([](ClipSheet&) {}) == "");
    CHECK(clip_error([](ClipSheet& s) { s.times = {}; }) == "clip turn, sheet 0: no keys");
    CHECK(
        clip_error([](ClipSheet& s) {
            s.times = {0, 2, 1};
        })
        == "clip turn, sheet 0: key 2 at 1 s, expected later than 2 s");
    CHECK(
        clip_error([](ClipSheet& s) {
            s.times = {0, 0, 1};
        })
        == "clip turn, sheet 0: key 1 at 0 s, expected later than 0 s");
    CHECK(
        clip_error([](ClipSheet& s) { s.times[1] = NAN; })
        == "clip turn, sheet 0: the time of key 1 is not finite");
    CHECK(
        clip_error([](ClipSheet& s) { s.rotations.pop_back(); })
        == "clip turn, sheet 0: 2 rotations, expected 3 for 3 keys");
    CHECK(
        clip_error([](ClipSheet& s) { s.interpolation = Interpolation::Cubic; })
        == "clip turn, sheet 0: 3 rotations, expected 9 for 3 keys");
    CHECK(
        clip_error([](ClipSheet& s) { s.rotating = {2}; })
        == "clip turn, sheet 0: rotations of index 2, expected less than 2");
    CHECK(
        clip_error([](ClipSheet& s) {
            s.morphing = {1};
            s.weights = {0, 0, 0};
        })
        == "clip turn, sheet 0: weights of index 1, expected less than 1");
    CHECK(
        clip_error([](ClipSheet& s) {
            s.translating = {1, 1};
            s.translations.resize(6);
        })
        == "clip turn, sheet 0: translations of index 1 twice");
    CHECK(
        clip_error([](ClipSheet& s) {
            s.scaling = {1};
            s.scales = {Vec3(1), Vec3(1, NAN, 1), Vec3(1)};
        })
        == "clip turn, sheet 0: scales that are not finite");
    CHECK(
        clip_error([](ClipSheet& s) { s.rotations[1] = Quat(0, 0, 0, 0); })
        == "clip turn, sheet 0: a rotation of length 0");
}

TEST_CASE("skeleton: a skin with a singular matrix or a missing joint is rejected") {
    CHECK(skin_error([](SkinData&) {}) == "");
    CHECK(
        skin_error([](SkinData& s) { s.joints = {0}; })
        == "skin skin: 2 matrices for 1 joints, expected one each");
    CHECK(
        skin_error([](SkinData& s) { s.joints[1] = 2; })
        == "skin skin: joint 2, expected less than 2");
    const std::string singular = "skin skin: the matrix of joint 1 has no inverse";
    CHECK(skin_error([](SkinData& s) { s.joint_from_mesh[1].row[2] = Vec4(0); }) == singular);
    CHECK(skin_error([](SkinData& s) { s.joint_from_mesh[1].row[1].w = NAN; }) == singular);
    CHECK(skin_error([](SkinData& s) { s.joint_from_mesh[1].row[1].y = INFINITY; }) == singular);
}

}  // namespace limn::skeleton_test

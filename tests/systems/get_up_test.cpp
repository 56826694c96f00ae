// Bodies that get up again: through a crouch, on their feet.

#include "ecs/components/humanoid.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ragdoll/crouch.h"
#include "tests/near.h"
#include "tests/systems/ragdoll_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <vector>

namespace limn::get_up_test {

using namespace limn::test;
using ragdoll_test::make_person;
using ragdoll_test::Stage;

namespace {

Vec3 place_of(const SkeletonData& skeleton, const LocalPose& pose, BodyPart part) {
    return find_place(skeleton, pose, find_body_joints(skeleton)[part]).position;
}

}  // namespace

TEST_CASE(
    "get up: a crouch lowers the hips over feet that stay, and bends knees forward"
    * technique("char.dynamics")) {
    const SkeletonData skeleton = make_person();
    const LocalPose& rest = skeleton.rest;
    float last_height = 1e9f;
    for (const float amount : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        LocalPose pose = rest;
        crouch(skeleton, amount, pose);
        for (const BodyPart foot : {BodyPart::LeftFoot, BodyPart::RightFoot}) {
            CHECK(
                glm::distance(place_of(skeleton, pose, foot), place_of(skeleton, rest, foot))
                < 1e-5f);
        }
        const Vec3 hips = place_of(skeleton, pose, BodyPart::Hips);
        CHECK(hips.y < last_height);
        last_height = hips.y;
        CHECK(hips.y == near(0.96f - amount * 0.42f * 0.83f));
        const Vec3 knee = place_of(skeleton, pose, BodyPart::LeftShin);
        CHECK(knee.z >= place_of(skeleton, pose, BodyPart::LeftFoot).z - 1e-5f);
        CHECK(glm::distance(knee, place_of(skeleton, pose, BodyPart::LeftThigh)) == near(0.42));
        CHECK(glm::distance(knee, place_of(skeleton, pose, BodyPart::LeftFoot)) == near(0.41));
    }
}

TEST_CASE("get up: what is no person keeps its pose") {
    SkeletonData skeleton = make_person();
    skeleton.joints[10] = "stilt";
    LocalPose pose = skeleton.rest;
    crouch(skeleton, 1, pose);
    CHECK(pose.translations == skeleton.rest.translations);
}

TEST_CASE(
    "get up: from the floor without a jump, then on planted feet" * technique("char.dynamics")) {
    Stage stage({.active = true, .collapse = 0, .get_up = 1});
    stage.add_floor();
    stage.ragdoll().push = {0, 0, 1};
    stage.step(150);
    CHECK(stage.joint(0).y < 0.5f);
    stage.ragdoll().active = false;
    stage.step();
    std::vector<Vec3> last;
    float fastest = 0;
    float slide = 0;
    float lowest_hips = 10;
    for (int frame = 0; frame < 80; ++frame) {
        stage.step();
        std::vector<Vec3> now;
        for (std::size_t j = 0; j < stage.skeleton.joints.size(); ++j) {
            now.push_back(stage.joint(j));
        }
        for (std::size_t j = 0; j < last.size(); ++j) {
            fastest = std::max(fastest, 60 * glm::distance(last[j], now[j]));
        }
        if (frame > 40 && !last.empty()) {  // on its feet from 0.55 s on
            slide = std::max(
                {slide, glm::distance(last[11], now[11]), glm::distance(last[18], now[18])});
            lowest_hips = std::min(lowest_hips, now[0].y);
        }
        last = now;
    }
    CHECK(fastest < 6);  // [m/s]
    CHECK(slide < 2e-4f);
    CHECK(lowest_hips < 0.75f);  // the legs lifted it
    CHECK(stage.joint(0).y == near(0.96).epsilon(1e-3));
}

}  // namespace limn::get_up_test

#include "content/make/models/mannequin.h"
#include "content/make/models/robot_arm.h"
#include "ecs/components/humanoid.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>

namespace limn::rigid_models_test {

using namespace test;

namespace {

/// Every vertex belongs to one joint, fully.
void check_rigid(const MeshData& mesh, const MeshRig& rig) {
    check_arrays(mesh);
    REQUIRE(check_skeleton(rig.skeleton));
    REQUIRE(check_skin(rig.skin, rig.skeleton.joints.size()));
    REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
    CHECK(mesh.skin.joints.size() == mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        CHECK(mesh.skin.first[v] == v);
        CHECK(mesh.skin.weights[v] == 1.0f);
        CHECK(mesh.skin.joints[v] < rig.skin.joints.size());
    }
}

}  // namespace

TEST_CASE("robot arm: every part is rigid, as high as its size says, with limits by its range") {
    for (const RobotArmPart part :
         {RobotArmPart::Shell, RobotArmPart::Metal, RobotArmPart::Limits}) {
        const RobotArmShape shape = {.part = part, .size = 2, .range = 0.5f};
        const MeshRig rig = make_robot_arm_rig(shape);
        check_rigid(make_robot_arm(shape), rig);
        CHECK(rig.skeleton.joints.size() == 8);
        REQUIRE(rig.skeleton.freedoms.size() == 7);
        CHECK(rig.skeleton.freedoms[1].max == near(double(radians(115.0f)) / 2));
    }
    const MeshData metal = make_robot_arm({.part = RobotArmPart::Metal});
    CHECK(metal.bounds.min.y == near(0).scale(1));
    CHECK(metal.bounds.max.y == near(1.4).epsilon(0.05));
}

TEST_CASE("mannequin: it is rigid, mirror symmetric, as tall as asked, and has a person's joints") {
    const MannequinShape shape = {.height = 1.2f};
    const MeshData mesh = make_mannequin(shape);
    const MeshRig rig = make_mannequin_rig(shape);
    check_rigid(mesh, rig);
    CHECK(mesh.bounds.max.x == near(-double(mesh.bounds.min.x)).epsilon(1e-4));
    CHECK(mesh.bounds.min.y == near(0).scale(1).epsilon(0.02));
    CHECK(mesh.bounds.max.y == near(1.2).epsilon(0.02));
    const BodyJoints body = find_body_joints(rig.skeleton);
    for (const BodyPart part :
         {BodyPart::Hips, BodyPart::Neck, BodyPart::Head, BodyPart::LeftUpperArm,
          BodyPart::LeftForearm, BodyPart::LeftHand, BodyPart::RightThigh, BodyPart::RightShin,
          BodyPart::RightFoot}) {
        CAPTURE(static_cast<int>(part));
        CHECK(body.has(part));
    }
    REQUIRE(rig.clips.size() == 1);
    CHECK(check_clip(rig.clips[0], rig.skeleton.joints.size(), 0));
}

}  // namespace limn::rigid_models_test

// Ragdolls in a world: the switch from the animation and back, what they fall on, what moves them.

#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/force_field.h"
#include "ecs/components/height_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "systems/animation/ragdoll/ragdoll_rig.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/ragdoll_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::ragdoll_test {

using namespace limn::test;

namespace {

constexpr float kStep = 1.0f / 60;

/// How well joints hold, from the saved state.
struct JointErrors {
    double anchor = 0;
    double excess = 0;
};
JointErrors find_errors(const SkeletonData& skeleton, const RagdollState& state) {
    const RagdollRig rig = make_ragdoll_rig(skeleton);
    RagdollScene scene;
    JointErrors errors;
    for (std::size_t i = 0; i < rig.bones.size(); ++i) {
        RigidCapsule body;
        body.position = RigidVec(state.positions[i]);
        body.rotation = glm::normalize(RigidQuat(state.rotations[i]));
        scene.bodies.push_back(body);
    }
    for (std::size_t i = 1; i < rig.bones.size(); ++i) {
        const RagdollBone& bone = rig.bones[i];
        const auto parent = static_cast<std::size_t>(bone.parent);
        RagdollJoint joint;
        joint.parent = parent;
        joint.child = i;
        joint.anchor_parent =
            RigidVec(bone.anchor - 0.5f * (rig.bones[parent].from + rig.bones[parent].to));
        joint.anchor_child = RigidVec(-0.5f * (bone.from + bone.to));
        joint.rest = RigidQuat(bone.rest);
        joint.limit = bone.limit;
        errors.anchor = std::max(errors.anchor, anchor_error(scene, joint));
        errors.excess = std::max(errors.excess, limit_excess(scene, joint));
    }
    return errors;
}

bool is_finite_pose(World& world, Entity entity) {
    for (const Affine& joint : world.get<const Pose>(entity).joints) {
        for (const Vec4& row : joint.row) {
            if (!is_finite(row)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

TEST_CASE(
    "ragdoll: a person falls, joints hold, limits are kept, and it comes to rest and sleeps"
    * technique("char.dynamics")) {
    Stage stage({.active = true, .collapse = 0});
    stage.add_floor();
    stage.step(3);
    stage.ragdoll().push = {0.5f, 0, 1};
    JointErrors worst;
    float fastest = 0;
    for (int i = 0; i < 300; ++i) {
        stage.step();
        const JointErrors errors = find_errors(stage.skeleton, stage.state());
        worst.anchor = std::max(worst.anchor, errors.anchor);
        worst.excess = std::max(worst.excess, errors.excess);
        fastest = std::max(fastest, stage.fastest());
        CHECK(stage.lowest() > -0.01f);
    }
    CHECK(worst.anchor < 1e-3);
    CHECK(worst.excess < 0.03);
    CHECK(fastest < 12);
    CHECK(stage.joint(4).y < 0.5f);  // the head lies
    CHECK(stage.state().still >= 0.5f);
    CHECK(stage.fastest() == 0);
    const RagdollState before = stage.state();
    const std::vector<Affine> pose = stage.world.get<const Pose>(stage.person).joints;
    stage.step(60);
    for (std::size_t i = 0; i < before.positions.size(); ++i) {
        CHECK(stage.state().positions[i] == before.positions[i]);
    }
    CHECK(stage.world.get<const Pose>(stage.person).joints[5].row[0] == pose[5].row[0]);
}

TEST_CASE("ragdoll: the pose is that of the bodies, in a character that is turned and scaled") {
    Stage stage(
        {.active = true, .collapse = 0},
        {.position = {3, 2, -1}, .rotation = rotation_about({0, 1, 0}, 0.8f), .scale = Vec3(1.5f)});
    stage.step(20);
    const RagdollState state = stage.state();
    stage.step();
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        const Vec3 origin = state.positions[i] - state.rotations[i] * state.centers[i];
        CHECK(glm::distance(stage.joint(state.joints[i]), origin) < 1e-3f);
    }
    CHECK(stage.joint(0).y < 2 + 1.5f * 0.96f - 0.4f);  // it has fallen
    // Bones keep their lengths.
    CHECK(glm::distance(stage.joint(6), stage.joint(7)) == near(1.5 * 0.29).epsilon(1e-4));
}

TEST_CASE("ragdoll: bodies go on at the velocities of the animation" * technique("char.dynamics")) {
    Stage stage({.gravity = 0, .collapse = 0});
    stage.world.add(stage.person, ClipPlayer{.clip = {0}});
    for (int i = 0; i < 20; ++i) {
        stage.world.get<Transform>(stage.person).position.x += 2 * kStep;
        stage.step();
    }
    const auto joint_velocity = [&](std::size_t j) {
        const Vec3 before = stage.joint(j);
        stage.world.get<Transform>(stage.person).position.x += 2 * kStep;
        stage.step();
        return (stage.joint(j) - before) / kStep;
    };
    const Vec3 hand = joint_velocity(7);
    CHECK(glm::length(hand - Vec3(2, 0, 0)) > 0.2f);  // the arm swings
    stage.ragdoll().active = true;
    stage.world.get<Transform>(stage.person).position.x += 2 * kStep;
    stage.step();
    const RagdollState& state = stage.state();
    CHECK(glm::length(state.velocities[0] - Vec3(2, 0, 0)) < 0.1f);
    const auto forearm =
        static_cast<std::size_t>(std::ranges::find(state.joints, 7) - state.joints.begin());
    const Vec3 at_joint =
        state.velocities[forearm]
        + glm::cross(state.spins[forearm], state.rotations[forearm] * -state.centers[forearm]);
    CHECK(glm::length(at_joint - hand) < 0.15f * glm::length(hand));
}

TEST_CASE("ragdoll: a free one keeps its momentum" * technique("char.dynamics")) {
    Stage stage({.gravity = 0, .collapse = 0});
    stage.step(2);
    stage.ragdoll().push_joint = "LeftHand";
    stage.ragdoll().push = {0, 3, 6};
    stage.step();
    CHECK(stage.ragdoll().active);  // the push started it
    CHECK(stage.ragdoll().push == Vec3(0));
    const RagdollRig rig = make_ragdoll_rig(stage.skeleton);
    const auto momentum = [&] {
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < rig.bones.size(); ++i) {
            sum +=
                static_cast<double>(rig.bones[i].share) * glm::dvec3(stage.state().velocities[i]);
        }
        return sum;
    };
    const glm::dvec3 before = momentum();
    CHECK(glm::length(before) > 0.01);
    stage.step(120);
    CHECK(glm::length(momentum() - before) < 1e-4 * glm::length(before));
}

TEST_CASE("ragdoll: it lies on boxes, spheres, height fields and meshes") {
    for (const int kind : {0, 1, 2, 3}) {
        Stage stage({.active = true, .collapse = 0});
        if (kind == 0) {
            stage.world.create(
                Transform{.position = {0, -0.5f, 0}},
                ParticleCollider{.shape = ColliderShape::Box, .size = {3, 0.5f, 3}});
        } else if (kind == 1) {
            stage.world.create(
                Transform{.position = {0, -50, 0}},
                ParticleCollider{.shape = ColliderShape::Sphere, .size = Vec3(50)});
        } else if (kind == 2) {
            HeightField field;
            field.points = 9;
            field.size = {8, 8};
            field.height.assign(81, 0.0f);
            stage.world.create(
                Transform{}, field, ParticleCollider{.shape = ColliderShape::HeightField});
        } else {
            MeshData mesh;
            mesh.positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
            mesh.normals.assign(4, {0, 1, 0});
            mesh.indices = {0, 1, 2, 0, 2, 3};
            stage.world.find_resource<Assets>()->meshes.push_back(mesh);
            stage.world.create(Transform{}, MeshInstance{.mesh = {0}, .material = {}}, Walkable{});
        }
        CAPTURE(kind);
        stage.step(240);
        CHECK(stage.joint(4).y < 0.6f);
        CHECK(stage.lowest() > -0.02f);
        CHECK(stage.lowest() < 0.02f);
        CHECK(stage.fastest() < 0.3f);
    }
}

TEST_CASE("ragdoll: it does not fall apart where it is in a wall at the switch") {
    Stage stage({.active = true, .collapse = 0});
    stage.add_floor();
    stage.world.create(
        Transform{.position = {0.3f, 0.8f, 0}},
        ParticleCollider{.shape = ColliderShape::Box, .size = {0.3f, 0.8f, 0.5f}});
    float fastest = 0;
    for (int i = 0; i < 180; ++i) {
        stage.step();
        fastest = std::max(fastest, stage.fastest());
        if (i == 5) {
            CHECK(fastest < 4);
        }
    }
    CHECK(fastest < 12);
    CHECK(find_errors(stage.skeleton, stage.state()).anchor < 1e-3);
}

TEST_CASE(
    "ragdoll: it gets up where it lies, without a jump, and then is animated again"
    * technique("char.dynamics")) {
    Stage stage({.active = true, .get_up = 0.5f});
    stage.add_floor();
    stage.step(2);
    stage.ragdoll().push = {0, 0, 3};
    stage.step(120);
    const Vec3 lies = stage.joint(0);
    CHECK(lies.z > 0.3f);
    stage.ragdoll().active = false;
    std::vector<Vec3> last;
    for (int i = 0; i < 60; ++i) {
        stage.step();
        for (std::size_t j = 0; j < stage.skeleton.joints.size(); ++j) {
            if (i > 0) {
                CHECK(glm::distance(stage.joint(j), last[j]) < 0.15f);
                last[j] = stage.joint(j);
            } else {
                last.push_back(stage.joint(j));
            }
        }
        if (i == 0) {
            CHECK(glm::distance(stage.joint(0), lies) < 0.02f);
        }
    }
    const Transform place = stage.world.get<const Transform>(stage.person);
    CHECK(place.position.x == near(double(lies.x)).scale(1).epsilon(0.02));
    CHECK(place.position.z == near(double(lies.z)).scale(1).epsilon(0.02));
    CHECK(std::abs(place.position.y) < 0.02f);
    CHECK(stage.joint(0).y == near(double(place.position.y + 0.96f)).epsilon(1e-4));
    CHECK(stage.state().weight == 0);
}

TEST_CASE("ragdoll: muscles hold the pose of the clip, limp ones do not") {
    float bends[2];
    for (const int stiff : {0, 1}) {
        Stage stage({.active = true, .stiffness = stiff == 0 ? 0.0f : 0.8f, .collapse = 0});
        stage.world.add(stage.person, ClipPlayer{.clip = {0}, .speed = 0});
        stage.add_floor();
        stage.step(150);
        const Quat hips = stage.state().rotations[0];
        const auto shin = static_cast<std::size_t>(
            std::ranges::find(stage.state().joints, 10) - stage.state().joints.begin());
        bends[stiff] =
            axis_angle(to_same_hemisphere(
                           {1, 0, 0, 0}, glm::conjugate(hips) * stage.state().rotations[shin]))
                .angle;
    }
    CHECK(bends[1] < 0.25f);
    CHECK(bends[0] > 0.4f);
}

TEST_CASE("ragdoll: who is thrown bends knees and hips and puts the arms ahead, limp ones do not") {
    for (const float collapse : {0.15f, 0.0f}) {
        CAPTURE(collapse);
        Stage stage({.gravity = 0, .collapse = collapse});
        stage.world.add(stage.person, ClipPlayer{.clip = {0}, .speed = 0});
        stage.step(2);
        stage.ragdoll().push = {0, 2, 0};
        stage.step(35);
        const auto angle = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
            const Vec3 first = glm::normalize(stage.joint(b) - stage.joint(a));
            const Vec3 second = glm::normalize(stage.joint(d) - stage.joint(c));
            return std::acos(std::clamp(glm::dot(first, second), -1.0f, 1.0f));
        };
        const Vec3 ahead =
            glm::cross(stage.joint(9) - stage.joint(16), stage.joint(2) - stage.joint(0));
        for (const std::size_t side : {std::size_t{0}, std::size_t{7}}) {
            const float knee = angle(9 + side, 10 + side, 10 + side, 11 + side);
            const float elbow = angle(6 + side, 7 + side, 7 + side, 8 + side);
            const float hip = angle(2, 0, 9 + side, 10 + side);
            const Vec3 hand = stage.joint(8 + side) - stage.joint(6 + side);
            const float reach = glm::dot(hand, glm::normalize(ahead));
            if (collapse > 0) {
                CHECK(knee > 0.5f);
                CHECK(elbow > 0.5f);
                CHECK(hip > 0.3f);
                CHECK(reach > 0.15f);
            } else {
                CHECK(knee < 0.5f);
                CHECK(elbow < 0.5f);
                CHECK(hip < 0.3f);
            }
        }
        // It does so by its own forces, and has given up after six times the collapse.
        CHECK(double(stage.state().velocities[0].y) == near(2).epsilon(0.15));
        stage.step(120);
        CHECK(stage.fastest() < 2.5f);
    }
}

TEST_CASE("ragdoll: a ball that hits it, or a blast, makes it fall") {
    Stage hit({.trip_speed = 2});
    hit.add_floor();
    const Entity ball = hit.world.create(
        Transform{.position = {0, 1.2f, -3}},
        ParticleCollider{.shape = ColliderShape::Sphere, .size = Vec3(0.2f)});
    bool was_active_before = false;
    for (int i = 0; i < 60; ++i) {
        hit.world.get<Transform>(ball).position.z += 6 * kStep;
        was_active_before =
            was_active_before
            || (hit.ragdoll().active && hit.world.get<const Transform>(ball).position.z < -0.5f);
        hit.step();
    }
    CHECK(!was_active_before);
    CHECK(hit.ragdoll().active);
    CHECK(hit.joint(0).z > 0.5f);  // carried along

    Stage blast({.trip_field = 20});
    blast.add_floor();
    const Entity bomb = blast.world.create(
        Transform{.position = {-1, 0, 0}},
        ForceField{.kind = ForceKind::Attract, .strength = -10, .radius = 5});
    blast.step(5);
    CHECK(!blast.ragdoll().active);
    blast.world.get<ForceField>(bomb).strength = -150;
    blast.step(6);
    blast.world.get<ForceField>(bomb).strength = 0;
    CHECK(blast.ragdoll().active);
    blast.step(40);
    CHECK(blast.joint(0).x > 1);
}

TEST_CASE("ragdoll: it wakes when what it lies on goes away") {
    Stage stage({.active = true, .collapse = 0});
    const Entity floor = stage.world.create(Transform{}, Walkable{});
    stage.step(300);
    REQUIRE(stage.state().still >= 0.5f);
    stage.world.destroy(floor);
    stage.step(60);
    CHECK(stage.joint(0).y < -1);
}

TEST_CASE("ragdoll: a teleport takes it along") {
    Stage stage({.active = true, .gravity = 0, .collapse = 0});
    stage.step(3);
    const Vec3 before = stage.joint(4);
    stage.world.get<Transform>(stage.person).position = {10, 5, 0};
    stage.world.add(stage.person, Teleport{});
    stage.step(2);
    CHECK(glm::distance(stage.joint(4), before + Vec3(10, 5, 0)) < 1e-3f);
    CHECK(stage.fastest() < 0.01f);
}

TEST_CASE("ragdoll: a world restored from a snapshot continues with the same bits") {
    Stage stage({.active = true});
    stage.add_floor();
    stage.step(40);
    const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
    REQUIRE(saved.ok());
    Stage restored({.active = true});
    REQUIRE(restore_snapshot(restored.world, *saved).ok());
    for (int i = 0; i < 60; ++i) {
        stage.step();
        restored.step();
        REQUIRE(state_hash(restored.world) == state_hash(stage.world));
    }
}

TEST_CASE("ragdoll: the same bits on any number of threads") {
    const int before = thread_count();
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        Stage stage({.active = true});
        stage.add_floor();
        for (int i = 0; i < 8; ++i) {
            const auto x = static_cast<float>(i);
            stage.world.create(
                Transform{.position = {x, 0.1f * x, 0}}, Skeleton{{0}},
                Ragdoll{.active = true, .push = {0.1f * x, 0, 1}});
        }
        stage.step(60);
        hashes.push_back(state_hash(stage.world));
    }
    set_thread_count(before);
    CHECK(std::ranges::count(hashes, hashes[0]) == 4);
}

TEST_CASE("ragdoll: bad values and odd skeletons give finite poses") {
    SkeletonData flat = make_person();
    for (Vec3& offset : flat.rest.translations) {
        offset = Vec3(0);
    }
    SkeletonData tangled = make_person();
    for (std::string& name : tangled.joints) {
        name += " bone";  // nobody's
    }
    tangled.joints[0] = "x";
    tangled.rest.translations[7] = Vec3(0);
    tangled.freedoms = {
        {.joint = 6, .axis = {0, 0, 0}, .min = 1, .max = -1},
        {.joint = 9, .axis = {1, 0, 0}, .min = NAN, .max = 0.5f},
        {.joint = 9, .axis = {0, 1, 0}, .min = 0.3f, .max = 0.3f},
        {.joint = 10, .axis = {1, 0, 0}, .min = 9, .max = 8}};
    const Ragdoll odd = {
        .active = true,
        .mass = NAN,
        .thickness = -1,
        .friction = NAN,
        .bounce = 7,
        .damping = -3,
        .stiffness = NAN,
        .collapse = NAN,
        .get_up = -1,
        .push = {NAN, 0, 0}};
    for (const SkeletonData& skeleton : {make_person(), flat, tangled}) {
        Stage stage(odd, {}, skeleton);
        stage.add_floor();
        stage.world.create(Transform{}, ForceField{.strength = NAN});
        stage.step(30);
        CHECK(is_finite_pose(stage.world, stage.person));
        stage.world.insert_resource(FrameTime{.step = 1});
        stage.step(3);
        CHECK(is_finite_pose(stage.world, stage.person));
        stage.world.insert_resource(FrameTime{.step = 0});
        stage.step(2);
        stage.world.insert_resource(FrameTime{});
        if (!stage.state().positions.empty()) {
            stage.world.get<RagdollState>(stage.person).positions[0].x = NAN;
        }
        stage.step(2);
        CHECK(is_finite_pose(stage.world, stage.person));
        stage.ragdoll().active = false;
        stage.step(3);
        CHECK(is_finite_pose(stage.world, stage.person));
    }
    CHECK(make_ragdoll_rig(flat).bones.empty());
    CHECK(make_ragdoll_rig(tangled).bones.size() > 8);
    CHECK(make_ragdoll_rig({}).bones.empty());
}

TEST_CASE("ragdoll rig: a person has 16 capsules whose shares of the mass add up to 1") {
    const RagdollRig rig = make_ragdoll_rig(make_person());
    CHECK(rig.bones.size() == 16);
    float sum = 0;
    for (const RagdollBone& bone : rig.bones) {
        sum += bone.share;
    }
    CHECK(sum == near(1));
    // Knees bend backward, elbows forward.
    const auto bone_of = [&](int joint) {
        return *std::ranges::find(rig.bones, joint, &RagdollBone::joint);
    };
    CHECK(bone_of(10).limit.kind == RagdollJointKind::Hinge);
    const Vec3 shin = rotation_about(bone_of(10).limit.axis, 1.0f) * Vec3(0, -1, 0);
    CHECK(shin.z < -0.8f);
    const Vec3 forearm = rotation_about(bone_of(7).limit.axis, 1.0f) * Vec3(1, 0, 0);
    CHECK(forearm.z > 0.8f);
    const Vec3 right = rotation_about(bone_of(14).limit.axis, 1.0f) * Vec3(-1, 0, 0);
    CHECK(right.z > 0.8f);
}

TEST_CASE("ragdoll rig: freedoms of a skeleton are the limits of its joints") {
    SkeletonData skeleton = make_person();
    skeleton.freedoms = {
        {.joint = 7, .axis = {0, -1, 0}, .min = 0.1f, .max = 2},
        {.joint = 8, .axis = {0, 0, 1}, .min = -1, .max = 1},
        {.joint = 8, .axis = {0, 1, 0}, .min = -0.2f, .max = 0.6f}};
    const RagdollRig rig = make_ragdoll_rig(skeleton);
    const RagdollLimit& elbow = std::ranges::find(rig.bones, 7, &RagdollBone::joint)->limit;
    CHECK(elbow.kind == RagdollJointKind::Hinge);
    CHECK(elbow.axis == Vec3(0, -1, 0));
    CHECK(elbow.min == 0.1f);
    CHECK(elbow.max == 2.0f);
    const RagdollLimit& wrist = std::ranges::find(rig.bones, 8, &RagdollBone::joint)->limit;
    CHECK(wrist.kind == RagdollJointKind::Cone);
    CHECK(wrist.swing == near(1));
    CHECK(wrist.sway == near(0.4));
    CHECK(wrist.min == 0);
    CHECK(wrist.max == 0);
    CHECK(glm::distance(wrist.center, rotation_about({0, 1, 0}, 0.2f) * Vec3(1, 0, 0)) < 1e-5f);
}

}  // namespace limn::ragdoll_test

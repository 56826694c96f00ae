#include "content/load/level/level_load.h"
#include "content/load/scene_load.h"
#include "content/make/make_mesh.h"
#include "content/make/models/creature.h"
#include "content/make/models/creature_gait.h"
#include "content/make/models/implicit_mesh.h"
#include "ecs/base/foot_flight.h"
#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/world.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/skin_kernels.h"
#include "systems/update_world.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

namespace limn::creature_test {

using namespace limn::test;

namespace {

constexpr CreatureShape kShape = {};

const MeshData& creature() {
    static const MeshData mesh = make_creature(kShape);
    return mesh;
}
const MeshRig& rig() {
    static const MeshRig made = make_creature_rig(kShape);
    return made;
}

const ClipData& clip_named(std::string_view name) {
    for (const ClipData& clip : rig().clips) {
        if (clip.name == name) {
            return clip;
        }
    }
    FAIL("no such clip");
    return rig().clips[0];
}
const Gait& gait_named(std::string_view name) {
    for (const Gait& gait : creature_gaits()) {
        if (gait.name == name) {
            return gait;
        }
    }
    FAIL("no such gait");
    return creature_gaits()[0];
}

constexpr CreatureJoint kFeet[kLegs] = {
    CreatureJoint::LeftPaw, CreatureJoint::RightPaw, CreatureJoint::LeftFoot,
    CreatureJoint::RightFoot};

std::vector<Affine> joints_at(const ClipData& clip, float time) {
    LocalPose pose = rig().skeleton.rest;
    std::vector<float> weights(2);
    sample_clip(clip, time, pose, weights);
    std::vector<Affine> joints(pose.size());
    compute_joint_matrices(rig().skeleton, pose, joints);
    return joints;
}

Vec3 place_of(const std::vector<Affine>& joints, CreatureJoint joint) {
    return transform_point(joints[static_cast<std::size_t>(joint)], Vec3(0));
}

/// The mesh with a morph target fully on.
MeshData morphed(std::size_t target) {
    MeshData mesh = creature();
    std::vector<float> weights(mesh.morphs.size(), 0.0f);
    weights[target] = 1;
    add_morphs(creature().morphs, weights, {mesh.positions, mesh.normals, mesh.tangents});
    return mesh;
}

}  // namespace

TEST_CASE("implicit_mesh: a sphere is closed, even and of the right size") {
    const SignedDistance ball = [](const Vec3& p) { return glm::length(p) - 0.5f; };
    const ImplicitMesh net = mesh_surface(ball, {{Vec3(-0.6f), Vec3(0.6f)}, 0.05f, 4});
    MeshData mesh;
    mesh.positions = net.positions;
    mesh.normals = net.normals;
    mesh.indices = net.indices;
    CHECK(open_edges(mesh) == 0);
    CHECK(crowded_edges(mesh) == 0);
    CHECK(signed_volume(mesh) == test::near(4.0 / 3.0 * 3.14159265 * 0.125).epsilon(0.01));
    CHECK(worst_facing(mesh) > 0.97f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        CHECK(std::abs(glm::length(mesh.positions[v]) - 0.5f) < 1e-5f);
        CHECK(glm::distance(mesh.normals[v], 2.0f * mesh.positions[v]) < 1e-4f);
    }
}

TEST_CASE("creature: it is closed, its triangles face its normals, and it stands on the ground") {
    const MeshData& mesh = creature();
    CHECK(open_edges(mesh) == 0);
    CHECK(crowded_edges(mesh) == 0);
    CHECK(signed_volume(mesh) > 0.005);
    CHECK(worst_facing(mesh) > 0.1f);
    CHECK(std::abs(mesh.bounds.min.y) < 0.006f);
    CHECK(std::abs(mesh.bounds.min.x + mesh.bounds.max.x) < 1e-3f);
    CHECK(mesh.colors.size() == mesh.positions.size());
    CHECK(mesh.tangents.size() == mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        CHECK(std::abs(glm::length(mesh.normals[v]) - 1) < 1e-5f);
        CHECK(std::abs(glm::dot(Vec3(mesh.tangents[v]), mesh.normals[v])) < 1e-4f);
        const Vec2 uv = mesh.uvs[v];
        CHECK((uv.x >= -0.5f && uv.x <= 1.5f && uv.y >= 0.0f && uv.y <= 1.0f));
        const Vec4 color = mesh.colors[v];
        CHECK(
            (std::min({color.x, color.y, color.z}) >= 0
             && std::max({color.x, color.y, color.z}) <= 1));
    }
}

TEST_CASE("creature: at most four joints move a vertex, their weights sum to 1, all 24 have some") {
    const MeshData& mesh = creature();
    REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
    CHECK(kCreatureJoints == 24);
    std::vector<float> share(kCreatureJoints, 0.0f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::uint32_t first = mesh.skin.first[v];
        const std::uint32_t end = mesh.skin.first[v + 1];
        CHECK((end > first && end - first <= 4));
        float sum = 0;
        bool left = false;
        bool right = false;
        for (std::uint32_t i = first; i < end; ++i) {
            CHECK(mesh.skin.weights[i] > 0);
            sum += mesh.skin.weights[i];
            share[mesh.skin.joints[i]] += mesh.skin.weights[i];
            const float side = creature_joint(static_cast<CreatureJoint>(mesh.skin.joints[i])).x;
            left = left || (side > 0 && mesh.skin.weights[i] > 0.1f);
            right = right || (side < 0 && mesh.skin.weights[i] > 0.1f);
        }
        CHECK(sum == test::near(1).epsilon(1e-5));
        CHECK_FALSE((left && right && mesh.positions[v].y < 0.25f));  // legs do not stick together
    }
    for (const float some : share) {
        CHECK(some > 5);
    }
}

TEST_CASE("creature: skeleton, skin and clips are sound, and clips end as they begin") {
    CHECK(check_skeleton(rig().skeleton).ok());
    CHECK(check_skin(rig().skin, kCreatureJoints).ok());
    REQUIRE(rig().clips.size() == 4);
    for (const ClipData& clip : rig().clips) {
        INFO(clip.name);
        const Status status = check_clip(clip, kCreatureJoints, creature().morphs.size());
        CHECK_MESSAGE(status.ok(), status.error().message);
        const std::vector<Affine> start = joints_at(clip, 0);
        const std::vector<Affine> end = joints_at(clip, clip.duration);
        for (std::size_t i = 0; i < start.size(); ++i) {
            for (int row = 0; row < 3; ++row) {
                CHECK(glm::length(start[i].row[row] - end[i].row[row]) < 1e-5f);
            }
        }
    }
}

TEST_CASE(
    "creature: a planted foot moves with the ground, and does not sink or rise"
    * technique("char.foot-flight")) {
    for (const char* name : {"walk", "trot", "run", "idle"}) {
        INFO(std::string(name));
        const Gait& gait = gait_named(name);
        const ClipData& clip = clip_named(name);
        const float speed = gait_speed(gait);
        constexpr int kSteps = 192;
        float worst_slide = 0;
        float worst_rise = 0;
        for (std::size_t leg = 0; leg < kLegs; ++leg) {
            float planted = 0;
            bool stood = false;
            for (int i = 0; i < 2 * kSteps; ++i) {
                const float cycles = static_cast<float>(i) / kSteps;
                const float phase = cycles - std::floor(cycles);
                const Vec3 foot = place_of(joints_at(clip, phase * clip.duration), kFeet[leg]);
                const bool stands = stance_progress(gait, static_cast<Leg>(leg), phase) >= 0;
                const float on_ground = foot.z + speed * cycles * gait.period;
                if (stands && stood) {
                    worst_slide = std::max(worst_slide, std::abs(on_ground - planted));
                    worst_rise =
                        std::max(worst_rise, std::abs(foot.y - creature_joint(kFeet[leg]).y));
                } else {
                    planted = on_ground;
                }
                stood = stands;
            }
        }
        // Of a leg of 0.4 m; keys are straight between their times.
        CHECK(worst_slide < 0.004f);
        CHECK(worst_rise < 0.004f);
    }
}

TEST_CASE("creature: a walk sets down left hind, left fore, right hind, right fore, by quarters") {
    const Gait& walk = gait_named("walk");
    const auto when = [&](Leg leg) { return walk.touchdown[static_cast<std::size_t>(leg)]; };
    CHECK(when(Leg::LeftHind) == 0.0f);
    CHECK(when(Leg::LeftFront) == 0.25f);
    CHECK(when(Leg::RightHind) == 0.5f);
    CHECK(when(Leg::RightFront) == 0.75f);
    // In the clip: whoever is lifted is lifted after its touchdown and before the next.
    const ClipData& clip = clip_named("walk");
    for (int i = 0; i < 96; ++i) {
        const float phase = static_cast<float>(i) / 96;
        const std::vector<Affine> joints = joints_at(clip, phase * clip.duration);
        int down = 0;
        for (std::size_t leg = 0; leg < kLegs; ++leg) {
            const float height = place_of(joints, kFeet[leg]).y - creature_joint(kFeet[leg]).y;
            const bool stands = stance_progress(walk, static_cast<Leg>(leg), phase) >= 0;
            down += stands ? 1 : 0;
            CHECK(height > -0.004f);
            if (stands) {
                CHECK(height < 0.004f);
            }
        }
        CHECK(down >= 2);  // a walk never leaves the ground
    }
}

TEST_CASE("creature: a trot sets down diagonal pairs, and clips have the stances as contacts") {
    for (const Gait& gait : creature_gaits()) {
        INFO(std::string(gait.name));
        const ClipData& clip = clip_named(gait.name);
        for (std::size_t leg = 0; leg < kLegs; ++leg) {
            for (int i = 0; i < 96; ++i) {
                const float phase = (static_cast<float>(i) + 0.5f) / 96;
                const float time = phase * clip.duration;
                const bool stands = stance_progress(gait, static_cast<Leg>(leg), phase) >= 0;
                const bool touches = std::any_of(
                    clip.contacts.begin(), clip.contacts.end(), [&](const ClipContact& contact) {
                        return contact.joint == static_cast<std::uint16_t>(kFeet[leg])
                               && contact.begin <= time && time <= contact.end;
                    });
                CHECK(stands == touches);
            }
        }
    }
    const Gait& trot = gait_named("trot");
    CHECK(trot.touchdown[0] == trot.touchdown[3]);  // left fore, right hind
    CHECK(trot.touchdown[1] == trot.touchdown[2]);
    CHECK(trot.touchdown[0] == trot.touchdown[1] + 0.5f);
    CHECK(gait_speed(trot) > 2 * gait_speed(gait_named("walk")));
    CHECK(gait_speed(trot) < 0.6f * gait_speed(gait_named("run")));
}

TEST_CASE("creature: a run sets down both hind feet, then both fore feet, then flies") {
    const Gait& run = gait_named("run");
    const auto when = [&](Leg leg) { return run.touchdown[static_cast<std::size_t>(leg)]; };
    CHECK(when(Leg::LeftHind) < when(Leg::RightHind));
    CHECK(when(Leg::RightHind) < when(Leg::LeftFront));
    CHECK(when(Leg::LeftFront) < when(Leg::RightFront));
    int flying = 0;
    const ClipData& clip = clip_named("run");
    for (int i = 0; i < 96; ++i) {
        const std::vector<Affine> joints =
            joints_at(clip, static_cast<float>(i) / 96 * clip.duration);
        bool flies = true;
        for (std::size_t leg = 0; leg < kLegs; ++leg) {
            flies = flies && place_of(joints, kFeet[leg]).y > creature_joint(kFeet[leg]).y + 0.004f;
        }
        flying += flies ? 1 : 0;
    }
    CHECK(flying > 4);
    CHECK(flying < 40);
    CHECK(gait_speed(run) > 4 * gait_speed(gait_named("walk")));
}

TEST_CASE(
    "creature: a foot in the air rises in a third of its path and comes down in the rest"
    * technique("char.foot-flight")) {
    const Gait& walk = gait_named("walk");
    const ClipData& clip = clip_named("walk");
    for (const float s : {0.2f, 1.0f / 3, 0.5f, 0.8f}) {
        const float phase = walk.touchdown[1] + walk.duty + s * (1 - walk.duty);
        const float time = (phase - std::floor(phase)) * clip.duration;
        const Vec3 foot = place_of(joints_at(clip, time), CreatureJoint::RightPaw);
        const float height = foot.y - creature_joint(CreatureJoint::RightPaw).y;
        CHECK(std::abs(height - 0.5f * walk.lift * flight_height(s)) < 0.002f);
    }
}

TEST_CASE("creature: bones keep their lengths, and knees bend in the right direction") {
    for (const ClipData& clip : rig().clips) {
        INFO(clip.name);
        for (int i = 0; i < 48; ++i) {
            const std::vector<Affine> joints =
                joints_at(clip, clip.duration * static_cast<float>(i) / 48);
            const auto at = [&](CreatureJoint joint) { return place_of(joints, joint); };
            // Before the line from hip to hock; behind the one from shoulder to wrist.
            const Vec3 thigh = at(CreatureJoint::LeftHock) - at(CreatureJoint::LeftThigh);
            const Vec3 knee = at(CreatureJoint::LeftKnee) - at(CreatureJoint::LeftThigh);
            CHECK(glm::cross(thigh, knee).x < 1e-4f);
            const Vec3 arm = at(CreatureJoint::LeftWrist) - at(CreatureJoint::LeftShoulder);
            const Vec3 elbow = at(CreatureJoint::LeftElbow) - at(CreatureJoint::LeftShoulder);
            CHECK(glm::cross(arm, elbow).x > -1e-4f);
        }
    }
}

TEST_CASE("creature: blink closes the lids and moves nothing else, breath widens the chest") {
    const MeshData& mesh = creature();
    REQUIRE(mesh.morphs.size() == 2);
    CHECK(mesh.morphs[0].name == "blink");
    CHECK(mesh.morphs[1].name == "breath");
    for (const std::uint32_t v : mesh.morphs[0].vertices) {
        CHECK(mesh.positions[v].y > 0.58f);
        CHECK(mesh.positions[v].z > 0.25f);
    }
    const MeshData breathing = morphed(1);
    CHECK(signed_volume(breathing) > 1.01 * signed_volume(mesh));
    CHECK(open_edges(breathing) == 0);
    CHECK(open_edges(morphed(0)) == 0);
    for (const MorphTarget& morph : mesh.morphs) {
        CHECK(morph.normals.size() == morph.vertices.size());
        CHECK(morph.tangents.size() == morph.vertices.size());
    }
}

TEST_CASE("creature: twice the height doubles every length, on any number of threads") {
    const CreatureShape coarse = {.detail = 0.02f};
    const int before = thread_count();
    set_thread_count(1);
    const MeshData small = make_creature(coarse);
    set_thread_count(4);
    const MeshData again = make_creature(coarse);
    set_thread_count(before);
    CHECK(
        std::memcmp(
            small.positions.data(), again.positions.data(), small.positions.size() * sizeof(Vec3))
        == 0);
    const MeshData large = make_creature({.height = 0.9f, .detail = 0.02f});
    REQUIRE(large.positions.size() == small.positions.size());
    CHECK(glm::distance(large.bounds.max, 2.0f * small.bounds.max) < 1e-5f);
    const MeshRig large_rig = make_creature_rig({.height = 0.9f, .detail = 0.02f});
    CHECK(large_rig.skeleton.rest.translations[3] == 2.0f * rig().skeleton.rest.translations[3]);
    CHECK(
        large_rig.clips[1].sheets[0].translations[5]
        == 2.0f * clip_named(large_rig.clips[1].name).sheets[0].translations[5]);
}

TEST_CASE("creature: simplified to a twentieth it is closed, and keeps its weights and targets") {
    const MeshData mesh = make_creature({.detail = 0.012f, .triangles = 1400});
    CHECK(mesh.indices.size() / 3 > 700);
    CHECK(mesh.indices.size() / 3 < 1600);
    CHECK(open_edges(mesh) == 0);
    CHECK(signed_volume(mesh) == test::near(signed_volume(creature())).epsilon(0.06));
    CHECK(mesh.skin.first.size() == mesh.positions.size() + 1);
    CHECK(mesh.colors.size() == mesh.positions.size());
    for (const MorphTarget& morph : mesh.morphs) {
        CHECK(morph.vertices.size() > 10);
        CHECK(morph.vertices.back() < mesh.positions.size());
        CHECK(std::is_sorted(morph.vertices.begin(), morph.vertices.end()));
    }
}

TEST_CASE("creature: a level makes one, and names its skeleton, skin and clips") {
    register_all_components();
    Result<Level> level = parse_level(
        R"({"materials": {"fur": {}},
            "meshes": {"fox": {"make": "creature", "detail": 0.02}},
            "entities": [{"name": "fox", "mesh_instance": {"mesh": "fox", "material": "fur"},
                "skeleton": {"skeleton": "fox"}, "clip_player": {"clip": "fox.run"},
                "deformed": {"skin": "fox"}}]})",
        "den.level.json");
    REQUIRE_MESSAGE(level.ok(), level.error().message);
    const Status loaded = load_level_assets(*level, "");
    REQUIRE_MESSAGE(loaded.ok(), loaded.error().message);
    World world;
    Assets& assets = world.insert_resource(Assets{});
    assets.clips.resize(3);
    assets.skins.resize(1);
    const Entity fox = spawn_level(world, *std::move(level))[0];
    CHECK(
        world.resource<Assets>().clips[world.get<const ClipPlayer>(fox).clip.index].name
        == "fox.run");
    CHECK(world.get<const Deformed>(fox).skin.index == 1);
    CHECK(world.get<const Deformed>(fox).character == fox);
    start_world(world);
    CHECK(world.get<const Pose>(fox).joints.size() == kCreatureJoints);
    CHECK(world.get<const MorphWeights>(fox).weights.size() == 2);
}

}  // namespace limn::creature_test

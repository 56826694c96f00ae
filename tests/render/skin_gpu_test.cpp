// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/vertex_offset.h"
#include "render/skinning/deformed_list.h"
#include "render/skinning/skin_palette.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/deformer_system.h"
#include "systems/animation/skin_kernels.h"
#include "tests/near.h"
#include "tests/support.h"

#include <glm/geometric.hpp>

#include <string>
#include <vector>

namespace limn::test::skin_gpu_test {
namespace {

struct SkinTest : SkinScene {
    oracle::SkinReadbackVertices read(Entity entity, float alpha = 1, float previous_alpha = 0) {
        return gpu.run(world, std::vector<Entity>{entity}, alpha, previous_alpha)[0];
    }
    /// A tube of eleven joints, most of its vertices on several.
    Entity snake(Skinning skinning, int joints, int most, std::uint64_t seed) {
        Random random(seed, 0, 0, 0);
        MeshData tube = make_tube(4 * joints, 8, 0.25f * static_cast<float>(joints - 1));
        add_weights(tube, joints, most, random);
        const bool scaled = skinning == Skinning::Linear;
        Pose pose;
        pose.joints = random_joints(joints, 0.25f, 0.7f, scaled, random);
        pose.previous = random_joints(joints, 0.25f, 0.7f, scaled, random);
        return SkinScene::pose(
            add(std::move(tube)), gray, add_skin(make_chain(joints, 0.25f)), std::move(pose),
            skinning);
    }

    oracle::SkinReadback gpu = *oracle::SkinReadback::create(device());
    const MaterialId gray = add(Material{});
};

/// A tube of two joints, the upper one at `y` and turned; all vertices above 0 half and half.
struct Bend {
    MeshData mesh;
    SkinData skin;
    Pose pose;
};
Bend make_bend(const Vec3& axis, float angle, float upper_weight) {
    Bend bend = {.mesh = make_tube(4, 16, 1), .skin = {}, .pose = {}};
    bend.mesh.skin.first.push_back(0);
    for (std::size_t i = 0; i < bend.mesh.positions.size(); ++i) {
        bend.mesh.skin.joints.insert(bend.mesh.skin.joints.end(), {0, 1});
        bend.mesh.skin.weights.insert(
            bend.mesh.skin.weights.end(), {1 - upper_weight, upper_weight});
        bend.mesh.skin.first.push_back(static_cast<std::uint32_t>(2 * (i + 1)));
    }
    bend.skin = make_chain(2, 0);
    bend.pose.joints = {Affine{}, affine_from(Vec3(0), rotation_about(axis, angle), Vec3(1))};
    bend.pose.previous = bend.pose.joints;
    return bend;
}

float axis_distance(const Vec3& p) {
    return std::hypot(p.x, p.z);
}

}  // namespace

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: vertices match double precision within 1e-4 of the box"
                  * technique("char.skin-gpu")) {
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        for (const int joints : {2, 11, 300}) {  // 300: more than a byte counts
            const Entity entity = snake(skinning, joints, 6, static_cast<std::uint64_t>(joints));
            const oracle::SkinReadbackVertices got = read(entity);
            const auto want_now = want(entity);
            CHECK(largest_error(got.positions, want_now) <= 1e-4);
            CHECK(largest_error(got.before, want(entity, true)) <= 1e-4);
            double worst_normal = 0;
            double worst_tangent = 0;
            for (std::size_t i = 0; i < want_now.size(); ++i) {
                CHECK(std::abs(glm::length(got.normals[i]) - 1) <= 1e-4f);
                CHECK(got.tangents[i].w == 1.0f);
                worst_normal = std::max(
                    worst_normal, glm::distance(glm::dvec3(got.normals[i]), want_now[i].normal));
                worst_tangent = std::max(
                    worst_tangent,
                    glm::distance(glm::dvec3(Vec3(got.tangents[i])), want_now[i].tangent));
            }
            CHECK(worst_normal <= 2e-4);
            CHECK(worst_tangent <= 2e-4);
        }
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: the CPU kernels give the same vertices") {
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const Entity entity = snake(skinning, 11, 6, 2);
        const oracle::SkinReadbackVertices got = read(entity);
        const MeshData& mesh = mesh_of(entity);
        const SkinId skin = world.get<Deformed>(entity).skin;
        std::vector<Affine> palette(11);
        compute_skin_palette(
            world.resource<Assets>().skins[skin.index], world.get<Pose>(entity).joints, palette);
        std::vector<DualQuaternion> duals(11);
        compute_dual_palette(palette, duals);
        std::vector<Vec3> positions(mesh.positions.size());
        std::vector<Vec3> normals(positions.size());
        std::vector<Vec4> tangents(positions.size());
        const RestVertices rest = {mesh.positions, mesh.normals, mesh.tangents};
        const SkinnedVertices moved = {positions, normals, tangents};
        if (skinning == Skinning::Linear) {
            skin_linear(mesh.skin, palette, rest, moved, 0, positions.size());
        } else {
            skin_dual(mesh.skin, duals, rest, moved, 0, positions.size());
        }
        for (std::size_t i = 0; i < positions.size(); ++i) {
            CHECK(glm::distance(got.positions[i], positions[i]) <= 1e-5f);
            CHECK(glm::distance(got.normals[i], normals[i]) <= 2e-4f);
            CHECK(glm::distance(got.tangents[i], tangents[i]) <= 2e-4f);
        }
    }
}

TEST_CASE_FIXTURE(
    SkinTest,
    "skin_gpu: in the bind pose vertices do not move" * technique("char.skin-bone-offset")) {
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const Entity entity = snake(skinning, 7, 5, 3);
        Pose& pose = world.get<Pose>(entity);
        for (std::size_t j = 0; j < pose.joints.size(); ++j) {
            pose.joints[j] = at({0, 0.25f * static_cast<float>(j), 0});
        }
        const oracle::SkinReadbackVertices got = read(entity);
        const MeshData& rest = mesh_of(entity);
        for (std::size_t i = 0; i < rest.positions.size(); ++i) {
            CHECK(glm::distance(got.positions[i], rest.positions[i]) <= 1e-5f);
            CHECK(glm::distance(got.normals[i], rest.normals[i]) <= 1e-4f);
        }
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a rigid motion of all joints is that motion of all vertices"
                  * technique("char.skin-bone-offset")) {
    const Affine motion = affine_from({1, 2, 3}, rotation_about({1, 2, 0}, 1.1f), Vec3(1));
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const Entity entity = snake(skinning, 7, 5, 4);
        Pose& pose = world.get<Pose>(entity);
        for (std::size_t j = 0; j < pose.joints.size(); ++j) {
            pose.joints[j] = motion * at({0, 0.25f * static_cast<float>(j), 0});
        }
        const oracle::SkinReadbackVertices got = read(entity);
        const MeshData& rest = mesh_of(entity);
        for (std::size_t i = 0; i < rest.positions.size(); ++i) {
            const Vec3 want = transform_point(motion, rest.positions[i]);
            CHECK(glm::distance(got.positions[i], want) <= 2e-5f);
        }
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a joint of weight 1 moves a vertex rigidly, joints without weight do not"
                  * technique("char.skin-bone-offset")) {
    MeshData tube = make_tube(4, 8, 1);
    tube.skin.first.push_back(0);
    for (std::size_t i = 0; i < tube.positions.size(); ++i) {
        tube.skin.joints.insert(tube.skin.joints.end(), {1, 0});
        tube.skin.weights.insert(tube.skin.weights.end(), {1, 0});
        tube.skin.first.push_back(static_cast<std::uint32_t>(2 * (i + 1)));
    }
    const Affine carried = affine_from({1, 2, 3}, rotation_about({1, 1, 0}, 2), Vec3(1));
    Pose pose;
    pose.joints = {
        affine_from(Vec3(1e6f), Quat(1, 0, 0, 0), Vec3(-1e5f, 7, 0)), carried, at({0, 0, 0})};
    pose.joints[2].row[1] = Vec4(NAN);  // nobody's
    const SkinId skin = add_skin(make_chain(3, 0.5f));
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const Entity entity = SkinScene::pose(add(tube), gray, skin, pose, skinning);
        const oracle::SkinReadbackVertices got = read(entity);
        REQUIRE(got.positions.size() == tube.positions.size());
        for (std::size_t i = 0; i < tube.positions.size(); ++i) {
            // char.skin-rigid: as far from the joint as at rest.
            const Vec3 rest = tube.positions[i] - Vec3(0, 0.5f, 0);
            CHECK(glm::distance(got.positions[i], transform_point(carried, rest)) <= 1e-5f);
            const Vec3 normal = transform_vector(carried, tube.normals[i]);
            CHECK(glm::distance(got.normals[i], normal) <= 1e-4f);
        }
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: vertex offsets per joint equal the joint offsets") {
    const Entity entity = snake(Skinning::Linear, 9, 4, 5);
    const std::vector<Vec3> got = read(entity).positions;
    const MeshData& mesh = mesh_of(entity);
    const Pose& pose = world.get<Pose>(entity);
    const SkinData& skin = world.resource<Assets>().skins[0];
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Vec3 sum(0);  // char.skin-vertex-offset: o = M_rest^-1 v, v' = sum w M o
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            const std::uint16_t j = mesh.skin.joints[i];
            const Vec3 offset = transform_point(skin.joint_from_mesh[j], mesh.positions[v]);
            sum += mesh.skin.weights[i] * transform_point(pose.joints[j], offset);
        }
        CHECK(glm::distance(got[v], sum) <= 1e-5f);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: skinned by vertex offsets, vertices are those of linear skinning"
                  * technique("char.skin-vertex-offset")) {
    for (const int joints : {2, 11, 300}) {
        const Entity entity = snake(Skinning::Linear, joints, 4, 50);
        const oracle::SkinReadbackVertices standard = read(entity);
        world.add(entity, VertexOffsetSkinning{});
        const oracle::SkinReadbackVertices offset = read(entity);
        REQUIRE(offset.positions.size() == standard.positions.size());
        const float scale = std::max(1.0f, size_of(standard.positions));
        bool same_bits = true;
        for (std::size_t i = 0; i < offset.positions.size(); ++i) {
            CHECK(glm::distance(offset.positions[i], standard.positions[i]) <= 1e-5f * scale);
            CHECK(glm::distance(offset.before[i], standard.before[i]) <= 1e-5f * scale);
            CHECK(std::abs(glm::length(offset.normals[i]) - 1) <= 1e-4f);
            same_bits = same_bits && offset.positions[i] == standard.positions[i];
        }
        CHECK_FALSE(same_bits);  // another program
        world.remove<VertexOffsetSkinning>(entity);
        const oracle::SkinReadbackVertices again = read(entity);
        CHECK(again.positions == standard.positions);
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: vertex offsets turn normals and tangents with their joint"
                  * technique("char.skin-vertex-offset")) {
    const Bend bend = make_bend({1, 2, 0}, 1.2f, 1.0f);
    const Entity entity = pose(add(bend.mesh), gray, add_skin(bend.skin), bend.pose);
    const oracle::SkinReadbackVertices standard = read(entity);
    world.add(entity, VertexOffsetSkinning{});
    const oracle::SkinReadbackVertices offset = read(entity);
    for (std::size_t i = 0; i < offset.normals.size(); ++i) {
        CHECK(glm::distance(offset.normals[i], standard.normals[i]) <= 1e-4f);
        CHECK(glm::distance(offset.tangents[i], standard.tangents[i]) <= 1e-4f);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: vertex offsets take 12 numbers an influence, and the joints as they are"
                  * technique("char.skin-vertex-offset")) {
    MeshData tube = make_tube(4, 8, 1);
    const auto vertices = static_cast<std::uint32_t>(tube.positions.size());
    tube.skin.first.push_back(0);
    for (std::uint32_t i = 1; i <= vertices; ++i) {
        tube.skin.joints.insert(tube.skin.joints.end(), {0, 1, 2, 3});
        tube.skin.weights.insert(tube.skin.weights.end(), {0.4f, 0.3f, 0.2f, 0.1f});
        tube.skin.first.push_back(4 * i);
    }
    const MeshId mesh = add(std::move(tube));
    const SkinId skin = add_skin(make_chain(4, 0.25f));
    const auto& assets = world.resource<Assets>();
    RestPool pool;
    // Of four influences: position, normal, weight and joint of each are 32 numbers beside 14 of
    // joint offsets, which have position and normal once.
    const std::uint32_t at_rest = 3 * (vertices + 1);
    CHECK(pool.get(assets, mesh).texel_count == at_rest + 2 * vertices);
    CHECK(pool.get_joint_offsets(assets, mesh, skin).texel_count == at_rest + 12 * vertices);

    Pose pose;
    pose.joints = {at({1, 2, 3}), at({4, 5, 6}), at({7, 8, 9}), at({1, 1, 1})};
    std::vector<Affine> palette;
    make_joint_palette(&assets.skins[skin.index], &pose, {}, palette);
    REQUIRE(palette.size() == 4);
    CHECK(to_mat4(palette[2]) == to_mat4(pose.joints[2]));
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: vertex offsets leave dual quaternions and morphs as they are") {
    const Entity dual = snake(Skinning::DualQuaternion, 5, 4, 51);
    const std::vector<Vec3> before = read(dual).positions;
    world.add(dual, VertexOffsetSkinning{});
    CHECK(read(dual).positions == before);
    world.destroy(dual);

    Random random(52, 0, 0, 0);
    Bend bend = make_bend({1, 0, 0}, 0.8f, 1.0f);
    add_morphs(bend.mesh, 1, 2, 0.1f, random);
    const Entity morphed = pose(add(bend.mesh), gray, add_skin(bend.skin), bend.pose);
    world.add(morphed, MorphWeights{.weights = {1}, .previous = {1}});
    const std::vector<Vec3> bent = read(morphed).positions;
    world.add(morphed, VertexOffsetSkinning{});
    CHECK(read(morphed).positions == bent);
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a twist by half weights keeps the radius with dual quaternions") {
    for (const float angle : {30.0f, 60.0f, 90.0f, 120.0f, 150.0f, 179.0f}) {
        Bend bend = make_bend({0, 1, 0}, radians(angle), 0.5f);
        const MeshId mesh = add(bend.mesh);
        const SkinId skin = add_skin(bend.skin);
        const Entity linear = pose(mesh, gray, skin, bend.pose);
        const Entity dual = pose(mesh, gray, skin, bend.pose, Skinning::DualQuaternion);
        const std::vector<Vec3> shrunk = read(linear).positions;
        const std::vector<Vec3> kept = read(dual).positions;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            CHECK(axis_distance(kept[i]) / 0.2f >= 0.99f);
            CHECK(axis_distance(kept[i]) / 0.2f <= 1.01f);
            // char.skin-defects: r cos(a / 2).
            const float want = 0.2f * std::cos(radians(angle) / 2);
            CHECK(axis_distance(shrunk[i]) == test::near(want).epsilon(1e-4));
        }
        world.destroy(linear);
        world.destroy(dual);
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: dual quaternions blend along the shorter arc") {
    Bend bend = make_bend({0, 1, 0}, radians(100.0f), 0.5f);
    bend.pose.joints[0] =
        affine_from(Vec3(0), rotation_about({0, 1, 0}, radians(-100.0f)), Vec3(1));
    const Entity entity =
        pose(add(bend.mesh), gray, add_skin(bend.skin), bend.pose, Skinning::DualQuaternion);
    const std::vector<Vec3> got = read(entity).positions;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const Vec3 rest = bend.mesh.positions[i];
        CHECK(glm::distance(got[i], Vec3(-rest.x, rest.y, -rest.z)) <= 1e-5f);  // 180, not 0
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: a twist by half a turn leaves unit normals") {
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const Bend bend = make_bend({0, 1, 0}, kPi, 0.4f);
        const Bend worst = make_bend({0, 1, 0}, kPi, 0.5f);
        for (const Bend& one : {bend, worst}) {
            const Entity entity = pose(add(one.mesh), gray, add_skin(one.skin), one.pose, skinning);
            const oracle::SkinReadbackVertices got = read(entity);
            for (std::size_t i = 0; i < got.normals.size(); ++i) {
                CHECK(std::abs(glm::length(got.normals[i]) - 1) <= 1e-4f);
                CHECK(std::isfinite(got.positions[i].x));
            }
        }
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: 300 morph targets add up as in double precision") {
    Random random(7, 0, 0, 0);
    MeshData ball = make_ball(12);
    add_morphs(ball, 300, 3, 0.05f, random);
    const MeshId mesh = add(std::move(ball));
    const Entity entity = place(mesh, gray, {});
    MorphWeights morphs;
    for (int i = 0; i < 304; ++i) {
        const bool on = random.below(3) != 0;
        morphs.weights.push_back(on ? random.uniform(-0.5f, 1.5f) : 0.0f);
        morphs.previous.push_back(random.uniform());
    }
    world.add(entity, morphs);
    world.add(entity, Deformed{entity, {}, 4, Skinning::Linear});
    const oracle::SkinReadbackVertices got = read(entity);
    const auto now = want(entity);
    CHECK(largest_error(got.positions, now) <= 1e-4);
    CHECK(largest_error(got.before, want(entity, true)) <= 1e-4);
    for (std::size_t i = 0; i < now.size(); ++i) {
        CHECK(glm::distance(glm::dvec3(got.normals[i]), now[i].normal) <= 4e-3);
    }
    // Fewer weights than targets: the others are 0. No number: 0.
    world.get<MorphWeights>(entity).weights.resize(10);
    world.get<MorphWeights>(entity).previous.resize(10);
    CHECK(largest_error(read(entity).positions, want(entity)) <= 1e-4);
    world.get<MorphWeights>(entity).weights[5] = NAN;
    world.get<MorphWeights>(entity).previous[5] = NAN;
    const oracle::SkinReadbackVertices without = read(entity);
    world.get<MorphWeights>(entity).weights[5] = 0;
    CHECK(largest_error(without.positions, want(entity)) <= 1e-4);
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a morph target moves only its vertices, then joints rotate all") {
    Random random(8, 0, 0, 0);
    Bend bend = make_bend({1, 0, 0}, 0.8f, 1.0f);
    add_morphs(bend.mesh, 1, 2, 0.1f, random);
    const SkinId skin = add_skin(bend.skin);
    const Entity entity = pose(add(bend.mesh), gray, skin, bend.pose);
    const std::vector<Vec3> without = read(entity).positions;
    world.add(entity, MorphWeights{.weights = {1}, .previous = {1}});
    const std::vector<Vec3> with = read(entity).positions;
    const MorphTarget& target = mesh_of(entity).morphs[0];
    for (std::uint32_t v = 0; v < with.size(); ++v) {
        const auto found = std::find(target.vertices.begin(), target.vertices.end(), v);
        if (found == target.vertices.end()) {
            CHECK(with[v] == without[v]);
            continue;
        }
        const Vec3 offset =
            target.positions[static_cast<std::size_t>(found - target.vertices.begin())];
        const Vec3 want = without[v] + transform_vector(bend.pose.joints[1], offset);
        CHECK(glm::distance(with[v], want) <= 1e-6f);
    }
}

TEST_CASE_FIXTURE(
    SkinTest,
    "skin_gpu: previous positions are those of the last frame" * technique("char.skin-gpu")) {
    const Entity entity = snake(Skinning::Linear, 11, 4, 9);
    Random random(9, 1, 0, 0);
    std::vector<Vec3> last = read(entity).positions;
    for (int frame = 0; frame < 3; ++frame) {
        Pose& pose = world.get<Pose>(entity);
        pose.previous = pose.joints;
        pose.joints = random_joints(11, 0.25f, 0.5f, true, random);
        const oracle::SkinReadbackVertices got = read(entity);
        CHECK(got.before == last);
        CHECK(got.positions != last);
        last = got.positions;
    }
    // A character that has just come was always there: no motion.
    world.get<Pose>(entity).previous.clear();
    const oracle::SkinReadbackVertices spawned = read(entity);
    CHECK(spawned.before == spawned.positions);
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: between two steps joints are interpolated componentwise") {
    const Entity entity = snake(Skinning::Linear, 5, 4, 10);
    const oracle::SkinReadbackVertices ends = read(entity, 1, 0);
    const oracle::SkinReadbackVertices between = read(entity, 0.25f, -0.5f);
    for (std::size_t i = 0; i < ends.positions.size(); ++i) {
        // Linear blending is linear in the joints.
        const Vec3 motion = ends.positions[i] - ends.before[i];
        CHECK(glm::distance(between.positions[i], ends.before[i] + 0.25f * motion) <= 1e-5f);
        CHECK(glm::distance(between.before[i], ends.before[i] - 0.5f * motion) <= 1e-5f);
    }
}

TEST_CASE_FIXTURE(SkinTest, "skin_gpu: no vertex leaves the box that culls it") {
    Random random(11, 0, 0, 0);
    for (int i = 0; i < 40; ++i) {
        const Skinning skinning = i % 2 == 0 ? Skinning::Linear : Skinning::DualQuaternion;
        MeshData tube = make_tube(20, 8, 1);
        add_weights(tube, 5, 2 + i % 3, random);
        add_morphs(tube, 3, 2, 0.3f, random);
        Pose pose;
        const bool wild = i < 30;
        pose.joints = random_joints(5, 0.25f, wild ? kPi : 0.4f, i % 4 == 0, random);
        const Entity entity = SkinScene::pose(
            add(std::move(tube)), gray, add_skin(make_chain(5, 0.25f)), pose, skinning);
        const float most = wild ? 1.0f : 0.1f;
        MorphWeights morphs;
        for (int t = 0; t < 3; ++t) {
            morphs.weights.push_back(random.uniform(-most, most));
        }
        world.add(entity, morphs);
        const std::vector<Vec3> got = read(entity).positions;
        const Bounds box = gpu.shapes()[gpu.shapes().find(entity)].bounds;
        const Vec3 slack = Vec3(1e-5f);
        for (const Vec3& p : got) {
            CHECK(glm::all(glm::lessThanEqual(box.min - slack, p)));
            CHECK(glm::all(glm::lessThanEqual(p, box.max + slack)));
        }
        CHECK((wild || glm::length(box.max - box.min) < 2 * size_of(got)));
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a twist far from its axis stays in the box throughout its arc") {
    Bend bend = make_bend({0, 1, 0}, radians(170.0f), 0.5f);
    for (Vec3& p : bend.mesh.positions) {
        p.x += 2;
    }
    bend.mesh.bounds = {};
    const Entity entity =
        pose(add(bend.mesh), gray, add_skin(bend.skin), bend.pose, Skinning::DualQuaternion);
    const std::vector<Vec3> got = read(entity).positions;
    const Bounds box = gpu.shapes()[gpu.shapes().find(entity)].bounds;
    for (const Vec3& p : got) {
        CHECK(p.z < -1);
        CHECK(p.z >= box.min.z);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: only drawn and changed meshes are computed, once for all views") {
    const Entity first = snake(Skinning::Linear, 5, 4, 12);
    const Entity second = snake(Skinning::DualQuaternion, 5, 4, 13);
    world.get<Pose>(first).previous = world.get<Pose>(first).joints;
    world.get<Pose>(second).previous = world.get<Pose>(second).joints;
    const std::vector<Entity> both = {first, second};
    const auto computed = [&](const std::vector<Entity>& drawn, float alpha) {
        gpu.run(world, drawn, alpha, 0, true, 3);
        return gpu.shapes().work().instances;
    };
    CHECK(computed({first}, 1) == 1);
    CHECK(computed(both, 1) == 1);
    CHECK(computed(both, 1) == 0);  // a still herd costs nothing
    CHECK(computed(both, 0.5f) == 0);
    world.get<Pose>(first).joints[2].row[0].w += 0.1f;
    CHECK(computed({second}, 1) == 0);  // not seen
    CHECK(computed(both, 1) == 1);
    CHECK(computed(both, 1) == 0);
    CHECK(computed(both, 0.5f) == 1);
    world.get<Deformed>(second).skinning = Skinning::Linear;
    CHECK(computed(both, 0.5f) == 1);
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a thousand instances are one dispatch, each with its own pose"
                  * technique("char.skin-gpu")) {
    Random random(14, 0, 0, 0);
    MeshData tube = make_tube(8, 6, 1);
    add_weights(tube, 5, 4, random);
    const MeshId mesh = add(std::move(tube));
    const SkinId skin = add_skin(make_chain(5, 0.25f));
    std::vector<Entity> herd;
    for (int i = 0; i < 1000; ++i) {
        Pose posed;
        posed.joints = random_joints(5, 0.25f, 0.6f, false, random);
        herd.push_back(pose(mesh, gray, skin, std::move(posed)));
    }
    device().reset_stats();
    const std::vector<oracle::SkinReadbackVertices> got = gpu.run(world, herd);
    CHECK(device().stats().dispatches == 1);
    for (std::size_t i = 0; i < herd.size(); i += 111) {
        CHECK(largest_error(got[i].positions, want(herd[i])) <= 1e-4);
    }
    // Where a storage block shows 1024 vertices, several dispatches do the same.
    oracle::SkinReadback narrow =
        *oracle::SkinReadback::create(device(), 1024 * sizeof(PackedFrame));
    device().reset_stats();
    const std::vector<oracle::SkinReadbackVertices> same = narrow.run(world, herd);
    CHECK(device().stats().dispatches > 50);
    for (std::size_t i = 0; i < herd.size(); i += 37) {
        CHECK(same[i].positions == got[i].positions);
        CHECK(same[i].normals == got[i].normals);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a removed instance frees its vertices, and the others keep theirs") {
    std::vector<Entity> herd;
    for (std::uint64_t i = 0; i < 24; ++i) {
        herd.push_back(snake(Skinning::Linear, 2 + static_cast<int>(i % 5) * 3, 4, 20 + i));
    }
    gpu.run(world, herd);
    const std::uint32_t used = gpu.shapes().vertices().slots().used();
    const std::uint32_t capacity = gpu.shapes().vertices().slots().capacity();
    for (std::size_t i = 0; i < herd.size(); i += 2) {
        world.destroy(herd[i]);
        herd[i] = {};
    }
    std::erase(herd, Entity{});
    gpu.run(world, {});
    CHECK(gpu.shapes().vertices().slots().used() < used);
    for (std::uint64_t i = 0; i < 12; ++i) {
        herd.push_back(snake(Skinning::Linear, 2 + static_cast<int>(i % 5) * 3, 4, 50 + i));
    }
    const std::vector<oracle::SkinReadbackVertices> got = gpu.run(world, herd);
    CHECK(gpu.shapes().vertices().slots().capacity() == capacity);
    for (std::size_t i = 0; i < herd.size(); ++i) {
        CHECK(largest_error(got[i].positions, want(herd[i])) <= 1e-4);
    }
    // Growing keeps what is there, without another look at it.
    herd.push_back(snake(Skinning::Linear, 200, 4, 90));
    const std::vector<oracle::SkinReadbackVertices> more = gpu.run(world, herd);
    CHECK(gpu.shapes().vertices().slots().capacity() > capacity);
    CHECK(gpu.shapes().work().instances == 1);
    for (std::size_t i = 0; i < herd.size(); ++i) {
        CHECK(largest_error(more[i].positions, want(herd[i])) <= 1e-4);
    }
    world.clear();
    world.insert_resource(Assets{});
    gpu.forget();
    CHECK(gpu.shapes().vertices().slots().used() == 0);
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: deformers move vertices and normals as on the CPU"
                  * technique("face.ffd, face.pull, face.waters-muscle")) {
    const Entity entity = world.create(
        Transform{}, WorldTransform{}, MeshInstance{add(make_tube(24, 24, 1)), gray},
        Deformers{
            .muscles =
                {{.attachment = {0, 0.2f, 0},
                  .insertion = {0.3f, 0.6f, 0.1f},
                  .angle = 0.9f,
                  .full = 0.3f,
                  .reach = 0.7f,
                  .contraction = 0.3f},
                 {.attachment = {0, 0.9f, 0},
                  .insertion = {0.2f, 0.5f, 0},
                  .angle = 1.2f,
                  .full = 0.2f,
                  .reach = 0.5f,
                  .contraction = -0.2f}},
            .sphincters =
                {{.center = {0.1f, 0.5f, 0},
                  .right = {0, 0, 0.4f},
                  .up = {0, 0.3f, 0},
                  .depth = 0.4f,
                  .contraction = 0.6f}},
            .lattices =
                {{.origin = {-0.5f, 0.4f, -0.5f},
                  .offsets = std::vector<Vec3>(kLatticePoints, Vec3(0.1f, 0.05f, 0))}},
            .tugs = {{.at = {0.2f, 0.7f, 0.1f}, .offset = {0.05f, 0.1f, 0}, .radius = 0.4f}}});
    world.get<Deformers>(entity).lattices[0].offsets[27] = {0.2f, -0.3f, 0.3f};
    world.run(add_deformer_states);
    world.run(update_deformers);
    world.get<Deformers>(entity).muscles[0].contraction = 0.6f;
    world.run(update_deformers);
    const DeformerState& state = world.get<DeformerState>(entity);
    const MeshData& mesh = mesh_of(entity);
    const oracle::SkinReadbackVertices got = read(entity, 1, 0);
    REQUIRE(got.positions.size() == mesh.positions.size());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < got.positions.size(); ++i) {
        const Vec3 rest = mesh.positions[i];
        CHECK(glm::distance(got.positions[i], deform_point(state.now, rest)) <= 1e-5f);
        CHECK(glm::distance(got.before[i], deform_point(state.previous, rest)) <= 1e-5f);
        CHECK(
            glm::distance(got.normals[i], deform_normal(state.now, rest, mesh.normals[i]))
            <= 3e-3f);
        moved += glm::distance(got.positions[i], rest) > 0.01f ? 1 : 0;
    }
    CHECK(moved > mesh.positions.size() / 2);
    // Half a step earlier.
    const oracle::SkinReadbackVertices half = read(entity, 0.5f, 0);
    std::vector<Vec4> between;
    for (std::size_t i = 0; i < state.now.size(); ++i) {
        between.push_back(0.5f * (state.previous[i] + state.now[i]));
    }
    for (std::size_t i = 0; i < half.positions.size(); ++i) {
        CHECK(glm::distance(half.positions[i], deform_point(between, mesh.positions[i])) <= 1e-5f);
    }
}

TEST_CASE_FIXTURE(
    SkinTest, "skin_gpu: a mesh that cannot be deformed stays at rest, logged in one line") {
    const auto complaint = [&](Entity entity) {
        const std::vector<std::string> messages = messages_of([&] {
            for (int frame = 0; frame < 2; ++frame) {
                CHECK(read(entity).positions.empty());
            }
        });
        gpu.forget();
        REQUIRE(messages.size() == 1);
        CHECK(messages[0].find("tube") != std::string::npos);
        CHECK(messages[0].find("in rest pose") != std::string::npos);
        world.destroy(entity);
        return messages[0];
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    Entity entity = snake(Skinning::Linear, 5, 4, 30);
    const Entity gone = world.create();
    world.get<Deformed>(entity).character = gone;
    CHECK(has(complaint(entity), "neither Pose nor MorphWeights"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Deformed>(entity).character = gone;
    world.destroy(gone);
    CHECK(has(complaint(entity), "is gone"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Deformed>(entity).character = {};
    CHECK(has(complaint(entity), "is gone"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Pose>(entity).joints.resize(4);
    CHECK(has(complaint(entity), "uses joint 4, but its character's pose has 4"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Deformed>(entity).skin = add_skin(make_chain(3, 0.25f));
    CHECK(has(complaint(entity), "use 5 joints, but skin chain has 3"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Deformed>(entity).skin = {77};
    CHECK(has(complaint(entity), "skin 77"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<Pose>(entity).joints[3].row[1].y = NAN;
    CHECK(has(complaint(entity), "not finite"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    world.get<MeshInstance>(entity).mesh = add(make_tube(2, 5, 1));
    CHECK(has(complaint(entity), "neither joints, morph targets nor deformers"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    MeshData broken = mesh_of(entity);
    broken.skin.first.pop_back();
    world.get<MeshInstance>(entity).mesh = add(broken);
    CHECK(has(complaint(entity), "ranges"));
    entity = snake(Skinning::Linear, 5, 4, 30);
    broken = mesh_of(entity);
    broken.morphs.push_back(
        {.name = "far",
         .action_unit = {},
         .vertices = {99999},
         .positions = {Vec3(0)},
         .normals = {},
         .tangents = {}});
    world.get<MeshInstance>(entity).mesh = add(broken);
    CHECK(has(complaint(entity), "vertex 99999"));
}

TEST_CASE("slot_allocator: freed ranges are reused, and adjacent ones merge") {
    SlotAllocator slots;
    CHECK_FALSE(slots.allocate(1).has_value());
    slots.grow(100);
    CHECK(slots.allocate(40) == 0u);
    CHECK(slots.allocate(30) == 40u);
    CHECK(slots.allocate(20) == 70u);
    CHECK_FALSE(slots.allocate(11).has_value());
    slots.release(40, 30);
    CHECK(slots.gaps() == 2);
    CHECK(slots.allocate(10) == 40u);
    slots.release(70, 20);
    CHECK(slots.gaps() == 1);
    CHECK(slots.allocate(50) == 50u);
    slots.release(0, 40);
    slots.release(40, 10);
    slots.release(50, 50);
    CHECK(slots.gaps() == 1);
    CHECK(slots.used() == 0);
    slots.grow(150);
    CHECK(slots.allocate(150) == 0u);
}

}  // namespace limn::test::skin_gpu_test

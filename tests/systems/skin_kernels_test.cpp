#include "bench/oracles/skin_offset_oracle.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/skin_kernels.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>

namespace limn::skin_kernels_test {

using namespace limn::test;

namespace {

/// A mesh at rest on a posed skeleton, and where it went.
struct Puppet {
    SkeletonData skeleton;
    SkinData skin;
    MeshData mesh;
    std::vector<Affine> joints;
    std::vector<Affine> palette;
    std::vector<DualQuaternion> duals;
    MeshData moved;

    void bind() {
        std::vector<Affine> rest(skeleton.joints.size());
        compute_joint_matrices(skeleton, skeleton.rest, rest);
        skin.joints.clear();
        skin.joint_from_mesh.clear();
        for (std::size_t i = 0; i < rest.size(); ++i) {
            skin.joints.push_back(static_cast<std::uint16_t>(i));
            skin.joint_from_mesh.push_back(to_affine(glm::inverse(to_mat4(rest[i]))));
        }
        pose(skeleton.rest);
    }
    void pose(const LocalPose& local) {
        joints.resize(skeleton.joints.size());
        compute_joint_matrices(skeleton, local, joints);
        palette.resize(joints.size());
        duals.resize(joints.size());
        compute_skin_palette(skin, joints, palette);
        compute_dual_palette(palette, duals);
        moved = mesh;
    }
    [[nodiscard]] RestVertices rest() const {
        return {mesh.positions, mesh.normals, mesh.tangents};
    }
    SkinnedVertices target() { return {moved.positions, moved.normals, moved.tangents}; }
    void linear() { skin_linear(mesh.skin, palette, rest(), target(), 0, mesh.positions.size()); }
    void dual() { skin_dual(mesh.skin, duals, rest(), target(), 0, mesh.positions.size()); }
};

void add_vertex(
    MeshData& mesh, const Vec3& position, const std::vector<std::pair<int, float>>& by) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normalize_or(Vec3(position.x, 0, position.z), Vec3(0, 0, 1)));
    mesh.tangents.emplace_back(any_perpendicular(mesh.normals.back()), -1.0f);
    if (mesh.skin.first.empty()) {
        mesh.skin.first.push_back(0);
    }
    for (const auto& [joint, weight] : by) {
        mesh.skin.joints.push_back(static_cast<std::uint16_t>(joint));
        mesh.skin.weights.push_back(weight);
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
}

/// Vertices around a chain of `joints`, with up to `most` influences each.
Puppet make_puppet(std::size_t joints, std::size_t vertices, std::size_t most) {
    Puppet puppet;
    puppet.skeleton = make_chain(joints);
    Random random(7, 0, name_hash("puppet"), 0);
    for (std::size_t v = 0; v < vertices; ++v) {
        const float height = random.uniform(0, static_cast<float>(joints));
        std::vector<std::pair<int, float>> by;
        const std::size_t count = v % (most + 1);  // some have none
        float sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto joint = (static_cast<std::size_t>(height) + i) % joints;
            by.emplace_back(static_cast<int>(joint), random.uniform(0.1f, 1));
            sum += by.back().second;
        }
        for (auto& [joint, weight] : by) {
            weight /= sum;
        }
        const Vec3 around = random.direction();
        add_vertex(puppet.mesh, Vec3(around.x, height, around.z), by);
    }
    puppet.bind();
    return puppet;
}

LocalPose random_pose(const SkeletonData& skeleton, float most) {
    Random random(11, 0, name_hash("pose"), 0);
    LocalPose pose = skeleton.rest;
    for (Quat& rotation : pose.rotations) {
        rotation = rotation_about(random.direction(), random.uniform(-most, most));
    }
    pose.translations[0] = {3, -2, 5};
    return pose;
}

/// A tube around the second of two joints, half on each, whose upper joint is turned.
Puppet make_tube(const Vec3& axis, float angle, float upper_weight) {
    Puppet puppet;
    puppet.skeleton = make_chain(2);
    for (int i = 0; i < 16; ++i) {
        const float turn = 2.0f * kPi * static_cast<float>(i) / 16.0f;
        add_vertex(
            puppet.mesh, Vec3(std::cos(turn), 1, std::sin(turn)),
            {{0, 1 - upper_weight}, {1, upper_weight}});
    }
    puppet.bind();
    LocalPose pose = puppet.skeleton.rest;
    pose.rotations[1] = rotation_about(axis, radians(angle));
    puppet.pose(pose);
    return puppet;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

double error_of(const Vec3& found, const glm::dvec3& exact) {
    return glm::length(glm::dvec3(found) - exact);
}

}  // namespace

TEST_CASE(
    "skin: at rest every vertex stays, and the palette changes nothing"
    * technique("char.skin-rigid")) {
    Puppet puppet = make_puppet(20, 200, 4);
    for (const Affine& m : puppet.palette) {
        for (int row = 0; row < 3; ++row) {
            CHECK(glm::length(m.row[row] - Affine().row[row]) < 1e-5f);
        }
    }
    for (const bool is_dual : {false, true}) {
        is_dual ? puppet.dual() : puppet.linear();
        for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
            CHECK(glm::distance(puppet.moved.positions[v], puppet.mesh.positions[v]) < 2e-5f);
            CHECK(glm::distance(puppet.moved.normals[v], puppet.mesh.normals[v]) < 1e-5f);
            CHECK(glm::distance(puppet.moved.tangents[v], puppet.mesh.tangents[v]) < 1e-5f);
        }
    }
}

TEST_CASE("skin: a motion of the root moves all vertices rigidly") {
    Puppet puppet = make_puppet(12, 300, 6);
    LocalPose pose = puppet.skeleton.rest;
    const Affine motion = affine_from({1, 2, 3}, rotation_about({1, -2, 0.5f}, 1.2f), Vec3(1));
    pose.translations[0] = {1, 2, 3};
    pose.rotations[0] = rotation_about({1, -2, 0.5f}, 1.2f);
    puppet.pose(pose);
    for (const bool is_dual : {false, true}) {
        is_dual ? puppet.dual() : puppet.linear();
        for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
            if (puppet.mesh.skin.first[v] == puppet.mesh.skin.first[v + 1]) {
                CHECK(puppet.moved.positions[v] == puppet.mesh.positions[v]);  // without joints
                continue;
            }
            const Vec3 p = transform_point(motion, puppet.mesh.positions[v]);
            CHECK(glm::distance(puppet.moved.positions[v], p) < 3e-5f);
            const Vec3 n = transform_vector(motion, puppet.mesh.normals[v]);
            CHECK(glm::distance(puppet.moved.normals[v], n) < 1e-5f);
            const Vec3 t = transform_vector(motion, Vec3(puppet.mesh.tangents[v]));
            CHECK(glm::distance(Vec3(puppet.moved.tangents[v]), t) < 1e-5f);
            CHECK(puppet.moved.tangents[v].w == -1);
        }
    }
}

TEST_CASE(
    "skin: vertices of one joint keep their distances, to it and to each other"
    * technique("char.skin-rigid")) {
    Puppet puppet = make_puppet(6, 90, 1);
    puppet.pose(random_pose(puppet.skeleton, 3));
    for (const bool is_dual : {false, true}) {
        is_dual ? puppet.dual() : puppet.linear();
        for (std::size_t v = 1; v + 2 < puppet.mesh.positions.size(); v += 2) {
            const auto joint = puppet.mesh.skin.joints[puppet.mesh.skin.first[v]];
            const Vec3 bone = transform_point(puppet.joints[joint], Vec3(0));
            const Vec3 bone_at_rest(0, static_cast<float>(joint), 0);
            CHECK(
                glm::distance(puppet.moved.positions[v], bone)
                == test::near(glm::distance(puppet.mesh.positions[v], bone_at_rest)).epsilon(1e-5));
            if (puppet.mesh.skin.joints[puppet.mesh.skin.first[v + 2]] == joint) {
                CHECK(
                    glm::distance(puppet.moved.positions[v], puppet.moved.positions[v + 2])
                    == test::near(
                           glm::distance(puppet.mesh.positions[v], puppet.mesh.positions[v + 2]))
                           .epsilon(1e-5));
            }
        }
    }
}

TEST_CASE(
    "skin: the mean of matrices agrees with offsets in joint space, in double precision"
    * technique("char.skin-cpu")) {
    Puppet puppet = make_puppet(24, 1000, 8);
    puppet.pose(random_pose(puppet.skeleton, 0.8f));
    puppet.linear();
    for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
        if (puppet.mesh.skin.first[v] == puppet.mesh.skin.first[v + 1]) {
            continue;
        }
        const glm::dvec3 exact =
            oracle::skin_by_offsets(puppet.mesh, puppet.skin, puppet.joints, v);
        CHECK(error_of(puppet.moved.positions[v], exact) < 1e-5 * 24);  // of the box
        CHECK(glm::length(puppet.moved.normals[v]) == test::near(1).epsilon(1e-5));
        CHECK(glm::length(Vec3(puppet.moved.tangents[v])) == test::near(1).epsilon(1e-5));
    }
}

TEST_CASE(
    "skin: the mean of screw motions agrees with its definition in double precision"
    * technique("char.skin-defects")) {
    for (const float angle : {10.0f, 80.0f, 170.0f, 260.0f}) {
        for (const float weight : {0.1f, 0.5f, 0.75f}) {
            Puppet puppet = make_tube(Vec3(0.3f, 1, 0.2f), angle, weight);
            puppet.dual();
            for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
                const glm::dvec3 exact = oracle::move_by_screws(
                    oracle::double_matrix(puppet.palette[0]),
                    oracle::double_matrix(puppet.palette[1]), static_cast<double>(weight),
                    puppet.mesh.positions[v]);
                CHECK(error_of(puppet.moved.positions[v], exact) < 1e-5);
            }
        }
    }
}

TEST_CASE(
    "skin: a vertex between two joints is the mean of both joints' results"
    * technique("char.skin-defects")) {
    Puppet puppet = make_tube({1, 0, 0}, 70, 0.5f);
    puppet.linear();
    for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
        const Vec3 a = transform_point(puppet.palette[0], puppet.mesh.positions[v]);
        const Vec3 b = transform_point(puppet.palette[1], puppet.mesh.positions[v]);
        CHECK(glm::distance(puppet.moved.positions[v], 0.5f * (a + b)) < 1e-6f);
    }
}

TEST_CASE(
    "skin: matrices shrink a twisted joint by the cosine law, screw motions do not at all"
    * technique("char.skin-defects")) {
    // Twist angle a, weights 1 - w and w: r sqrt(1 - 2 w (1 - w) (1 - cos a)).
    for (const float angle : {30.0f, 60.0f, 90.0f, 120.0f, 150.0f, 180.0f}) {
        for (const float w : {0.5f, 0.75f}) {
            Puppet puppet = make_tube({0, 1, 0}, angle, w);
            const float law =
                std::sqrt(std::max(1 - 2 * w * (1 - w) * (1 - std::cos(radians(angle))), 0.0f));
            puppet.linear();
            for (const Vec3& p : puppet.moved.positions) {
                CHECK(std::abs(std::hypot(p.x, p.z) - law) < 2e-4f);
            }
            if (w == 0.5f) {
                CHECK(std::abs(law - std::cos(radians(angle / 2))) < 4e-4f);
            }
            puppet.dual();
            for (const Vec3& p : puppet.moved.positions) {
                CHECK(std::hypot(p.x, p.z) == test::near(1).epsilon(1e-5));
                CHECK(p.y == test::near(1).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE(
    "skin: where opposite rotations cancel a normal, the strongest joint rotates it"
    * technique("char.skin-cpu")) {
    Puppet puppet = make_tube({0, 1, 0}, 180, 0.5f);
    puppet.palette[1].row[0] = {-1, 0, 0, 0};  // half a turn to the last bit
    puppet.palette[1].row[2] = {0, 0, -1, 0};
    puppet.palette[0] = Affine{};
    puppet.linear();
    for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
        CHECK(std::isfinite(puppet.moved.positions[v].x));
        CHECK(puppet.moved.normals[v] == puppet.mesh.normals[v]);  // the first of two equal ones
        CHECK(glm::length(Vec3(puppet.moved.tangents[v])) == test::near(1));
    }
}

TEST_CASE("skin: scaled and mirrored joints keep normals perpendicular to the surface") {
    Puppet puppet = make_tube({0, 1, 0}, 0, 1);
    LocalPose pose = puppet.skeleton.rest;
    for (const Vec3 scale : {Vec3(3, 1, 0.5f), Vec3(-1, 1, 1)}) {
        pose.scales[1] = scale;
        puppet.pose(pose);
        puppet.linear();
        for (std::size_t v = 0; v < puppet.mesh.positions.size(); ++v) {
            // Along the ellipse the surface goes with the derivative of its points.
            const Vec3 rest = puppet.mesh.positions[v];
            const Vec3 along = scale * Vec3(-rest.z, 0, rest.x);
            CHECK(std::abs(glm::dot(along, puppet.moved.normals[v])) < 1e-5f);
            CHECK(glm::dot(puppet.moved.positions[v], puppet.moved.normals[v]) > 0);  // outward
        }
    }
}

TEST_CASE(
    "skin: SIMD and plain C++ are bit-identical, split anywhere" * technique("char.skin-cpu")) {
    for (const std::size_t count : {1, 15, 16, 17, 203}) {
        Puppet puppet = make_puppet(30, count, 5);
        puppet.pose(random_pose(puppet.skeleton, 3));
        MeshData plain = puppet.mesh;
        const SkinnedVertices target = {plain.positions, plain.normals, plain.tangents};
        puppet.linear();
        skin_linear_scalar(puppet.mesh.skin, puppet.palette, puppet.rest(), target, 0, count);
        CHECK(same_bits(plain.positions, puppet.moved.positions));
        CHECK(same_bits(plain.normals, puppet.moved.normals));
        CHECK(same_bits(plain.tangents, puppet.moved.tangents));
        puppet.dual();
        skin_dual_scalar(puppet.mesh.skin, puppet.duals, puppet.rest(), target, 0, count);
        CHECK(same_bits(plain.positions, puppet.moved.positions));
        CHECK(same_bits(plain.normals, puppet.moved.normals));
        const std::size_t split = count / 3;
        skin_dual(puppet.mesh.skin, puppet.duals, puppet.rest(), target, 0, split);
        skin_dual(puppet.mesh.skin, puppet.duals, puppet.rest(), target, split, count);
        CHECK(same_bits(plain.positions, puppet.moved.positions));
        CHECK(same_bits(plain.tangents, puppet.moved.tangents));
    }
}

TEST_CASE("skin: positions alone have the same bits as with normals and tangents") {
    for (const std::size_t count : {15, 203}) {
        Puppet puppet = make_puppet(30, count, 5);
        for (std::uint32_t v = 0; v < 10; ++v) {
            puppet.mesh.morphs.push_back({"", "", {v}, {Vec3(0.5f)}, {Vec3(1)}, {Vec3(2)}});
        }
        const std::vector<float> weights(10, 0.3f);
        puppet.pose(random_pose(puppet.skeleton, 3));
        std::vector<Vec3> alone = puppet.mesh.positions;
        add_morphs(puppet.mesh.morphs, weights, {alone, {}, {}});
        add_morphs(
            puppet.mesh.morphs, weights,
            {puppet.mesh.positions, puppet.mesh.normals, puppet.mesh.tangents});
        CHECK(same_bits(alone, puppet.mesh.positions));
        puppet.linear();
        skin_linear(puppet.mesh.skin, puppet.palette, {alone, {}, {}}, {alone, {}, {}}, 0, count);
        CHECK(same_bits(alone, puppet.moved.positions));
        alone = puppet.mesh.positions;
        puppet.dual();
        skin_dual(puppet.mesh.skin, puppet.duals, {alone, {}, {}}, {alone, {}, {}}, 0, count);
        CHECK(same_bits(alone, puppet.moved.positions));
    }
}

/// Vertices of `count` joints each. Each follows others than its neighbors; or `run` neighbors in a
/// row follow the same.
Puppet make_regular_puppet(std::size_t count, std::size_t run, std::size_t vertices) {
    Puppet puppet;
    puppet.skeleton = make_chain(24);
    Random random(13, 0, name_hash("regular"), 0);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::vector<std::pair<int, float>> by;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t joint = (v / run * 5 + 3 * i) % 24;
            by.emplace_back(static_cast<int>(joint), random.uniform(0.1f, 1));
        }
        add_vertex(puppet.mesh, random.direction(), by);
    }
    puppet.bind();
    puppet.pose(random_pose(puppet.skeleton, 3));
    return puppet;
}

/// By SIMD and scalar, with both blending methods.
void check_same_bits(Puppet& puppet) {
    MeshData plain = puppet.mesh;
    const std::size_t count = plain.positions.size();
    const SkinnedVertices target = {plain.positions, plain.normals, plain.tangents};
    puppet.linear();
    skin_linear_scalar(puppet.mesh.skin, puppet.palette, puppet.rest(), target, 0, count);
    CHECK(same_bits(plain.positions, puppet.moved.positions));
    CHECK(same_bits(plain.normals, puppet.moved.normals));
    CHECK(same_bits(plain.tangents, puppet.moved.tangents));
    puppet.dual();
    skin_dual_scalar(puppet.mesh.skin, puppet.duals, puppet.rest(), target, 0, count);
    CHECK(same_bits(plain.positions, puppet.moved.positions));
    CHECK(same_bits(plain.normals, puppet.moved.normals));
    CHECK(same_bits(plain.tangents, puppet.moved.tangents));
}

TEST_CASE("skin: batches with common joints, equally many or any joints have the bits of single "
          "vertices") {
    // Every kind of vectors that this machine has.
    const std::int64_t targets = hwy::SupportedTargets();
    for (std::int64_t left = targets; left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().DeInit();
        CAPTURE(std::string(hwy::TargetName(left & -left)));
        for (const std::size_t count : {1, 2, 3, 4, 5}) {
            CAPTURE(count);
            for (const std::size_t run : {1, 10, 1000}) {
                Puppet puppet = make_regular_puppet(count, run, 100);
                check_same_bits(puppet);
            }
        }
        Puppet any = make_puppet(24, 100, 6);
        any.mesh.normals[0] = Vec3(0);  // of a vertex without joints
        any.pose(random_pose(any.skeleton, 3));
        check_same_bits(any);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
}

TEST_CASE("skin: motions and normals that cancel within a batch are those of single vertices") {
    for (const std::size_t run : {1, 1000}) {
        Puppet puppet = make_regular_puppet(2, run, 64);
        for (std::size_t i = 0; i < 24; i += 2) {  // half a turn apart, and opposite
            puppet.palette[i] = Affine{};
            puppet.palette[i].row[0] = {-1, 0, 0, 0};
            puppet.palette[i].row[2] = {0, 0, -1, 0};
            puppet.duals[i].real = -puppet.duals[(i + 3) % 24].real;
        }
        puppet.palette[3] = Affine{};
        for (float& weight : puppet.mesh.skin.weights) {
            weight = 0.5f;
        }
        puppet.mesh.tangents[20] = Vec4(0, 0, 0, 1);
        puppet.mesh.normals[37] = Vec3(0);
        check_same_bits(puppet);
    }
}

TEST_CASE("skin: opposite motions give the first, however small its weight") {
    for (const std::size_t run : {1, 1000}) {
        Puppet puppet = make_regular_puppet(3, run, 64);
        for (std::size_t i = 0; i < 24; ++i) {
            puppet.duals[i] = {Quat(0, i % 2 == 0 ? 1.0f : -1.0f, 0, 0), Quat(0, 0, 0, 0)};
        }
        for (std::size_t v = 0; v < 64; ++v) {
            const std::size_t kind = run == 1 ? v % 3 : 0;
            const auto even = static_cast<std::uint16_t>(2 * kind);
            const auto odd = static_cast<std::uint16_t>(2 * kind + 1);
            const std::uint16_t joints[] = {6, even, odd};
            const float weights[] = {1e-7f, 0.5f, 0.5f};
            std::copy(std::begin(joints), std::end(joints), &puppet.mesh.skin.joints[3 * v]);
            std::copy(std::begin(weights), std::end(weights), &puppet.mesh.skin.weights[3 * v]);
        }
        puppet.duals[6] = {Quat(0.6f, 0, 0.8f, 0), Quat(0, 0, 0, 0)};
        check_same_bits(puppet);
        for (std::size_t v = 0; v < 64; ++v) {
            const Vec3 turned = puppet.duals[6].real * puppet.mesh.positions[v];
            CHECK(glm::distance(puppet.moved.positions[v], turned) < 1e-5f);
        }
    }
}

TEST_CASE(
    "skin: more than 256 joints and more than 256 morph targets work"
    * technique("char.skin-limits")) {
    Puppet puppet = make_puppet(300, 600, 4);
    std::vector<float> weights;
    for (std::uint32_t t = 0; t < 300; ++t) {
        puppet.mesh.morphs.push_back({"", "", {2 * t + 1}, {Vec3(0, 0, 2)}, {}, {}});
        weights.push_back(0.5f);
    }
    puppet.pose(random_pose(puppet.skeleton, 0.1f));
    MeshData shaped = puppet.mesh;
    add_morphs(puppet.mesh.morphs, weights, {shaped.positions, shaped.normals, shaped.tangents});
    std::swap(shaped.positions, puppet.mesh.positions);  // what is skinned is the shape
    puppet.linear();
    for (std::size_t v = 0; v < 600; ++v) {
        if (puppet.mesh.skin.first[v] == puppet.mesh.skin.first[v + 1]) {
            continue;
        }
        const bool moves = v % 2 == 1;
        CHECK(puppet.mesh.positions[v] == shaped.positions[v] + (moves ? Vec3(0, 0, 1) : Vec3(0)));
        const glm::dvec3 exact =
            oracle::skin_by_offsets(puppet.mesh, puppet.skin, puppet.joints, v);
        CHECK(error_of(puppet.moved.positions[v], exact) < 1e-5 * 300);
    }
}

TEST_CASE(
    "skin: morph targets are linear, add up in any order and do not move other vertices"
    * technique("char.morph-target")) {
    MeshData mesh;
    for (int i = 0; i < 6; ++i) {
        add_vertex(mesh, Vec3(0.1f * static_cast<float>(i), 1, 1), {{0, 1.0f}});
    }
    mesh.morphs.push_back({"a", "", {1, 3}, {{1, 0, 0}, {0, 2, 0}}, {{0, 1, 0}, {0, 0, 1}}, {}});
    mesh.morphs.push_back({"b", "", {3, 4}, {{0, 0, 4}, {1, 1, 1}}, {}, {{1, 0, 0}, {0, 1, 0}}});
    const auto shaped = [&](std::vector<float> weights) {
        MeshData copy = mesh;
        add_morphs(mesh.morphs, weights, {copy.positions, copy.normals, copy.tangents});
        return copy;
    };
    CHECK(same_bits(shaped({0, 0}).positions, mesh.positions));
    const MeshData one = shaped({1});
    CHECK(one.positions[1] == mesh.positions[1] + Vec3(1, 0, 0));
    CHECK(one.normals[3] == mesh.normals[3] + Vec3(0, 0, 1));
    for (const std::size_t v : {0, 2, 4, 5}) {
        CHECK(one.positions[v] == mesh.positions[v]);
    }
    const MeshData half = shaped({0.5f, -2});
    CHECK(glm::distance(half.positions[3], mesh.positions[3] + Vec3(0, 1, -8)) < 1e-6f);
    CHECK(half.tangents[4] == mesh.tangents[4] + Vec4(0, -2, 0, 0));
    std::swap(mesh.morphs[0], mesh.morphs[1]);
    CHECK(glm::distance(shaped({-2, 0.5f}).positions[3], half.positions[3]) < 1e-6f);
    CHECK(same_bits(shaped({0, 0, 9, 9}).positions, mesh.positions));  // no such targets
}

TEST_CASE(
    "skin: a shape that is morphed before skinning rotates with its joint"
    * technique("char.morph-target")) {
    Puppet puppet = make_tube({0, 1, 0}, 90, 1);
    puppet.mesh.morphs.push_back({"bump", "", {0}, {{1, 0, 0}}, {}, {}});
    add_morphs(
        puppet.mesh.morphs, std::vector<float>{1},
        {puppet.mesh.positions, puppet.mesh.normals, puppet.mesh.tangents});
    puppet.linear();
    CHECK(glm::distance(puppet.moved.positions[0], Vec3(0, 1, -2)) < 1e-5f);
}

TEST_CASE(
    "skin: a palette of three rows per joint equals 4x4 matrices in three quarters of the space"
    * technique("char.skin-limits")) {
    Puppet puppet = make_puppet(98, 200, 4);
    puppet.pose(random_pose(puppet.skeleton, 0.2f));
    CHECK(puppet.palette.size() * sizeof(Affine) == 4704);
    CHECK(puppet.palette.size() * sizeof(Mat4) == 6272);
    for (const Affine& rows : puppet.palette) {
        const Vec3 p(0.3f, 0.5f, -0.7f);
        const Vec3 by_matrix(to_mat4(rows) * Vec4(p, 1));
        CHECK(glm::distance(transform_point(rows, p), by_matrix) < 1e-6f * 98);
    }
}

TEST_CASE("skin: weights that sum to a half move a vertex halfway to the origin") {
    // Which is why what is loaded is scaled to a sum of 1.
    Puppet puppet = make_puppet(5, 60, 3);
    puppet.pose(random_pose(puppet.skeleton, 0.7f));
    puppet.linear();
    const MeshData whole = puppet.moved;
    for (float& weight : puppet.mesh.skin.weights) {
        weight *= 0.5f;
    }
    puppet.linear();
    for (std::size_t v = 0; v < whole.positions.size(); ++v) {
        if (puppet.mesh.skin.first[v] != puppet.mesh.skin.first[v + 1]) {
            CHECK(glm::distance(puppet.moved.positions[v], 0.5f * whole.positions[v]) < 1e-5f);
            CHECK(glm::distance(puppet.moved.normals[v], whole.normals[v]) < 1e-5f);
        }
    }
}

TEST_CASE(
    "skin: the largest influences are kept and sum to 1 again" * technique("char.skin-limits")) {
    SkinWeights skin;
    skin.first = {0, 4, 5};
    skin.joints = {1, 3, 5, 8, 2};
    skin.weights = {0.15f, 0.5f, 0.05f, 0.3f, 1};
    const SkinWeights two = limit_influences(skin, 2);
    CHECK(two.first == std::vector<std::uint32_t>{0, 2, 3});
    CHECK(two.joints == std::vector<std::uint16_t>{3, 8, 2});
    CHECK(two.weights[0] == test::near(0.625));
    CHECK(two.weights[1] == test::near(0.375));
    CHECK(limit_influences(skin, 1).weights == std::vector<float>{1, 1});
    const SkinWeights all = limit_influences(skin, 4);
    CHECK(all.joints == skin.joints);
    CHECK(
        all.weights[0] + all.weights[1] + all.weights[2] + all.weights[3]
        == test::near(1).epsilon(1e-6));
}

}  // namespace limn::skin_kernels_test

#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_chain.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/crowd_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <hwy/targets.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace limn::pose_chain_test {

using namespace limn::test;

namespace {

using Joints = std::vector<std::vector<Affine>>;

bool same_bits(const Joints& a, const Joints& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        same = a[i].size() == b[i].size();
        for (std::size_t j = 0; same && j < a[i].size(); ++j) {
            same = test::same_bits(a[i][j], b[i][j]);
        }
    }
    return same;
}

std::vector<Affine> make_binds(std::size_t count) {
    Random random(3, 0, name_hash("binds"), 0);
    std::vector<Affine> binds;
    for (std::size_t i = 0; i < count; ++i) {
        binds.push_back(affine_from(
            random.direction(), rotation_about(random.direction(), random.uniform(0.0f, 3.0f)),
            Vec3(1)));
    }
    return binds;
}

/// The joints of one character in double precision, from the words of its clips.
std::vector<glm::dmat4> exact_joints(const TestCrowd& crowd, const CrowdCharacter& character) {
    const std::size_t joints = crowd.rig.joints();
    struct Local {
        glm::dquat rotation;
        glm::dvec3 translation;
    };
    const auto sample = [joints](const CrowdClip& clip, float time) {
        std::vector<Local> pose(joints);
        const double at = static_cast<double>(time) * clip.rate;
        const auto first = std::min(static_cast<std::size_t>(at), clip.frames - 2);
        const double u = at - static_cast<double>(first);
        for (std::size_t j = 0; j < joints; ++j) {
            const float* const t = clip.translations.constants.data() + j;
            const std::size_t stride = pose_stride(joints);
            if (!clip.rotations.constants.empty()) {
                const float* const q = clip.rotations.constants.data() + j;
                pose[j].rotation = glm::dquat(q[3 * stride], q[0], q[stride], q[2 * stride]);
            }
            pose[j].translation = glm::dvec3(t[0], t[stride], t[2 * stride]);
        }
        for (const TrackRun& run : clip.rotations.runs) {
            const CrowdTracks& t = clip.rotations;
            for (std::size_t i = 0; i < run.count; ++i) {
                const std::size_t column = run.track + i;
                const auto packed = [&](std::size_t frame) {
                    const std::uint16_t* const w =
                        t.frames.data() + 3 * t.animated * frame + column;
                    return glm::normalize(
                        glm::dquat(unpack_rotation({w[0], w[t.animated], w[2 * t.animated]})));
                };
                pose[run.first + i].rotation =
                    glm::normalize((1 - u) * packed(first) + u * packed(first + 1));
            }
        }
        for (const TrackRun& run : clip.translations.runs) {
            const CrowdTracks& t = clip.translations;
            for (std::size_t i = 0; i < run.count; ++i) {
                for (int axis = 0; axis < 3; ++axis) {
                    const auto row = static_cast<std::size_t>(axis);
                    const std::size_t column = row * t.animated + run.track + i;
                    const auto value = [&](std::size_t frame) {
                        return static_cast<double>(t.ranges[column])
                               + static_cast<double>(t.ranges[3 * t.animated + column])
                                     * t.frames[3 * t.animated * frame + column];
                    };
                    pose[run.first + i].translation[axis] =
                        (1 - u) * value(first) + u * value(first + 1);
                }
            }
        }
        return pose;
    };
    std::vector<Local> pose = sample(*character.clip, character.time);
    if (character.next != nullptr) {
        const std::vector<Local> next = sample(*character.next, character.next_time);
        const double w = character.weight;
        for (std::size_t j = 0; j < joints; ++j) {
            const double sign = glm::dot(pose[j].rotation, next[j].rotation) < 0 ? -1 : 1;
            pose[j].rotation =
                glm::normalize((1 - w) * pose[j].rotation + sign * w * next[j].rotation);
            pose[j].translation = (1 - w) * pose[j].translation + w * next[j].translation;
        }
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t j = 0; j < joints; ++j) {
        glm::dmat4 local = glm::mat4_cast(pose[j].rotation);
        local[3] = glm::dvec4(pose[j].translation, 1);
        const std::int32_t parent = crowd.rig.parents[j];
        matrices.push_back(parent < 0 ? local : matrices[static_cast<std::size_t>(parent)] * local);
    }
    return matrices;
}

}  // namespace

TEST_CASE(
    "pose chain: lanes have the bits of plain C++, for any number of joints and characters"
    * technique("char.pose-eval, char.local-global")) {
    for (const std::size_t joints : {1, 4, 15, 16, 17, 67}) {
        for (const std::size_t count : {1, 2, 3, 4, 5, 8, 9, 15, 16, 17, 33}) {
            CAPTURE(joints);
            CAPTURE(count);
            TestCrowd crowd(joints, count);
            for (const std::vector<Affine>& binds : {std::vector<Affine>(), make_binds(joints)}) {
                pose_crowd_scalar(crowd.rig, crowd.characters, binds);
                const Joints scalar = crowd.joints;
                for (std::vector<Affine>& each : crowd.joints) {
                    each.assign(joints, Affine{{Vec4(9), Vec4(9), Vec4(9)}});
                }
                pose_crowd(crowd.rig, crowd.characters, binds);
                REQUIRE(same_bits(crowd.joints, scalar));
            }
        }
    }
}

TEST_CASE("pose chain: bits are the same with vectors of every instruction set") {
    TestCrowd crowd(37, 21);
    const std::vector<Affine> binds = make_binds(37);
    pose_crowd_scalar(crowd.rig, crowd.characters, binds);
    const Joints scalar = crowd.joints;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().DeInit();
        CAPTURE(pose_vector_floats());
        pose_crowd(crowd.rig, crowd.characters, binds);
        CHECK(same_bits(crowd.joints, scalar));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
}

TEST_CASE("pose chain: its steps have the bits of plain C++, and together those of the chain") {
    TestCrowd crowd(67, 20);
    pose_crowd(crowd.rig, crowd.characters);
    const Joints fused = crowd.joints;
    std::vector<PoseRows> rows(crowd.characters.size());
    std::vector<const PoseRows*> row_pointers;
    std::vector<Affine*> joint_pointers;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CrowdCharacter& character = crowd.characters[i];
        PoseRows scalar;
        PoseRows next;
        PoseRows next_scalar;
        sample_crowd_clip(*character.clip, character.time, rows[i]);
        sample_crowd_clip_scalar(*character.clip, character.time, scalar);
        if (character.next != nullptr) {
            sample_crowd_clip(*character.next, character.next_time, next);
            sample_crowd_clip_scalar(*character.next, character.next_time, next_scalar);
            blend_poses(rows[i], next, character.weight, rows[i]);
            blend_poses_scalar(scalar, next_scalar, character.weight, scalar);
        }
        for (std::size_t j = 0; j < 67; ++j) {
            REQUIRE(rows[i].rotation(j) == scalar.rotation(j));
            REQUIRE(rows[i].translation(j) == scalar.translation(j));
        }
        row_pointers.push_back(&rows[i]);
        crowd.joints[i].assign(67, Affine{});
        joint_pointers.push_back(crowd.joints[i].data());
    }
    compute_crowd_joints(crowd.rig, row_pointers, joint_pointers);
    CHECK(same_bits(crowd.joints, fused));
}

TEST_CASE("pose chain: matrices are those of double precision within 20 micrometers") {
    TestCrowd crowd(67, 40);
    pose_crowd(crowd.rig, crowd.characters);
    double worst = 0;
    for (std::size_t i = 0; i < crowd.characters.size(); ++i) {
        const std::vector<glm::dmat4> exact = exact_joints(crowd, crowd.characters[i]);
        for (std::size_t j = 0; j < exact.size(); ++j) {
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 4; ++column) {
                    worst = std::max(
                        worst, std::abs(
                                   exact[j][column][row]
                                   - static_cast<double>(crowd.joints[i][j].row[row][column])));
                }
            }
        }
    }
    CHECK(worst < 2e-5);  // times are rounded, which is 1e-5 of a frame
    CHECK(worst > 0);
}

TEST_CASE(
    "pose chain: without compression it multiplies like the joint matrices of any character"
    * technique("char.local-global")) {
    const SkeletonData skeleton = make_tree(67, 5);
    const CrowdRig rig = make_crowd_rig(skeleton);
    std::vector<Affine> expected(67);
    compute_joint_matrices(skeleton, skeleton.rest, expected);
    PoseRows rows;
    rows.resize(67);
    for (std::size_t j = 0; j < 67; ++j) {
        const Quat& q = skeleton.rest.rotations[j];
        const Vec3& t = skeleton.rest.translations[j];
        const float values[] = {q.x, q.y, q.z, q.w, t.x, t.y, t.z};
        for (std::size_t row = 0; row < PoseRows::kRows; ++row) {
            rows.values[row * rows.stride + j] = values[row];
        }
    }
    Joints joints(20, std::vector<Affine>(67));
    const std::vector<const PoseRows*> all(20, &rows);
    std::vector<Affine*> pointers;
    for (std::vector<Affine>& each : joints) {
        pointers.push_back(each.data());
    }
    compute_crowd_joints(rig, all, pointers);
    CHECK(same_bits(joints, Joints(20, expected)));
}

TEST_CASE("pose chain: neighbors in a group do not matter") {
    TestCrowd crowd(30, 50);
    pose_crowd(crowd.rig, crowd.characters);
    const Joints in_order = crowd.joints;
    std::vector<CrowdCharacter> shuffled;
    for (std::size_t i = 0; i < 50; ++i) {
        shuffled.push_back(crowd.characters[(i * 17 + 5) % 50]);
    }
    for (const std::size_t size : {50, 7, 1}) {
        for (std::vector<Affine>& each : crowd.joints) {
            each.assign(30, Affine{});
        }
        for (std::size_t begin = 0; begin < 50; begin += size) {
            pose_crowd(
                crowd.rig,
                std::span(shuffled).subspan(begin, std::min<std::size_t>(size, 50 - begin)));
        }
        CHECK(same_bits(crowd.joints, in_order));
    }
}

TEST_CASE("pose chain: blending ends at both poses and takes the shorter arc") {
    PoseRows a;
    PoseRows b;
    PoseRows mixed;
    for (PoseRows* rows : {&a, &b}) {
        rows->resize(16);
        std::fill(rows->values.begin(), rows->values.end(), 0.0f);
    }
    const Quat from = rotation_about({0, 0, 1}, 0.4f);
    const Quat to = -rotation_about({0, 0, 1}, 1.2f);
    for (std::size_t j = 0; j < 16; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
            const int component = static_cast<int>(i);
            a.values[i * a.stride + j] = from[component];
            b.values[i * b.stride + j] = to[component];
        }
        b.values[4 * b.stride + j] = 2;
    }
    blend_poses(a, b, 0, mixed);
    CHECK(glm::length(mixed.rotation(3) - from) < 1e-6f);
    blend_poses(a, b, 1, mixed);
    CHECK(glm::length(mixed.rotation(3) + to) < 1e-6f);
    blend_poses(a, b, 0.5f, mixed);
    CHECK(glm::length(mixed.rotation(3) - rotation_about({0, 0, 1}, 0.8f)) < 1e-6f);
    CHECK(mixed.translation(3) == Vec3(1, 0, 0));
}

TEST_CASE("pose chain: a rig keeps matrices until their last child, in few places") {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        const SkeletonData skeleton = make_tree(120, seed);
        const CrowdRig rig = make_crowd_rig(skeleton);
        std::vector<std::size_t> owner(rig.slot_count, 999);
        for (std::size_t j = 0; j < 120; ++j) {
            if (j > 0) {
                REQUIRE(owner[rig.parent_slots[j]] == static_cast<std::size_t>(rig.parents[j]));
            }
            if (rig.slots[j] != CrowdRig::kNoSlot) {
                owner[rig.slots[j]] = j;
            }
        }
        CHECK(rig.slot_count < 10);
    }
    CHECK(make_crowd_rig(make_chain(50)).slot_count == 1);
}

TEST_CASE("pose chain: scales at rest are kept") {
    SkeletonData skeleton = make_tree(30, 8);
    const ClipData source = make_motion(skeleton, 4);
    skeleton.rest.scales[0] = {2, 3, 0.5f};
    skeleton.rest.scales[17] = {1, 0.25f, 1};
    const auto clip = make_crowd_clip(skeleton, source, scale_limits(skeleton));
    REQUIRE(clip);
    const CrowdRig rig = make_crowd_rig(skeleton);
    Joints joints(16, std::vector<Affine>(30));
    std::vector<CrowdCharacter> characters;
    for (std::vector<Affine>& each : joints) {
        characters.push_back({.clip = &*clip, .time = 0.7f, .joints = each.data()});
    }
    pose_crowd(rig, characters);
    LocalPose pose = skeleton.rest;
    sample_clip(source, 0.7f, pose, {});
    std::vector<Affine> exact(30);
    compute_joint_matrices(skeleton, pose, exact);
    const CrowdClipLimits limits = scale_limits(skeleton);
    for (const std::vector<Affine>& each : joints) {
        CHECK(shell_error(each, exact, limits.shell) <= limits.tolerance);
    }
}

}  // namespace limn::pose_chain_test

#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/bvh_export.h"
#include "content/load/motion/bvh_motion.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/clip_sampling.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace limn::bvh_motion_test {

using test::near;

namespace {

/// The sample of Watt and Policarpo, closed, with a frame of zeros.
BvhFile make_sample() {
    using enum BvhChannel;
    const std::vector<BvhChannel> turns = {Zrotation, Xrotation, Yrotation};
    BvhFile bvh;
    std::size_t values = 0;
    const auto add = [&](const char* name, int parent, const Vec3& offset) {
        BvhJoint joint{name, parent, offset, *name == 0, values, {}};
        joint.channels = joint.is_end ? std::vector<BvhChannel>{} : turns;
        if (parent < 0) {
            joint.channels = {Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation};
        }
        values += joint.channels.size();
        bvh.joints.push_back(joint);
    };
    add("Hips", -1, {0, 0, 0});
    add("LeftHip", 0, {3.43f, 0, 0});
    add("LeftKnee", 1, {0, -18.469999f, 0});
    add("LeftAnkle", 2, {0, -17.950001f, 0});
    add("", 3, {0, -3.119996f, 0});
    add("RightHip", 0, {-3.43f, 0, 0});
    add("RightKnee", 5, {0, -18.809999f, 0});
    add("RightAnkle", 6, {0, -17.57f, 0});
    add("", 7, {0, -3.25f, 0});
    bvh.frames = 1;
    bvh.values.assign(values, 0.0f);
    return bvh;
}

constexpr BvhImport kAsIs = {.scale = 1, .up = BvhUp::Y};
constexpr std::size_t kLeftHip = 1;
constexpr std::size_t kLeftKnee = 2;

std::size_t value_of(const BvhFile& bvh, std::size_t joint, BvhChannel channel) {
    const auto& channels = bvh.joints[joint].channels;
    return bvh.joints[joint].first_value
           + static_cast<std::size_t>(
               std::find(channels.begin(), channels.end(), channel) - channels.begin());
}

SkeletonMotion motion_of(const BvhFile& bvh, const BvhImport& options = kAsIs) {
    const Result<SkeletonMotion> motion = make_bvh_motion(bvh, "sample", options);
    REQUIRE_MESSAGE(motion.ok(), (motion ? "" : motion.error().message));
    return *motion;
}

/// Positions of all joints at `time`, by the pose system's own functions.
std::vector<Vec3> positions_at(const SkeletonMotion& motion, float time) {
    LocalPose pose = motion.skeleton.rest;
    sample_clip(motion.clip, time, pose, {});
    std::vector<Affine> matrices(pose.size());
    compute_joint_matrices(motion.skeleton, pose, matrices);
    std::vector<Vec3> positions;
    for (const Affine& matrix : matrices) {
        positions.push_back(transform_point(matrix, Vec3(0)));
    }
    return positions;
}

void check_near(const Vec3& found, const Vec3& expected, double tolerance) {
    CAPTURE(found.x);
    CAPTURE(found.y);
    CAPTURE(found.z);
    CHECK(static_cast<double>(glm::distance(found, expected)) <= tolerance);
}

/// Positions of a frame of the file by matrices in double precision, as the format says.
std::vector<glm::dvec3> oracle_positions(const BvhFile& bvh, std::size_t frame) {
    std::vector<glm::dmat4> matrices;
    std::vector<glm::dvec3> positions;
    for (const BvhJoint& joint : bvh.joints) {
        glm::dmat4 local(1);
        local[3] = glm::dvec4(glm::dvec3(joint.offset), 1);
        for (std::size_t c = 0; c < joint.channels.size(); ++c) {
            const double value =
                static_cast<double>(bvh.values[frame * bvh.channels() + joint.first_value + c]);
            const int axis = axis_of(joint.channels[c]);
            glm::dmat4 step(1);
            if (is_position(joint.channels[c])) {
                step[3][axis] = value;
            } else {
                const double angle = glm::radians(value);
                const int i = (axis + 1) % 3;
                const int k = (axis + 2) % 3;
                step[i][i] = step[k][k] = std::cos(angle);
                step[i][k] = std::sin(angle);
                step[k][i] = -std::sin(angle);
            }
            local = local * step;
        }
        matrices.push_back(
            joint.parent < 0 ? local : matrices[static_cast<std::size_t>(joint.parent)] * local);
        positions.emplace_back(matrices.back()[3]);
    }
    return positions;
}

/// The sample turning at random, 40 frames.
BvhFile make_dance(std::uint64_t seed) {
    Random random(seed, 4, 5, 6);
    BvhFile bvh = make_sample();
    bvh.frames = 40;
    bvh.frame_time = 0.025f;
    bvh.values.clear();
    for (std::size_t i = 0; i < bvh.frames * bvh.channels(); ++i) {
        bvh.values.push_back(
            i % bvh.channels() < 3 ? 20 * random.uniform() : 360 * (random.uniform() - 0.5f));
    }
    return bvh;
}

}  // namespace

TEST_CASE(
    "BVH motion: the sample has seven joints, two end sites and the printed leg lengths"
    * technique("char.bvh-format, char.skeleton-hierarchy")) {
    const BvhFile bvh = make_sample();
    const SkeletonMotion motion = motion_of(bvh);
    CHECK(bvh.channels() == 24);
    CHECK(motion.skeleton.joints.size() == 9);
    CHECK(
        std::count_if(
            bvh.joints.begin(), bvh.joints.end(),
            [](const BvhJoint& joint) { return joint.is_end; })
        == 2);
    CHECK(motion.skeleton.joints[4] == "LeftAnkle_end");
    const std::vector<Vec3> positions = positions_at(motion, 0);
    check_near(positions[4], {3.43f, -39.539996f, 0}, 1e-5);
    check_near(positions[8], {-3.43f, -39.629999f, 0}, 1e-5);
}

TEST_CASE(
    "BVH motion: hip and knee of the sample turn as in the book"
    * technique("char.bvh-format, char.local-global")) {
    BvhFile bvh = make_sample();
    bvh.values[value_of(bvh, kLeftHip, BvhChannel::Xrotation)] = 30;
    bvh.values[value_of(bvh, kLeftKnee, BvhChannel::Xrotation)] = -60;
    const std::vector<Vec3> positions = positions_at(motion_of(bvh), 0);
    check_near(positions[2], {3.43f, -15.995488f, -9.234999f}, 1e-5);
    check_near(positions[3], {3.43f, -31.540645f, -0.259999f}, 1e-5);
    check_near(positions[4], {3.43f, -34.242641f, 1.299999f}, 1e-5);
}

TEST_CASE(
    "BVH motion: channels multiply in the file's order, the first outermost"
    * technique("char.bvh-format, char.local-global")) {
    BvhFile bvh = make_sample();
    bvh.values[value_of(bvh, 0, BvhChannel::Zrotation)] = 90;
    bvh.values[value_of(bvh, 0, BvhChannel::Xrotation)] = 90;
    const Quat turn = motion_of(bvh).clip.sheets[0].rotations[0];
    check_near(turn * Vec3(0, 1, 0), {0, 0, 1}, 1e-6);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        BvhFile dance = make_dance(seed);
        std::reverse(dance.joints[2].channels.begin(), dance.joints[2].channels.end());
        const SkeletonMotion motion = motion_of(dance);
        for (const std::size_t frame : {0, 7, 39}) {
            const std::vector<glm::dvec3> expected = oracle_positions(dance, frame);
            const std::vector<Vec3> found =
                positions_at(motion, motion.clip.sheets[0].times[frame]);
            for (std::size_t j = 0; j < expected.size(); ++j) {
                check_near(found[j], Vec3(expected[j]), 2e-5 * 40);
            }
        }
    }
}

TEST_CASE(
    "skeleton: a joint moves its descendants only, and no bone changes its length"
    * technique("char.skeleton-hierarchy")) {
    const SkeletonMotion motion = motion_of(make_sample());
    const SkeletonData& skeleton = motion.skeleton;
    int roots = 0;
    for (std::size_t j = 0; j < skeleton.parents.size(); ++j) {
        CHECK(skeleton.parents[j] < static_cast<std::int32_t>(j));
        roots += skeleton.parents[j] < 0 ? 1 : 0;
    }
    CHECK(roots == 1);
    std::vector<Affine> rest(skeleton.parents.size());
    compute_joint_matrices(skeleton, skeleton.rest, rest);
    for (std::size_t moved = 0; moved < skeleton.parents.size(); ++moved) {
        LocalPose pose = skeleton.rest;
        pose.rotations[moved] = rotation_about({1, 2, 3}, 1.0f);
        std::vector<Affine> matrices(skeleton.parents.size());
        compute_joint_matrices(skeleton, pose, matrices);
        for (std::size_t j = 0; j < skeleton.parents.size(); ++j) {
            bool is_below = false;
            for (auto a = static_cast<std::int32_t>(j); a >= 0;
                 a = skeleton.parents[static_cast<std::size_t>(a)]) {
                is_below = is_below || a == static_cast<std::int32_t>(moved);
            }
            CHECK((to_mat4(matrices[j]) != to_mat4(rest[j])) == is_below);
            if (j > 0) {
                const auto p = static_cast<std::size_t>(skeleton.parents[j]);
                const float length = glm::distance(
                    transform_point(matrices[j], Vec3(0)), transform_point(matrices[p], Vec3(0)));
                CHECK(length == near(glm::length(skeleton.rest.translations[j])).scale(1));
            }
        }
    }
}

TEST_CASE("BVH motion: z up becomes y up, facing forward" * technique("char.bvh-format")) {
    BvhFile bvh = make_dance(3);
    const SkeletonMotion upright = motion_of(bvh);
    // The same file with z up: (x, y, z) is (x, -z, y), and angles likewise.
    BvhFile lying = bvh;
    for (BvhJoint& joint : lying.joints) {
        joint.offset = {joint.offset.x, -joint.offset.z, joint.offset.y};
        for (BvhChannel& channel : joint.channels) {
            const int first = is_position(channel) ? 0 : 3;
            const std::array<int, 3> axes = {0, 2, 1};
            channel =
                static_cast<BvhChannel>(first + axes[static_cast<std::size_t>(axis_of(channel))]);
        }
    }
    for (std::size_t i = 0; i < lying.values.size(); ++i) {
        for (const BvhJoint& joint : bvh.joints) {
            const std::size_t c = i % bvh.channels() - joint.first_value;
            if (c < joint.channels.size() && axis_of(joint.channels[c]) == 2) {
                lying.values[i] = -lying.values[i];
            }
        }
    }
    for (const BvhUp up : {BvhUp::Z, BvhUp::Auto}) {
        const SkeletonMotion turned = motion_of(lying, {.scale = 1, .up = up});
        for (const float time : {0.0f, 0.5f}) {
            const std::vector<Vec3> expected = positions_at(upright, time);
            const std::vector<Vec3> found = positions_at(turned, time);
            for (std::size_t j = 0; j < expected.size(); ++j) {
                check_near(found[j], expected[j], 1e-4);
            }
        }
    }
}

TEST_CASE(
    "BVH motion: the unit is the one in which a person has the height of one"
    * technique("char.bvh-format")) {
    CHECK(guess_unit(1.7f) == 1.0f);
    CHECK(guess_unit(17) == 0.1f);
    CHECK(guess_unit(165) == 0.01f);
    CHECK(guess_unit(1700) == 0.001f);
    CHECK(guess_unit(66) == 0.0254f);
    CHECK(guess_unit(0) == 1.0f);
    CHECK(guess_unit(NAN) == 1.0f);
    const auto path = test::shared_asset("makehuman/bvh/walk1.bvh");
    if (path) {
        const SkeletonMotion walk = *load_bvh_motion(*path);
        const std::vector<Vec3> positions = positions_at({walk.skeleton, {}}, 0);
        const BodyJoints body = find_body_joints(walk.skeleton);
        const Vec3 head = positions[body[BodyPart::Head]];
        CHECK(head.y - positions[body[BodyPart::LeftFoot]].y == near(1.441).epsilon(1e-3));
        // The left is at +x of a person who faces +z.
        CHECK(
            positions[body[BodyPart::LeftUpperArm]].x > positions[body[BodyPart::RightUpperArm]].x);
        CHECK(positions[body[BodyPart::LeftToes]].z > positions[body[BodyPart::LeftFoot]].z);
    }
}

TEST_CASE(
    "BVH motion: positions are added to the offset, or replace one that they are near"
    * technique("char.bvh-format")) {
    BvhFile bvh = make_sample();
    const auto root_at = [&](const Vec3& offset, const Vec3& channels, BvhPositions positions) {
        bvh.joints[0].offset = offset;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bvh.values[axis] = channels[static_cast<int>(axis)];
        }
        BvhImport options = kAsIs;
        options.positions = positions;
        return positions_at(motion_of(bvh, options), 0)[0];
    };
    using enum BvhPositions;
    CHECK(root_at({1, 2, 3}, {4, 5, 6}, Auto) == Vec3(5, 7, 9));
    CHECK(root_at({0, 0, 0}, {4, 5, 6}, Auto) == Vec3(4, 5, 6));
    CHECK(root_at({0, 90, 0}, {200, 92, 50}, Auto) == Vec3(200, 92, 50));
    CHECK(root_at({0, 90, 0}, {200, 2, 50}, Auto) == Vec3(200, 92, 50));
    CHECK(root_at({0, 90, 0}, {200, 92, 50}, Add) == Vec3(200, 182, 50));
    CHECK(root_at({1, 2, 3}, {4, 5, 6}, Replace) == Vec3(4, 5, 6));
}

TEST_CASE(
    "motion rate: 30 Hz keys at 100 frames per second are met exactly, with 100 poses a second"
    * technique("char.mocap-rate")) {
    BvhFile bvh = make_dance(8);
    bvh.frame_time = 1.0f / 30;
    const SkeletonMotion motion = motion_of(bvh);
    const ClipSheet& keys = motion.clip.sheets[0];
    for (std::size_t f = 0; f < bvh.frames; ++f) {
        LocalPose pose = motion.skeleton.rest;
        sample_clip(motion.clip, keys.times[f], pose, {});
        for (std::size_t i = 0; i < keys.rotating.size(); ++i) {
            const Quat& key = keys.rotations[f * keys.rotating.size() + i];
            CHECK(std::abs(glm::dot(pose.rotations[keys.rotating[i]], key)) >= 1 - 1e-6f);
        }
    }
    const MotionFrames frames = sample_frames(motion, 100);
    std::set<std::array<float, 4>> distinct;
    for (std::size_t f = 0; f < 100; ++f) {
        const Quat& q = frames.rotations[f * frames.joints + kLeftHip];
        distinct.insert({q.x, q.y, q.z, q.w});
    }
    CHECK(distinct.size() == 100);
    const SkeletonMotion fast = motion_of(bvh, {.scale = 1, .up = BvhUp::Y, .rate = 100});
    CHECK(fast.clip.sheets[0].times.size() == 131);
    CHECK(fast.clip.sheets[0].times[50] == 0.5f);
}

TEST_CASE(
    "motion rate: from 179 to -179 degrees a joint turns by 2 degrees"
    * technique("char.mocap-rate")) {
    BvhFile bvh = make_sample();
    bvh.frames = 2;
    bvh.values.resize(48, 0.0f);
    const std::size_t turn = value_of(bvh, kLeftHip, BvhChannel::Yrotation);
    bvh.values[turn] = 179;
    bvh.values[24 + turn] = -179;
    const SkeletonMotion motion = motion_of(bvh);
    const MotionFrames frames = sample_frames(motion, 10 / bvh.frame_time);
    REQUIRE(frames.frames() == 11);
    const Quat first = frames.rotations[kLeftHip];
    for (std::size_t f = 0; f < 11; ++f) {
        const Quat& q = frames.rotations[f * frames.joints + kLeftHip];
        const float turned =
            degrees(axis_angle(to_same_hemisphere(first, q) * glm::conjugate(first)).angle);
        CHECK(turned == near(0.2 * static_cast<double>(f)).epsilon(1e-3).scale(0.5));
    }
}

TEST_CASE(
    "motion frames: they are the poses that the pose system samples"
    * technique("char.mocap-rate")) {
    BvhFile bvh = make_dance(9);
    SkeletonMotion motion = motion_of(bvh);
    for (const Interpolation kind :
         {Interpolation::Linear, Interpolation::Step, Interpolation::Cubic}) {
        ClipSheet& sheet = motion.clip.sheets[0];
        sheet.interpolation = kind;
        if (kind == Interpolation::Cubic) {  // three rows per key
            sheet.times.resize(sheet.times.size() / 3);
            sheet.rotations.resize(3 * sheet.times.size() * sheet.rotating.size());
            sheet.translations.resize(3 * sheet.times.size() * sheet.translating.size());
        }
        for (const float time : {-1.0f, 0.0f, 0.01f, 0.1234f, 0.25f, 0.9f, 100.0f}) {
            LocalPose expected = motion.skeleton.rest;
            sample_clip(motion.clip, time, expected, {});
            const LocalPose found = sample_motion(motion.skeleton, motion.clip, time);
            for (std::size_t j = 0; j < found.size(); ++j) {
                check_near(found.translations[j], expected.translations[j], 1e-4);
                CHECK(std::abs(glm::dot(found.rotations[j], expected.rotations[j])) > 1 - 2e-6f);
            }
        }
    }
}

TEST_CASE(
    "BVH motion: keys are unit quaternions in the hemisphere of the previous key"
    * technique("char.mocap-rate")) {
    const SkeletonMotion motion = motion_of(make_dance(5));
    const ClipSheet& sheet = motion.clip.sheets[0];
    const std::size_t width = sheet.rotating.size();
    for (std::size_t i = 0; i < sheet.rotations.size(); ++i) {
        CHECK(glm::length(sheet.rotations[i]) == near(1).epsilon(1e-6));
        CHECK((i < width || glm::dot(sheet.rotations[i], sheet.rotations[i - width]) >= 0));
    }
}

TEST_CASE(
    "BVH export: joints are where they were, also with rotations at rest"
    * technique("char.bvh-format")) {
    Random random(1, 2, 3, 4);
    SkeletonMotion motion = motion_of(make_dance(2), {.scale = 0.02f, .up = BvhUp::Y});
    for (std::size_t j = 1; j < motion.skeleton.joints.size(); ++j) {
        motion.skeleton.rest.rotations[j] =
            rotation_about(random.direction(), 2 * random.uniform());
    }
    const SkeletonMotion posed = motion;
    const BvhFile file = make_bvh_file(posed, 40);
    CHECK(file.joints[4].is_end);
    CHECK(file.frames == 40);
    const SkeletonMotion again =
        motion_of(file, {.scale = 0.01f, .up = BvhUp::Y, .positions = BvhPositions::Replace});
    for (const float time : {0.0f, 0.3f, 0.975f}) {
        const std::vector<Vec3> expected = positions_at(posed, time);
        const std::vector<Vec3> found = positions_at(again, time);
        for (std::size_t j = 0; j < expected.size(); ++j) {
            check_near(found[j], expected[j], 2e-5);
        }
    }
    for (const Quat& q : again.skeleton.rest.rotations) {
        CHECK(q == Quat(1, 0, 0, 0));
    }
}

TEST_CASE(
    "BVH import: a .glb has the skeleton, the clip and a figure of bones"
    * technique("char.bvh-format")) {
    SkeletonMotion motion = motion_of(make_dance(6), {.scale = 0.025f, .up = BvhUp::Y});
    motion.clip.contacts = {{3, 0.1f, 0.25f}, {7, 0.3f, 0.5f}};
    motion.clip.events = {{"step", 0.1f}};
    const GltfScene scene = make_motion_scene("dance", motion);
    const Result<std::vector<std::byte>> bytes = write_glb(scene);
    REQUIRE_MESSAGE(bytes.ok(), (bytes ? "" : bytes.error().message));
    const Result<GltfScene> read = parse_gltf(*bytes, "dance.glb", "");
    REQUIRE_MESSAGE(read.ok(), (read ? "" : read.error().message));
    CHECK(read->warnings.empty());
    CHECK(read->skeleton.joints == scene.skeleton.joints);
    CHECK(find_node_matrices(*read)[0].row[1].w == motion.clip.sheets[0].translations[0].y);
    CHECK(read->skeleton.parents == scene.skeleton.parents);
    CHECK(read->meshes.size() == scene.meshes.size());
    CHECK(read->meshes.size() >= 2);
    REQUIRE(read->clips.size() == 1);
    const ClipData& clip = read->clips[0];
    REQUIRE(clip.contacts.size() == 2);
    CHECK(clip.contacts[0].joint == 4);
    CHECK(clip.contacts[0].begin == 0.1f);
    CHECK(clip.contacts[0].end == 0.25f);
    CHECK(read->skeleton.joints[clip.contacts[1].joint] == "RightAnkle");
    REQUIRE(clip.events.size() == 1);
    CHECK(clip.events[0].name == "step");
    for (const float time : {0.0f, 0.11f, 0.9f}) {
        const std::vector<Vec3> expected = positions_at(motion, time);
        const std::vector<Vec3> found = positions_at({read->skeleton, clip}, time);
        for (std::size_t j = 0; j < expected.size(); ++j) {
            check_near(found[j + 1], expected[j], 1e-6);
        }
    }
}

TEST_CASE(
    "BVH motion: more poses than fit into memory are refused" * technique("char.mocap-rate")) {
    BvhFile bvh = make_dance(1);
    bvh.frame_time = 1e5f;
    const Result<SkeletonMotion> motion = make_bvh_motion(bvh, "slow", {.rate = 60});
    REQUIRE(!motion.ok());
    CHECK(
        motion.error().message
        == "found 3900000 s at 60 poses per second of 9 joints, expected at most 100000000 joints "
           "in "
           "all poses");
    CHECK(make_bvh_motion(bvh, "slow", {.rate = 1e-3f}).ok());
}

TEST_CASE("glTF marks: a bad contact is left out with a warning") {
    SkeletonMotion motion = motion_of(make_dance(6));
    motion.clip.contacts = {{3, 0.1f, 0.25f}};
    GltfScene scene = make_motion_scene("dance", motion);
    std::string text;
    {
        const std::vector<std::byte> bytes = *write_glb(scene);
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    const std::size_t at = text.find("\"LeftAnkle\"", text.find("contacts"));
    REQUIRE(at != std::string::npos);
    text.replace(at, 11, "\"LeftAnkel\"");
    const auto read = parse_gltf(std::as_bytes(std::span(text)), "dance.glb", "");
    REQUIRE(read.ok());
    CHECK(read->clips[0].contacts.empty());
    REQUIRE(read->warnings.size() == 1);
    CHECK(
        read->warnings[0]
        == "dance.glb: animations[0].extras.limn.contacts[0].joint: found the string "
           "\"LeftAnkel\", expected the name of a joint (did you mean LeftAnkle?); it is left out");
}

}  // namespace limn::bvh_motion_test

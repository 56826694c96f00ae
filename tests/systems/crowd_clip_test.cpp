#include "systems/animation/clip_sampling.h"
#include "systems/animation/crowd_clip.h"
#include "systems/animation/pose_chain.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/crowd_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace limn::crowd_clip_test {

using namespace limn::test;

namespace {

/// Joint matrices by double precision, from the keys of a clip at the time of one of them.
std::vector<glm::dmat4>
exact_matrices(const SkeletonData& skeleton, const ClipData& clip, std::size_t key) {
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> translations;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        rotations.emplace_back(skeleton.rest.rotations[j]);
        translations.emplace_back(skeleton.rest.translations[j]);
    }
    const ClipSheet& sheet = clip.sheets[0];
    for (std::size_t i = 0; i < sheet.rotating.size(); ++i) {
        rotations[sheet.rotating[i]] = glm::dquat(sheet.rotations[key * sheet.rotating.size() + i]);
    }
    for (std::size_t i = 0; i < sheet.translating.size(); ++i) {
        translations[sheet.translating[i]] =
            glm::dvec3(sheet.translations[key * sheet.translating.size() + i]);
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        glm::dmat4 local = glm::mat4_cast(glm::normalize(rotations[j]));
        local[3] = glm::dvec4(translations[j], 1);
        const std::int32_t parent = skeleton.parents[j];
        matrices.push_back(parent < 0 ? local : matrices[static_cast<std::size_t>(parent)] * local);
    }
    return matrices;
}

double farthest(const Affine& a, const glm::dmat4& b, double shell) {
    double worst = 0;
    for (int i = 0; i < 6; ++i) {
        glm::dvec4 point(0, 0, 0, 1);
        point[i / 2] = i % 2 == 0 ? shell : -shell;
        const glm::dvec3 moved(b * point);
        const glm::dvec3 ours(transform_point(a, Vec3(point)));
        worst = std::max(worst, glm::length(ours - moved));
    }
    return worst;
}

double length_of(const PoseRows& rows, std::size_t joint) {
    return glm::length(glm::dquat(rows.rotation(joint)));
}

}  // namespace

TEST_CASE("crowd clip: 48 bits keep a rotation within 0.15 milliradians, and its sign") {
    Random random(1, 0, name_hash("packed rotations"), 0);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        Quat q = rotation_about(random.direction(), random.uniform(0.0f, 2.0f * kPi));
        if (i % 2 == 0) {
            q = -q;
        }
        const glm::dquat unpacked = glm::normalize(glm::dquat(unpack_rotation(pack_rotation(q))));
        const glm::dquat exact = glm::normalize(glm::dquat(q));
        // Also the sign: neighbors in the same hemisphere remain so.
        REQUIRE(glm::dot(unpacked, exact) > 0);
        worst = std::max(worst, 2.0 * glm::length(unpacked - exact));
    }
    // A component is off by half a step, the largest one by three times that at most.
    CHECK(worst < 2 * std::sqrt(12.0) / (std::sqrt(2.0) * kPackedMax));
    for (const Quat& q :
         {Quat(1, 0, 0, 0), Quat(0, -1, 0, 0), Quat(0, 0, 1, 0), Quat(0, 0, 0, -1)}) {
        const Quat unpacked = unpack_rotation(pack_rotation(q));
        CHECK(glm::length(glm::normalize(unpacked) - q) < 1e-4f);
    }
}

TEST_CASE(
    "crowd clip: errors down the hierarchy are below a millimeter, as measured in double"
    * technique("char.clip-layout")) {
    const SkeletonData skeleton = make_tree(67, 67);
    const ClipData clip = make_motion(skeleton, 1, true);
    const CrowdClipLimits limits;
    const auto packed = make_crowd_clip(skeleton, clip, limits);
    REQUIRE(packed);
    CHECK(packed->error <= limits.tolerance);
    CHECK(packed->error > 1e-6f);
    const CrowdRig rig = make_crowd_rig(skeleton);
    PoseRows rows;
    std::vector<Affine> joints(skeleton.joints.size());
    double worst = 0;
    for (std::size_t key = 0; key < clip.sheets[0].times.size(); ++key) {
        const std::vector<glm::dmat4> exact = exact_matrices(skeleton, clip, key);
        sample_crowd_clip(*packed, clip.sheets[0].times[key], rows);
        compute_crowd_joints(rig, rows, joints);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            worst = std::max(worst, farthest(joints[j], exact[j], limits.shell));
        }
    }
    CHECK(worst <= limits.tolerance);
    CHECK(worst <= packed->error + 1e-6);  // which was measured at keys and between frames
}

TEST_CASE("crowd clip: a sixth of the size of floats, and less with joints at rest") {
    const SkeletonData skeleton = make_tree(67, 67);
    ClipData clip = make_motion(skeleton, 1, true);
    const auto floats = [](const ClipData& c) {
        return static_cast<double>(c.sheets[0].times.size() * 67 * 10 * sizeof(float));
    };
    const auto packed = make_crowd_clip(skeleton, clip, {});
    REQUIRE(packed);
    CHECK(floats(clip) / static_cast<double>(crowd_clip_bytes(*packed)) > 6.0);
    // Nothing but the root moves.
    ClipSheet& sheet = clip.sheets[0];
    sheet.rotating.clear();
    sheet.rotations.clear();
    const auto still = make_crowd_clip(skeleton, clip, {});
    REQUIRE(still);
    CHECK(still->rotations.animated == 0);
    CHECK(floats(clip) / static_cast<double>(crowd_clip_bytes(*still)) > 60.0);
}

TEST_CASE("crowd clip: slow motion needs fewer frames than it has keys") {
    const SkeletonData skeleton = make_chain(4);
    std::vector<float> times;
    std::vector<float> angles;
    for (int i = 0; i <= 240; ++i) {
        times.push_back(static_cast<float>(i) / 120.0f);
        angles.push_back(30.0f * std::sin(kPi * times.back()));
    }
    const auto slow = make_crowd_clip(skeleton, make_turn(times, angles, 1), {});
    REQUIRE(slow);
    CHECK(slow->frames < 100);
    CHECK(slow->error <= 1e-3f);
    const auto strict = make_crowd_clip(skeleton, make_turn(times, angles, 1), {3e-4f, 0.1f});
    REQUIRE(strict);
    CHECK(strict->frames > slow->frames);
    // Three quarter turns between two keys each need frames of their own.
    const auto few_keys =
        make_crowd_clip(skeleton, make_turn({0, 1, 2, 3}, {0, 90, 180, 270}, 1), {});
    REQUIRE(few_keys);
    CHECK(few_keys->frames > 4);
}

TEST_CASE("crowd clip: at a frame the pose is the frame, and every rotation is unit") {
    const TestCrowd crowd(40, 0);
    const CrowdClip& clip = crowd.clips[0];
    PoseRows rows;
    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        sample_crowd_clip(clip, static_cast<float>(frame) / clip.rate, rows);
        for (const TrackRun& run : clip.rotations.runs) {
            for (std::size_t i = 0; i < run.count; ++i) {
                const std::size_t width = clip.rotations.animated;
                const std::uint16_t* const words =
                    clip.rotations.frames.data() + 3 * width * frame + run.track + i;
                const glm::dquat exact = glm::normalize(
                    glm::dquat(unpack_rotation({words[0], words[width], words[2 * width]})));
                const glm::dquat ours(rows.rotation(run.first + i));
                REQUIRE(glm::length(ours - exact) < 2e-5);  // the time is rounded
            }
        }
    }
    for (int i = 0; i <= 1000; ++i) {
        sample_crowd_clip(clip, clip.duration * static_cast<float>(i) / 1000.0f, rows);
        for (std::size_t j = 0; j < clip.joints; ++j) {
            REQUIRE(length_of(rows, j) == near(1).epsilon(1e-6));
        }
    }
}

TEST_CASE("crowd clip: between frames that are far apart rotations are unit, too") {
    // 48 degrees from frame to frame: the cosine of half of that is 0.914.
    const SkeletonData skeleton = make_chain(2);
    const ClipData turn = make_turn({0, 1, 2, 3}, {0, 48, 96, 144}, 1);
    const auto clip = make_crowd_clip(skeleton, turn, {1, 0.1f});
    REQUIRE(clip);
    REQUIRE(clip->frames == 4);
    PoseRows rows;
    for (int i = 0; i <= 300; ++i) {
        sample_crowd_clip(*clip, 0.01f * static_cast<float>(i), rows);
        REQUIRE(length_of(rows, 1) == near(1).epsilon(1e-6));
    }
    // Steps that are larger get more frames, whatever the tolerance.
    const ClipData faster = make_turn({0, 1, 2, 3}, {0, 60, 120, 180}, 1);
    const auto dense = make_crowd_clip(skeleton, faster, {1, 0.1f});
    REQUIRE(dense);
    CHECK(dense->frames > 4);
}

TEST_CASE("crowd clip: joints that do not move are stored once, but for a few between others") {
    const SkeletonData skeleton = make_chain(40);
    const auto animated = [&skeleton](const std::vector<std::uint16_t>& joints) {
        ClipData clip = make_turn({0, 0.5f, 1}, {0, 10, 0}, 0);
        ClipSheet sheet = clip.sheets[0];
        clip.sheets.clear();
        for (const std::uint16_t joint : joints) {
            sheet.rotating = {joint};
            clip.sheets.push_back(sheet);
        }
        const auto packed = make_crowd_clip(skeleton, clip, {1, 0.1f});
        return packed ? packed->rotations.animated : 99;
    };
    CHECK(animated({5}) == 1);
    CHECK(animated({2, 5}) == 4);
    CHECK(animated({2, 12}) == 2);
    CHECK(animated({15, 16}) == 2);
    CHECK(animated({2, 12, 30, 31, 32}) == 5);
}

TEST_CASE("crowd clip: times in any order give the bits of times in order") {
    const TestCrowd crowd(40, 0);
    std::vector<PoseRows> forward(100);
    for (std::size_t i = 0; i < forward.size(); ++i) {
        sample_crowd_clip(crowd.clips[0], 0.02f * static_cast<float>(i), forward[i]);
    }
    PoseRows rows;
    for (std::size_t i = 0; i < forward.size(); ++i) {
        const std::size_t at = (i * 37 + 11) % forward.size();
        sample_crowd_clip(crowd.clips[0], 0.02f * static_cast<float>(at), rows);
        REQUIRE(rows.values == forward[at].values);
    }
}

TEST_CASE("crowd clip: times outside the clip, and NaN, are clamped; a single key holds") {
    const TestCrowd crowd(20, 0);
    const CrowdClip& clip = crowd.clips[0];
    const auto at = [&clip](float time) {
        PoseRows rows;
        sample_crowd_clip(clip, time, rows);
        return rows.values;
    };
    CHECK(at(-3) == at(0));
    CHECK(at(NAN) == at(0));
    CHECK(at(100) == at(clip.duration));
    CHECK(at(INFINITY) == at(clip.duration));
    CHECK(at(1) != at(0));
    const auto still = make_crowd_clip(make_chain(4), make_turn({0}, {30}, 2), {});
    REQUIRE(still);
    CHECK(still->frames == 1);
    PoseRows rows;
    sample_crowd_clip(*still, 5, rows);
    CHECK(glm::length(rows.rotation(2) - rotation_about({0, 0, 1}, radians(30))) < 1e-6f);
}

TEST_CASE("crowd clip: jumps and moving scales are refused with a reason") {
    const SkeletonData skeleton = make_chain(4);
    const auto reason = [&skeleton](const ClipData& clip) {
        const auto packed = make_crowd_clip(skeleton, clip, {});
        return packed ? std::string("none") : packed.error().message;
    };
    ClipData step = make_turn({0, 0.5f, 1}, {0, 90, 0}, 1);
    step.sheets[0].interpolation = Interpolation::Step;
    CHECK(reason(step).find("jumps") != std::string::npos);
    ClipData scaled = make_turn({0, 1}, {0, 90}, 1);
    scaled.sheets[0].scaling = {2};
    scaled.sheets[0].scales = {Vec3(1), Vec3(2)};
    CHECK(reason(scaled).find("scales of joint joint 2") != std::string::npos);
    scaled.sheets[0].scales = {Vec3(1), Vec3(1)};
    CHECK(reason(scaled) == "none");
    ClipData morphing = make_turn({0, 1}, {0, 90}, 1);
    morphing.sheets[0].morphing = {0};
    morphing.sheets[0].weights = {0, 1};
    CHECK(reason(morphing) == "none");  // crowds take weights from the clip
    CHECK(reason(make_turn({0, 1}, {0, 90}, 7)) != "none");
    CHECK(reason(make_turn({0, 1}, {0, 90}, 1)) == "none");
}

}  // namespace limn::crowd_clip_test

#include "content/load/gltf/gltf_load.h"
#include "content/load/motion/bvh_file.h"
#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"
#include "tests/app/run_program.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace limn::bake_walk_test {

using test::count_lines;
using test::near;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;
using test::write_text;
using Words = std::vector<std::string>;

namespace {

/// A clip of the generated person, as another program would read it.
struct BakedWalk {
    GltfScene scene;
    BodyJoints body;

    [[nodiscard]] const ClipData& clip() const { return scene.clips.at(0); }
    [[nodiscard]] std::vector<Vec3> joints_at(float time) const {
        LocalPose scratch;
        std::vector<Affine> joints(scene.skeleton.joints.size());
        evaluate_pose(scene.skeleton, &clip(), time, scratch, joints, {});
        std::vector<Vec3> places;
        for (const Affine& joint : joints) {
            places.push_back(transform_point(joint, Vec3(0)));
        }
        return places;
    }
    [[nodiscard]] Vec3 joint_at(BodyPart part, float time) const {
        return joints_at(time)[body[part]];
    }
};

BakedWalk bake(const TemporaryFolder& folder, const Words& settings) {
    Words words = {"bake", "walk", "person", "-o", "walk.glb"};
    for (const std::string& setting : settings) {
        words.insert(words.end(), {"--set", setting});
    }
    const ProgramRun run = run_limn(folder, words);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    BakedWalk walk = {*load_gltf(folder.file("walk.glb")), {}};
    REQUIRE(walk.scene.clips.size() == 1);
    walk.body = find_body_joints(walk.scene.skeleton);
    return walk;
}

/// How far a joint is from where its contact begins, at most, also between the keys [m].
float largest_slide(const BakedWalk& walk) {
    float slide = 0;
    for (const ClipContact& contact : walk.clip().contacts) {
        const Vec3 planted = walk.joints_at(contact.begin)[contact.joint];
        for (float time = contact.begin; time <= contact.end; time += 1.0f / 240) {
            const Vec3 place = walk.joints_at(time)[contact.joint];
            slide = std::max(slide, glm::distance(place, planted));
        }
    }
    return slide;
}

/// The largest change of a joint's velocity from one key to the next [m/s].
float largest_jump(const BakedWalk& walk, float rate) {
    float largest = 0;
    const auto keys = static_cast<std::size_t>(std::round(walk.clip().duration * rate));
    std::vector<Vec3> before;
    std::vector<Vec3> speeds;
    for (std::size_t key = 0; key <= keys; ++key) {
        const std::vector<Vec3> now = walk.joints_at(static_cast<float>(key) / rate);
        std::vector<Vec3> speed(now.size(), Vec3(0));
        for (std::size_t j = 0; key > 0 && j < now.size(); ++j) {
            speed[j] = rate * (now[j] - before[j]);
            if (key > 1) {
                largest = std::max(largest, glm::distance(speed[j], speeds[j]));
            }
        }
        before = now;
        speeds = speed;
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "bake walk: read again, planted feet do not slide, in any style along any way"
    * technique("char.walk-cycle, char.walk-control")) {
    const TemporaryFolder folder;
    const std::vector<Words> walks = {
        {},
        {"turn=0.4", "speed=1", "limp=0.8"},
        {"points=[{\"position\": [1, 0, 2]}, {\"position\": [2, 0, 0], \"wait\": 0.5}]",
         "tiredness=0.8", "rate=120"}};
    for (const Words& settings : walks) {
        const BakedWalk walk = bake(folder, settings);
        CAPTURE(settings.empty() ? "" : settings[0]);
        CHECK(walk.clip().contacts.size() > 8);
        CHECK(walk.clip().events.size() >= 6);
        CHECK(largest_slide(walk) < 2e-3f);
        for (float time = 0; time < walk.clip().duration; time += 0.01f) {
            CHECK(walk.joint_at(BodyPart::LeftFoot, time).y > 0.03f);
        }
    }
}

TEST_CASE(
    "bake walk: joints change their speeds without jumps: half as much from key to key at twice "
    "the rate"
    * technique("char.walk-cycle")) {
    const TemporaryFolder folder;
    for (const Words& settings : {Words{"seconds=3"}, Words{"seconds=3", "standing=true"}}) {
        const auto jump = [&](float rate) {
            Words words = settings;
            words.push_back("rate=" + std::to_string(static_cast<int>(rate)));
            return largest_jump(bake(folder, words), rate);
        };
        const float coarse = jump(120);
        const float fine = jump(480);
        CAPTURE(coarse);
        CHECK(fine < 0.4f * coarse);
        CHECK(coarse < 1.0f);
    }
}

TEST_CASE(
    "bake walk: goes as far and turns as much as it is told" * technique("char.walk-control")) {
    const TemporaryFolder folder;
    const BakedWalk straight = bake(folder, {"speed=1.2", "seconds=5"});
    const Vec3 way = straight.joint_at(BodyPart::Hips, 5) - straight.joint_at(BodyPart::Hips, 0);
    CHECK(way.z == near(6).epsilon(0.01));
    CHECK(std::abs(way.x) < 0.06f);
    CHECK(straight.clip().duration == near(5));
    // A circle of radius speed / turn, once around.
    const BakedWalk circle = bake(folder, {"pace=1", "turn=1", "seconds=6.2832"});
    const Vec3 back = circle.joint_at(BodyPart::Hips, 6.2832f) - circle.joint_at(BodyPart::Hips, 0);
    CHECK(glm::length(back * Vec3(1, 0, 1)) < 0.1f);
    const Vec3 half = circle.joint_at(BodyPart::Hips, kPi) - circle.joint_at(BodyPart::Hips, 0);
    CHECK(half.x == near(2).epsilon(0.05));
    const BakedWalk there = bake(folder, {"points=[{\"position\": [1.5, 0, 2]}]"});
    const Vec3 end = there.joint_at(BodyPart::Hips, there.clip().duration);
    CHECK(glm::length((end - Vec3(1.5f, 0, 2)) * Vec3(1, 0, 1)) < 0.12f);
    CHECK(there.clip().duration < 6);
    const BakedWalk cycle = bake(folder, {"cycle=true"});
    CHECK(cycle.clip().events.size() == 2);
    const std::vector<Vec3> first = cycle.joints_at(0);
    const std::vector<Vec3> last = cycle.joints_at(cycle.clip().duration);
    for (std::size_t j = 0; j < first.size(); ++j) {
        CHECK(glm::distance(first[j], last[j]) < 1e-5f);
    }
}

TEST_CASE("bake walk: what cannot walk, and what is no style, gives one line") {
    const TemporaryFolder folder;
    const auto check_fails = [&](const Words& words, const char* says) {
        const ProgramRun run = run_limn(folder, words);
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 1);
        CHECK(run.err.find(says) != std::string::npos);
        CHECK(!std::filesystem::exists(folder.file("a.glb")));
    };
    write_text(
        folder.file("rock.bvh"),
        "ROOT rock { OFFSET 0 1 0 CHANNELS 1 Yposition } MOTION\nFrames: 1\nFrame Time: 1\n0\n");
    check_fails(
        {"bake", "walk", "rock.bvh", "-o", "a.glb"},
        "rock.bvh: found a skeleton of 1 joints without two legs, expected thighs");
    check_fails({"bake", "walk", "nobody.glb", "-o", "a.glb"}, "nobody.glb");
    check_fails({"bake", "walk", "person", "-o", "a.glb", "--set", "sped=2"}, "speed");
    check_fails({"bake", "walk", "person", "-o", "a.glb", "--set", "limp=2"}, "limp");
    check_fails(
        {"bake", "walk", "person", "-o", "a.glb", "--set", "moves_root=false"}, "moves_root");
    check_fails({"bake", "walk", "person", "-o", "a.png"}, "expected a file name ending in .glb");
    // The same motion as BVH.
    const ProgramRun run = run_limn(
        folder,
        {"bake", "walk", "person", "-o", "walk.bvh", "--set", "seconds=1", "--set", "rate=30"});
    CHECK(run.exit_code == 0);
    CHECK(load_bvh(folder.file("walk.bvh"))->frames == 31);
}

}  // namespace limn::bake_walk_test

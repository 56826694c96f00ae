#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/snapshot.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/walk/activity_clip.h"
#include "systems/animation/walk/crowd_script_system.h"
#include "systems/animation/walk/walk_body.h"
#include "systems/crowd/crowd_visit_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace limn::crowd_script_test {

using namespace limn::test;

namespace {

constexpr std::array<CrowdActivity, 4> kActivities = {
    CrowdActivity::Stand, CrowdActivity::Talk, CrowdActivity::Sit, CrowdActivity::Wave};

std::vector<Affine> pose_at(const SkeletonData& skeleton, const ClipData& clip, float time) {
    LocalPose scratch;
    std::vector<Affine> joints(skeleton.joints.size());
    evaluate_pose(skeleton, &clip, time, scratch, joints, {});
    return joints;
}

Vec3 place_of(const std::vector<Affine>& joints, const SkeletonData& skeleton, const char* name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    REQUIRE(found != skeleton.joints.end());
    return transform_point(
        joints[static_cast<std::size_t>(found - skeleton.joints.begin())], Vec3(0));
}

/// A world with a skeleton, and people of it.
struct Square {
    World world;
    Schedule schedule = make_world_schedule();
    Entity style{};

    Square() {
        register_all_components();
        Assets assets;
        assets.skeletons.push_back(make_stick_person());
        world.insert_resource(std::move(assets));
        style = world.create(Walk{.speed = 1.2f});
    }
    [[nodiscard]] const SkeletonData& skeleton() { return world.resource<Assets>().skeletons[0]; }
    Entity person(const Vec3& position, const CrowdScript& script) {
        return person(position, script, {.point = position});
    }
    Entity person(const Vec3& position, const CrowdScript& script, const CrowdGoal& goal) {
        return world.create(
            Transform{.position = position}, Skeleton{{0}}, CrowdWalk{.style = style}, CrowdPose{},
            script, CrowdAgent{.speed = 1.1f}, goal);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] Vec3 joint(Entity entity, const char* name) {
        const Transform& transform = world.get<const Transform>(entity);
        return transform.position
               + transform.rotation
                     * place_of(world.get<const Pose>(entity).joints, skeleton(), name);
    }
};

/// Three stalls and a gate, visited by forty people.
void fill_market(Square& square) {
    World& world = square.world;
    world.create(Transform{}, CrowdSpace{.size = {40, 40}});
    world.create(Transform{.position = {3, 0, 0}}, CrowdObstacle{.size = {2, 1}});
    for (int i = 0; i < 4; ++i) {
        const auto k = static_cast<float>(i);
        world.create(
            Transform{.position = {12 * std::cos(1.6f * k), 0, 12 * std::sin(1.6f * k)}},
            CrowdExit{.radius = 2.5f}, CrowdPlace{.stay = 2.0f, .appeal = 1 + k});
    }
    for (int i = 0; i < 40; ++i) {
        const auto k = static_cast<float>(i);
        const Entity person = square.person({0.9f * std::fmod(k, 8) - 4, 0, 5 - k / 6}, {});
        world.add(person, MoveIntent{});
        world.add(person, CrowdVisitor{});
    }
}

std::vector<std::uint64_t> market_hashes(int threads) {
    set_thread_count(threads);
    Square square;
    fill_market(square);
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 90; ++i) {
        square.run(4);
        hashes.push_back(state_hash(square.world));
    }
    set_thread_count(0);
    return hashes;
}

}  // namespace

TEST_CASE(
    "activities: loops for any rest pose; who sits has hips at the height of the knees and soles "
    "on the ground"
    * technique("char.crowd-script")) {
    const SkeletonData plain = make_stick_person();
    const SkeletonData turned = make_stick_person(1, true);
    for (const CrowdActivity activity : kActivities) {
        CAPTURE(static_cast<int>(activity));
        const ClipData clip = make_activity_clip(plain, activity);
        const ClipData other = make_activity_clip(turned, activity);
        CHECK(check_clip(clip, plain.joints.size(), 0).ok());
        const std::vector<Affine> first = pose_at(plain, clip, 0);
        float moved = 0;
        float differs = 0;
        for (int i = 0; i <= 32; ++i) {
            const float time = clip.duration * static_cast<float>(i) / 32;
            const std::vector<Affine> a = pose_at(plain, clip, time);
            const std::vector<Affine> b = pose_at(turned, other, time);
            for (std::size_t j = 0; j < a.size(); ++j) {
                const Vec3 place = transform_point(a[j], Vec3(0));
                moved = std::max(moved, glm::distance(place, transform_point(first[j], Vec3(0))));
                differs = std::max(differs, glm::distance(place, transform_point(b[j], Vec3(0))));
            }
            for (const char* foot : {"LeftFoot", "RightFoot"}) {
                CHECK(place_of(a, plain, foot).y == near(0.08).epsilon(0.02));
            }
        }
        CHECK(moved > 0.005f);
        CHECK(differs < 1e-4f);
        const std::vector<Affine> last = pose_at(plain, clip, clip.duration);
        for (std::size_t j = 0; j < last.size(); ++j) {
            CHECK(
                glm::distance(transform_point(last[j], Vec3(0)), transform_point(first[j], Vec3(0)))
                < 1e-5f);
        }
    }
    const auto sitting = pose_at(plain, make_activity_clip(plain, CrowdActivity::Sit), 1);
    CHECK(
        place_of(sitting, plain, "LeftUpLeg").y
        == near(place_of(sitting, plain, "LeftLeg").y).epsilon(0.03));
    CHECK(place_of(sitting, plain, "LeftLeg").z > 0.35f);
    const auto waving = pose_at(plain, make_activity_clip(plain, CrowdActivity::Wave), 0.3f);
    CHECK(place_of(waving, plain, "RightHand").y > place_of(waving, plain, "RightArm").y + 0.1f);
    CHECK(place_of(waving, plain, "LeftHand").y < place_of(waving, plain, "LeftArm").y - 0.4f);
}

TEST_CASE(
    "crowd script: feet on the ground stay there whatever the speed, and poses fade from walking "
    "to standing"
    * technique("char.crowd-script")) {
    Square square;
    const Entity person =
        square.person({0, 0, 0}, {.activity = CrowdActivity::Talk}, {.point = {0, 0, 7}});
    square.run(2);
    Vec3 hand = square.joint(person, "RightHand");
    Vec3 toes = square.joint(person, "LeftToeBase");
    float slide = 0;
    float jump = 0;
    int planted = 0;
    for (int i = 0; i < 900; ++i) {
        square.run(1);
        const Vec3 hand_now = square.joint(person, "RightHand");
        const Vec3 toes_now = square.joint(person, "LeftToeBase");
        jump = std::max(jump, glm::distance(hand, hand_now));
        const ClipPlayer& player = square.world.get<const ClipPlayer>(person);
        const float speed = glm::length(square.world.get<const CrowdState>(person).velocity);
        const float duration = square.world.resource<Assets>().clips[player.clip.index].duration;
        // From the landing of the left foot to the lift of its heel.
        if (speed > 0.5f && player.time > 0.55f * duration && player.time < 0.8f * duration
            && square.world.get<const CrowdPoseState>(person).fade == 0) {
            slide = std::max(slide, glm::distance(toes, toes_now));
            ++planted;
        }
        hand = hand_now;
        toes = toes_now;
    }
    CHECK(planted > 20);
    CHECK(slide < 2e-3f);
    CHECK(jump < 0.05f);  // 3 m/s
    const CrowdScriptState& state = square.world.get<const CrowdScriptState>(person);
    CHECK(state.walks == 0);
    CHECK(square.world.get<const Transform>(person).position.z > 6.5f);
    CHECK(square.world.get<const ClipPlayer>(person).speed == 1);
    CHECK(square.world.resource<Assets>().clips.size() == 2);
}

TEST_CASE("crowd script: people look at whom they notice, some wave, and both end") {
    Square square;
    const Entity hero = square.world.create(Transform{.position = {0, 0, 40}});
    const Entity sure = square.person({0, 0, 0}, {.notices = hero, .waves = 1});
    const Entity shy = square.person({1.5f, 0, 0}, {.notices = hero, .waves = 0});
    const Entity blind = square.person({-1.5f, 0, 0}, {});
    square.run(30);
    CHECK_FALSE(square.world.has<LookAt>(sure));
    square.world.get<Transform>(hero).position = {0, 0, 2};
    square.run(60);
    CHECK(square.world.get<const LookAt>(sure).weight == 1);
    CHECK(square.world.has<LookAt>(shy));
    CHECK_FALSE(square.world.has<LookAt>(blind));
    const auto clip = [&](Entity entity) {
        return square.world.get<const ClipPlayer>(entity).clip;
    };
    CHECK(clip(sure) != clip(shy));
    CHECK(clip(blind) == clip(shy));
    CHECK(square.joint(sure, "RightHand").y > 1.5f);
    square.run(150);
    CHECK(clip(sure) == clip(shy));
    square.world.destroy(hero);
    square.run(60);
    CHECK_FALSE(square.world.has<LookAt>(sure));
    CHECK(square.world.get<const CrowdScriptState>(sure).attention == 0);
}

TEST_CASE("crowd visits: people go from place to place, face it, and the liked ones more often") {
    Square square;
    fill_market(square);
    std::vector<int> visits(4);
    std::vector<Entity> places;
    square.world.query<const CrowdPlace>().each(
        [&](Entity entity, const CrowdPlace&) { places.push_back(entity); });
    REQUIRE(places.size() == 4);
    float least = 1;
    for (int i = 0; i < 3600; ++i) {
        square.run(1);
        square.world.query<const CrowdVisit, const Transform>().each(
            [&](const CrowdVisit& visit, const Transform& transform) {
                const auto found = std::find(places.begin(), places.end(), visit.place);
                if (visit.arrived == 0 || found == places.end()) {
                    return;
                }
                ++visits[static_cast<std::size_t>(found - places.begin())];
                if (visit.left < 0.5f) {
                    const Vec3 toward = square.world.get<const Transform>(visit.place).position
                                        - transform.position;
                    least = std::min(
                        least, glm::dot(
                                   glm::normalize(Vec3(toward.x, 0, toward.z)),
                                   transform.rotation * Vec3(0, 0, 1)));
                }
            });
    }
    for (const int count : visits) {
        CHECK(count > 600);
    }
    CHECK(visits[3] > visits[0]);
    CHECK(least > 0);
}

TEST_CASE("crowd visits: the same bits on 1, 2, 3 and 7 threads, and after a snapshot") {
    const std::vector<std::uint64_t> expected = market_hashes(1);
    CHECK(market_hashes(2) == expected);
    CHECK(market_hashes(3) == expected);
    CHECK(market_hashes(7) == expected);
    Square square;
    fill_market(square);
    square.run(200);
    const Result<std::vector<std::byte>> saved = save_snapshot(square.world);
    REQUIRE_MESSAGE(saved.ok(), (saved ? std::string() : saved.error().message));
    square.run(160);
    CHECK(state_hash(square.world) == expected.back());
    REQUIRE(restore_snapshot(square.world, *saved).ok());
    square.run(160);
    CHECK(state_hash(square.world) == expected.back());
}

TEST_CASE("stand-ins: walkers keep off a character that a motor moves") {
    Square square;
    World& world = square.world;
    const Entity hero = world.create(
        Transform{.position = {0, 0, -6}}, CharacterMotor{}, MoveIntent{.velocity = {0, 0, 1.4f}});
    world.create(Transform{.position = {0, -0.5f, 0}}, Walkable{});
    const Entity stand_in = world.create(
        Transform{}, CrowdAgent{.radius = 0.35f, .priority = 50}, MoveIntent{},
        CrowdStandIn{.character = hero});
    std::vector<Entity> people;
    for (int i = 0; i < 12; ++i) {
        const auto k = static_cast<float>(i);
        people.push_back(square.person(
            {0.8f * (std::fmod(k, 4) - 1.5f), 0, 2 + k / 4}, {}, {.point = {0, 0, -12 - k}}));
    }
    float nearest = 10;
    float passed = 0;
    for (int i = 0; i < 480; ++i) {
        square.run(1);
        const Vec3 place = world.get<const Transform>(hero).position;
        passed = place.z;
        for (const Entity person : people) {
            const Vec3 offset = world.get<const Transform>(person).position - place;
            nearest = std::min(nearest, glm::length(Vec3(offset.x, 0, offset.z)));
        }
    }
    CHECK(passed > 4);
    CHECK(nearest > 0.6f);
    world.destroy(hero);
    square.run(2);
    CHECK(is_finite(world.get<const Transform>(stand_in).position));
}

TEST_CASE("crowd scripts: bad values do nothing") {
    Square square;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    fill_market(square);
    square.world.create(
        Transform{.position = {nan, 0, 0}}, CrowdExit{}, CrowdPlace{.stay = nan, .appeal = nan});
    const Entity far = square.person({0, 0, 9}, {.notice_within = nan, .waves = nan});
    square.world.create(Transform{}, Skeleton{{7}}, CrowdWalk{}, CrowdScript{});
    square.world.create(Transform{}, CrowdVisitor{.patience = nan});
    square.run(120);
    square.world.query<const Transform, With<CrowdVisit>>().each(
        [](const Transform& transform) { CHECK(is_finite(transform.position)); });
    CHECK_FALSE(square.world.has<LookAt>(far));
}

}  // namespace limn::crowd_script_test
